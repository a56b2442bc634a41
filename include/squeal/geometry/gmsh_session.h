#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace Squeal
{
  /// What Gmsh holds: nodes, and elements by physical group.
  struct GmshMesh
  {
    /// Elements of one type on one physical group.
    struct Block
    {
      std::string               type;            ///< Gmsh's name, e.g. "Quadrilateral 4"
      unsigned int              nodes_per_element;
      std::vector<std::size_t>  tags;            ///< one per element, ascending
      std::vector<unsigned int> nodes;           ///< indices into points, element by element
    };

    struct Group
    {
      int                dimension;
      std::string        name; ///< empty where the group has only a number
      std::vector<Block> blocks;
    };

    std::vector<std::array<double, 3>> points; ///< in the order of Gmsh's node tags [m]
    std::vector<Group>                 groups; ///< by dimension, then in the order of their numbers
    std::size_t                        n_unnamed_volume_elements; ///< 3-D elements in no physical group
  };

  /**
   * Gmsh, from its start to its end; one at a time. Silent on the terminal,
   * without the user's configuration files, on one thread and with fixed
   * seeds, so that the same input gives the same mesh. The only code that
   * speaks to Gmsh.
   *
   * Every member that runs Gmsh throws MeshError quoting the end of Gmsh's
   * log when Gmsh fails or reports an error.
   */
  class GmshSession
  {
  public:
    GmshSession();
    ~GmshSession();

    GmshSession(const GmshSession &)            = delete;
    GmshSession &operator=(const GmshSession &) = delete;

    /// Opens a geometry or a mesh; @p shown is the name that errors quote.
    void open(const std::string &file, const std::string &shown);

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
    /// Runs one step and turns what goes wrong into a MeshError.
    void run(const std::string &step, const std::function<void()> &action) const;

    std::string shown; ///< file named in errors
  };
} // namespace Squeal
