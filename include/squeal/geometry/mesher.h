// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/gmsh_mesh.h>

#include <map>
#include <stdexcept>
#include <string>

namespace Squeal
{
  /// Resource limits and confinement of the Gmsh process.
  struct MesherLimits
  {
    double seconds;     ///< wall time [s]
    double bytes;       ///< address space [byte]
    bool   is_confined; ///< forbids starting programs, changing files and opening connections, if the system supports this
  };

  /// Error: a confined process attempted a forbidden action.
  class ForbiddenAction : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  struct MesherInput
  {
    std::string                   file;    ///< mesh or geometry file; may be empty
    std::string                   script;  ///< geometry commands that are read first
    std::map<std::string, double> numbers; ///< values for DefineNumber[..., Name "..."], by name
  };

  /**
   * Opens a geometry or mesh in a separate process, meshes it by mesh_geometry() (a solid if there are physical volumes, else a plan), and
   * returns the resulting mesh. A crash of Gmsh does not affect this process. A confined Gmsh cannot change the user's files. A confined
   * process inherits no environment variable except LD_LIBRARY_PATH. Gmsh ends with this process. No temporary file is created.
   *
   * @param where name of the geometry, for error messages
   *
   * Throws MeshError if Gmsh fails, crashes, exits or exceeds its limits; ForbiddenAction if a confined Gmsh attempts a forbidden action;
   * FileError if the process cannot be started.
   */
  GmshMesh run_mesher(const MesherInput &input, const std::string &where, const MesherLimits &limits);
} // namespace Squeal
