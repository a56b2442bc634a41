#pragma once

#include <squeal/geometry/gmsh_mesh.h>

#include <stdexcept>
#include <string>

namespace Squeal
{
  /// Gmsh failed or reported an error: at what. Its log, which it prints, says more.
  class GmshError : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /**
   * Starts Gmsh without the user's configuration files, on one thread and with fixed seeds, so that the same input gives
   * the same mesh. Once in a process.
   */
  void start_gmsh();

  /// Gives a parameter a value that DefineNumber[..., Name "..."] takes over. Throws GmshError.
  void set_number(const std::string &name, double value);

  /**
   * Opens a script that sets variables, then a geometry or mesh if there is one, and meshes what is not meshed yet: a solid as
   * the file itself prescribes, a plan with quadrilaterals only, every element halved. Groups with the same name become one. Throws
   * GmshError, and std::bad_alloc where memory ends.
   */
  GmshMesh mesh_geometry(const std::string &script, const std::string &file);
} // namespace Squeal
