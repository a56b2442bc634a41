#pragma once

#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace Squeal
{
  /**
   * Writes texts one after the other into a file, to the last byte and its closing.
   * Returns 0, or the number of the error (`errno`) that occurred first.
   *
   * @param flags   of open() beside those for writing: `O_TRUNC`, `O_APPEND`, ...
   * @param on_disk waits until the disk has it: for a file on which others rest
   */
  int write_file(const std::filesystem::path &file, int flags, const std::initializer_list<std::string_view> &texts, bool on_disk);

  /**
   * Gives a file a new content by way of `FILE.incomplete`: at every moment it has the former one or all of the new one. Throws
   * std::filesystem::filesystem_error.
   */
  void replace_file(const std::filesystem::path &file, std::string_view text);
} // namespace Squeal
