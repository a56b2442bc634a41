// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <filesystem>
#include <string_view>

namespace Squeal
{
  /// Writes a complete text file and closes it. Returns 0 or `errno`.
  int write_file(const std::filesystem::path &file, std::string_view text);

  /// Replaces a file atomically, via `FILE.incomplete`, so that it contains the complete old or new text even if the run is interrupted.
  /// Throws std::filesystem::filesystem_error.
  void replace_file(const std::filesystem::path &file, std::string_view text);
} // namespace Squeal
