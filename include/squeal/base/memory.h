// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <mpi.h>

#include <filesystem>

namespace Squeal
{
  /**
   * Additional memory that the processes of this machine may use in total before the kernel kills one of them [byte]: the smaller of the
   * available memory (`MemAvailable`) and the remaining limit of the control groups (version 2). Cached files count as available. Infinity
   * if neither can be determined.
   *
   * @param root folder that contains /proc and /sys
   */
  double available_memory(const std::filesystem::path &root = "/");

  /// Total available memory of the machines of the communicator [byte]. Collective.
  double available_memory(MPI_Comm communicator);

  /// Largest fraction of the available memory for stored attachment modes, which are one vector per contact node and can be recomputed [-].
  constexpr double largest_part_of_attachment_modes = 0.125;

  /// Resident memory of this process [byte]; 0 if the system does not report it.
  double resident_memory();

  /// Peak resident memory since the start of the process or the last reset_peak_memory() [byte]; 0 if the system does not report it.
  double peak_resident_memory();

  /// Configures the allocator to return freed memory at the end of the heap to the system if it exceeds 256 MB. Call once at the start of
  /// main(). SuperLU_dist, which deal.II packages link, would keep all freed memory. Large blocks are taken from the heap, because clearing
  /// the pages of blocks that are mapped individually would take a tenth of the time of a large run.
  void return_freed_blocks();

  void return_freed_memory();

  /// Returns freed memory to the system and resets the peak; returns false if the system does not allow the reset.
  bool reset_peak_memory();
} // namespace Squeal
