// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <filesystem>
#include <string_view>

namespace Squeal
{
  /// Writes a text as a file, to its last byte and its closing. Returns 0, or the number of the error (`errno`).
  int write_file(const std::filesystem::path &file, std::string_view text);

  /// Gives a file a new content by way of `FILE.incomplete`: at every moment it has the former one or all of the new one. Throws
  /// std::filesystem::filesystem_error.
  void replace_file(const std::filesystem::path &file, std::string_view text);
} // namespace Squeal
