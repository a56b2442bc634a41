#pragma once

namespace Squeal
{
  /**
   * Sets the number of threads with which this process runs dense kernels, if
   * the BLAS library is OpenBLAS. Threads only pay on idle cores: they made a
   * factorisation 15 times slower while other processes held the cores.
   * Returns the number that the library reports afterwards, 0 if it cannot be
   * asked.
   */
  int set_blas_threads(int n_threads);
} // namespace Squeal
