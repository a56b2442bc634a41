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

  /// Whether a file is there and ends with these words, space apart: whether what a library has written there is complete.
  bool file_ends_with(const std::filesystem::path &file, std::string_view words);
} // namespace Squeal
