#pragma once

#include <deal.II/base/point.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace Squeal
{
  /**
   * A mesh of eight-node hexahedra with named parts, as Gmsh knows it: the one
   * form in which every geometry (built in, a user's .geo, a user's .msh)
   * enters the program. Nodes of different components are never shared; the
   * nodes of two contact faces coincide in space.
   */
  struct HexMesh
  {
    using Point = dealii::Point<3>;

    struct Hexahedron
    {
      std::array<unsigned int, 8> nodes;  ///< in Gmsh's (= VTK's) order
      unsigned int                volume; ///< index into volume_names
    };

    struct Quadrilateral
    {
      std::array<unsigned int, 4> nodes;   ///< in Gmsh's (= VTK's) order
      unsigned int                surface; ///< index into surface_names
    };

    std::vector<Point>         points; ///< coordinates [m]
    std::vector<Hexahedron>    hexahedra;
    std::vector<Quadrilateral> quadrilaterals; ///< faces on named surfaces only; once for each name that a face bears
    std::vector<std::string>   volume_names;   ///< "disc", then "pin_..."
    std::vector<std::string>   surface_names;
    std::vector<std::string>   notes;        ///< what was corrected, for the user
    std::vector<std::size_t>   element_tags; ///< of the hexahedra in the file, for messages; empty without one
  };

  /// Of the places of the nodes, to 1e-8 of the size or less (a nanometre for some decimetres): tells two meshes with the same
  /// numbers of nodes apart.
  std::uint64_t checksum(const HexMesh &mesh);

  /// Index of the volume that each node belongs to.
  std::vector<unsigned int> volume_of_nodes(const HexMesh &mesh);

  /// Index of a pin among the names of the volumes, the disc's first; throws ParameterError naming @p parameter and all pins.
  unsigned int pin_number(const std::vector<std::string> &volume_names, const std::string &pin, const char *parameter);

  /// Physical names that every geometry uses.
  namespace PhysicalNames
  {
    inline constexpr const char *disc         = "disc";         ///< volume: the disc
    inline constexpr const char *pin_prefix   = "pin_";         ///< volumes: every pin or pad
    inline constexpr const char *disc_contact = "disc_contact"; ///< surface: the disc's side of every contact
    inline constexpr const char *pin_contact  = "pin_contact";  ///< surface: the pins' side of every contact
    inline constexpr const char *pin_clamp    = "pin_clamp";    ///< surface: clamped outer faces of the pins
    inline constexpr const char *pin_side     = "pin_side";     ///< surface, optional: lateral faces of the pins
    inline constexpr const char *disc_bore    = "disc_bore";    ///< surface, optional: inner boundary of the disc
    inline constexpr const char *disc_rim     = "disc_rim";     ///< surface, optional: outer boundary of the disc

  } // namespace PhysicalNames
} // namespace Squeal
