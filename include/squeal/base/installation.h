// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <filesystem>

namespace Squeal
{
  /// Paths relative to the executable, as laid out by `cmake --install`, so that an installation can be moved; paths in the source and
  /// build trees if the program is not installed.
  struct Installation
  {
    std::filesystem::path geometries; ///< folder of the geometries supplied with the program
    std::filesystem::path mesher;     ///< executable that runs Gmsh
  };

  const Installation &installation();
} // namespace Squeal
