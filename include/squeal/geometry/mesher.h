// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/gmsh_mesh.h>

#include <map>
#include <stdexcept>
#include <string>

namespace Squeal
{
  /// What a process that runs Gmsh on a geometry may take and do.
  struct MesherLimits
  {
    double seconds;     ///< wall time [s]
    double bytes;       ///< address space [byte]
    bool   is_confined; ///< no programs, no files, no network, where the system can do that
  };

  /// A confined process tried what it may not.
  class ForbiddenAction : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /// What Gmsh opens in that process.
  struct MesherInput
  {
    std::string                   file;    ///< a mesh or geometry; may be empty
    std::string                   script;  ///< text of a geometry that is read before
    std::map<std::string, double> numbers; ///< values for DefineNumber[..., Name "..."], by that name
  };

  /**
   * Opens a geometry or mesh in a process of its own, meshes it as mesh_geometry()
   * does (a solid where there are physical volumes, else a plan), and returns
   * what Gmsh then holds. Whatever happens to Gmsh there leaves this process and, if
   * confined, the user's files alone. The process sees none of the user's
   * environment if confined, and ends with this one. No temporary file is made.
   *
   * @param where name of the geometry that errors quote
   *
   * Throws MeshError where Gmsh fails, crashes, ends by itself or exceeds its limits;
   * ForbiddenAction; FileError where the process cannot be started.
   */
  GmshMesh run_mesher(const MesherInput &input, const std::string &where, const MesherLimits &limits);
} // namespace Squeal
