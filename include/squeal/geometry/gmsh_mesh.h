#pragma once

#include <array>
#include <cstddef>
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
      std::string               type; ///< Gmsh's name, e.g. "Quadrilateral 4"
      unsigned int              nodes_per_element;
      std::vector<std::size_t>  tags;  ///< one per element, ascending
      std::vector<unsigned int> nodes; ///< indices into points, element by element
    };

    struct Group
    {
      int                dimension;
      std::string        name; ///< empty where the group has only a number
      std::vector<Block> blocks;
    };

    std::vector<std::array<double, 3>> points;                    ///< in the order of Gmsh's node tags [m]
    std::vector<Group>                 groups;                    ///< by dimension, then in the order of their numbers
    std::size_t                        n_unnamed_volume_elements; ///< 3-D elements in no physical group

    /// The highest dimension that has a physical group; 0 without any.
    int dimension() const;
  };

  /// A mesh as bytes, for another process on the same machine.
  std::string to_bytes(const GmshMesh &mesh);

  /// The mesh of to_bytes(). Throws std::length_error where bytes are missing.
  GmshMesh from_bytes(const std::string &bytes);
} // namespace Squeal
