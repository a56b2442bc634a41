// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <filesystem>

namespace Squeal
{
  /// Where the program finds what belongs to it: seen from the executable as `cmake --install` lays it out, so that an installation may be
  /// moved as a whole; in the trees that it was built from, if it is not installed.
  struct Installation
  {
    std::filesystem::path geometries; ///< folder of the geometries that come with the program
    std::filesystem::path mesher;     ///< executable in which Gmsh runs
  };

  /// That of this process.
  const Installation &installation();
} // namespace Squeal
