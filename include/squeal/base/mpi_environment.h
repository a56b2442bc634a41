#pragma once

namespace Squeal
{
  /**
   * Tells Open MPI through its environment what it cannot know; to be called
   * before MPI starts. What the user has set stays.
   *
   * - Where there are more processes on this machine than cores, those that wait leave the core to others. Otherwise
   *   waiting keeps a core busy, which is faster where there is one for each.
   * - A process that mpirun has not started needs no daemon beside it, which would take its share of limits and signals.
   */
  void prepare_mpi_environment();
} // namespace Squeal
