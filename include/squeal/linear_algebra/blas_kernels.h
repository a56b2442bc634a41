#pragma once

namespace Squeal
{
  /**
   * Makes OpenBLAS use the vector units that the processor has. A library older
   * than the processor does not know its name and falls back to kernels of
   * 2004; the choice is made while the program is loaded and can only be
   * changed through the environment. If that has happened, sets
   * OPENBLAS_CORETYPE (unless the user did) and starts the program anew; to be
   * called before anything else, MPI included. Returns if there is nothing to do.
   */
  void use_native_blas_kernels(char **argv);
} // namespace Squeal
