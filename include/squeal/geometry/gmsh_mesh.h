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
  /// Mesh from Gmsh: nodes, and elements by physical group. Named groups of the same dimension have different names.
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
      int                                         number;   ///< number of the group; the smallest one if several groups share the name
      std::string                                 name;     ///< name of the group; empty if it has only a number
      std::map<std::string, std::vector<Element>> elements; ///< elements by Gmsh's name of their type ("Quadrilateral 4"), ascending by tag

      template <typename Archive>
      void serialize(Archive &archive, unsigned int)
      {
        archive &dimension &number &name &elements;
      }
    };

    std::vector<std::array<double, 3>> points;                        ///< nodal coordinates in the order of Gmsh's node tags [m]
    std::vector<Group>                 groups;                        ///< sorted by dimension, then by number
    std::size_t                        n_unnamed_volume_elements = 0; ///< number of 3-D elements without a physical group

    /// Missing system feature that prevented the confinement of Gmsh; empty if Gmsh was confined or confinement was not requested.
    std::string why_not_confined;

    /// Highest dimension with a physical group; 0 without groups.
    int dimension() const;

    template <typename Archive>
    void serialize(Archive &archive, unsigned int)
    {
      archive &points &groups &n_unnamed_volume_elements &why_not_confined;
    }
  };

  /// Serialises a mesh for another process on the same machine.
  std::string to_bytes(const GmshMesh &mesh);

  /// Mesh from to_bytes(). Throws std::length_error if the bytes are incomplete or invalid.
  GmshMesh from_bytes(const std::string &bytes);

  /// First byte of the mesher's reply on standard output. The mesher reads its script from standard input.
  enum class MesherReply : char
  {
    mesh          = 'm', ///< a GmshMesh, serialised by to_bytes(), follows
    failure       = 'f', ///< an error message of Gmsh follows
    out_of_memory = 'o'  ///< nothing follows
  };

  /// Command-line arguments of the mesher: run confined by confine(), or unconfined.
  inline constexpr const char *mesher_confined = "confined", *mesher_free = "free";
} // namespace Squeal
