#pragma once

#include <filesystem>
#include <string>

namespace Squeal
{
  /**
   * Where a result folder of this name comes to lie: absolute, all symbolic links
   * followed, so that a link goes on pointing to the results.
   *
   * Throws FileError if the name is empty, too long, or leads round in circles.
   */
  std::filesystem::path result_place(const std::string &name);

  /**
   * Throws FileError if results cannot be put at @p place: there is a file, or a
   * folder that holds something other than results, or one that cannot be replaced
   * since programs work in it, something is mounted on it, or the user may not.
   *
   * @param name   as the user has it, for messages
   * @param record file that marks a folder as results
   */
  void check_result_place(const std::filesystem::path &place, const std::string &name, const std::string &record);
} // namespace Squeal
