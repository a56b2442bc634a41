// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

namespace Squeal
{
  /**
   * Sets environment variables of Open MPI that it cannot determine; call before MPI starts. Variables that the user has set are kept.
   *
   * - With more processes than cores on this machine, waiting processes yield the core. Otherwise they spin, which is faster with one core
   * each.
   * - A process that mpirun has not started needs no daemon, which would share its limits and signals, and no session folder: without the
   * daemon all such processes would share one folder, and a process that ends would remove it while another starts.
   */
  void prepare_mpi_environment();
} // namespace Squeal
