// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

namespace Squeal
{
  /**
   * Tells Open MPI through its environment what it cannot know; to be called
   * before MPI starts. What the user has set stays.
   *
   * - Where there are more processes on this machine than cores, those that wait leave the core to others. Otherwise
   *   waiting keeps a core busy, which is faster where there is one for each.
   * - A process that mpirun has not started needs no daemon beside it, which would take its share of limits and signals,
   *   and no folder for temporary files: without the daemon all such processes would use the same one, and one that
   *   ends would remove it while another starts.
   */
  void prepare_mpi_environment();
} // namespace Squeal
