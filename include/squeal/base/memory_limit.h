#pragma once

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
} // namespace Squeal
