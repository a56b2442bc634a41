// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

namespace Squeal
{
  /**
   * Sets environment variables for situations that Open MPI does not detect; call before MPI starts. Variables set by the user are kept.
   *
   * - If there are more processes than cores on this machine, waiting processes yield the core. Otherwise they spin, which is faster if
   * each process has its own core.
   * - A process started without mpirun uses neither the daemon, which would inherit its limits and signals, nor a session folder. Without
   * the daemon, all such processes would use the same folder, and an ending process would remove it while another process starts.
   */
  void prepare_mpi_environment();
} // namespace Squeal
