#pragma once

#include <mpi.h>

#include <filesystem>

namespace Squeal
{
  /**
   * Memory that the processes of this machine may take together before one of
   * them is killed [byte]: what the kernel has available (`MemAvailable`), or
   * what the control groups of this process leave, whichever is less. Files
   * that are only cached count as available. Infinity where neither is known.
   *
   * @param root where /proc and /sys are found
   */
  double available_memory(const std::filesystem::path &root = "/");

  /// What all machines on which these processes run have [byte]. All processes must call.
  double available_memory(MPI_Comm communicator);

  /// Part of the available memory up to which vectors are kept that can be solved for again, one for each contact node [-].
  constexpr double largest_part_of_attachment_modes = 0.125;
} // namespace Squeal
