#pragma once

#include <squeal/geometry/gmsh_mesh.h>

#include <functional>
#include <stdexcept>
#include <string>

namespace Squeal
{
  /// Gmsh failed or reported an error: at what, and what its log says.
  class GmshError : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /**
   * Gmsh, from its start to its end; one at a time. Runs without the user's configuration files, on one thread and with fixed
   * seeds, so that the same input gives the same mesh. The only code that
   * speaks to Gmsh.
   *
   * Every member that runs Gmsh throws GmshError with the end of Gmsh's log
   * when Gmsh fails or reports an error, and std::bad_alloc where memory ends.
   */
  class GmshSession
  {
  public:
    /// @param prints whether Gmsh prints its log, for a reader that is there when Gmsh no longer is
    explicit GmshSession(bool prints = false);
    ~GmshSession();

    GmshSession(const GmshSession &)            = delete;
    GmshSession &operator=(const GmshSession &) = delete;

    /// Gives a parameter a value that DefineNumber[..., Name "..."] takes over.
    void set_number(const std::string &name, double value);

    /// Opens a geometry or a mesh.
    void open(const std::string &file);

    /// The highest dimension that has a physical group; 0 without any.
    int dimension() const;

    /// Whether the open model already has elements of that dimension.
    bool is_meshed(int dimension) const;

    /// Meshes the plan with quadrilaterals only: recombines, then halves every element.
    void mesh_plan();

    /// Meshes the solid as the file itself prescribes.
    void mesh_solid();

    GmshMesh mesh() const;

    /// Replaces the open model by the given mesh of hexahedra and quadrilaterals.
    void load(const GmshMesh &mesh);

    /// Writes the open model as .msh (format 4.1, text).
    void write(const std::string &file);

  private:
    /// Runs one step and turns what goes wrong into a GmshError.
    void run(const std::string &step, const std::function<void()> &action) const;
  };
} // namespace Squeal
