// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <boost/serialization/array.hpp>
#include <boost/serialization/map.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace Squeal
{
  /// What Gmsh holds: nodes, and elements by physical group. No two groups of a dimension share a name.
  struct GmshMesh
  {
    struct Element
    {
      std::size_t               tag;
      std::vector<unsigned int> nodes; ///< indices into points

      template <typename Archive>
      void serialize(Archive &archive, unsigned int)
      {
        archive &tag &nodes;
      }
    };

    struct Group
    {
      int                                         dimension;
      int                                         number;   ///< the least where several groups bear the name
      std::string                                 name;     ///< empty where the group has only a number
      std::map<std::string, std::vector<Element>> elements; ///< by Gmsh's name of the type, e.g. "Quadrilateral 4"; ascending by tag

      template <typename Archive>
      void serialize(Archive &archive, unsigned int)
      {
        archive &dimension &number &name &elements;
      }
    };

    std::vector<std::array<double, 3>> points;                        ///< in the order of Gmsh's node tags [m]
    std::vector<Group>                 groups;                        ///< by dimension, then in the order of their numbers
    std::size_t                        n_unnamed_volume_elements = 0; ///< 3-D elements in no physical group

    /// What the system lacks that keeps Gmsh from running programs and writing files; empty: nothing, or it was not asked for.
    std::string why_not_confined;

    /// The highest dimension that has a physical group; 0 without any.
    int dimension() const;

    template <typename Archive>
    void serialize(Archive &archive, unsigned int)
    {
      archive &points &groups &n_unnamed_volume_elements &why_not_confined;
    }
  };

  /// A mesh as bytes, for another process on the same machine.
  std::string to_bytes(const GmshMesh &mesh);

  /// The mesh of to_bytes(). Throws std::length_error where bytes are missing.
  GmshMesh from_bytes(const std::string &bytes);

  /// First byte of the mesher's reply on its standard output; a text or a mesh follows. The mesher reads its script from standard input.
  enum class MesherReply : char
  {
    mesh          = 'm', ///< to_bytes() of a GmshMesh
    failure       = 'f', ///< what Gmsh reports
    out_of_memory = 'o'  ///< nothing follows
  };

  /// Arguments of the mesher that say whether the geometry may do what confine() forbids.
  inline constexpr const char *mesher_confined = "confined", *mesher_free = "free";
} // namespace Squeal
