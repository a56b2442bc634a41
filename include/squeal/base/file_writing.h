// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <filesystem>
#include <string_view>

namespace Squeal
{
  /// Writes a complete text file and closes it. Returns 0 or `errno`.
  int write_file(const std::filesystem::path &file, std::string_view text);

  /// Replaces a file atomically, via `FILE.incomplete`, so that an interrupted run leaves either the complete old or the complete new text.
  /// Throws std::filesystem::filesystem_error.
  void replace_file(const std::filesystem::path &file, std::string_view text);
} // namespace Squeal
