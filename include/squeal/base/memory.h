// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <mpi.h>

#include <filesystem>

namespace Squeal
{
  /**
   * Memory that the processes of this machine may take together before one of them is killed [byte]: what the kernel has available
   * (`MemAvailable`), or what the control groups of this process (version 2) leave, whichever is less. Files that are only cached count
   * as available. Infinity where neither is known.
   *
   * @param root where /proc and /sys are found
   */
  double available_memory(const std::filesystem::path &root = "/");

  /// What all machines on which these processes run have [byte]. All processes must call.
  double available_memory(MPI_Comm communicator);

  /// Part of the available memory up to which vectors are kept that can be solved for again, one for each contact node [-].
  constexpr double largest_part_of_attachment_modes = 0.125;

  /// Memory of this process that is resident now [byte]; 0 where the system does not tell.
  double resident_memory();

  /// Peak of it since the beginning of the process or since reset_peak_memory() [byte]; 0 where the system does not tell.
  double peak_resident_memory();

  /// Lets freed memory go back to the system where it is more than 256 MB at the end of the heap. SuperLU_dist, which comes with the
  /// packages of deal.II, tells the allocator to keep everything: a process would hold the sum of what its steps ever used. Large blocks
  /// are not mapped one by one, since clearing new pages for each temporary vector takes a tenth of a large run. To be called once, first.
  void return_freed_blocks();

  /// Gives all freed memory back to the system.
  void return_freed_memory();

  /// Gives freed memory back and begins a new peak; whether the system allows it.
  bool reset_peak_memory();
} // namespace Squeal
