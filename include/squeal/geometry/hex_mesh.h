#pragma once

#include <deal.II/base/point.h>

#include <array>
#include <cstdint>
#include <optional>
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

  /// A face of a hexahedron.
  struct HexFace
  {
    std::array<unsigned int, 4> nodes;  ///< around the face, outwards by the right-hand rule
    unsigned int                volume; ///< of its hexahedron
    std::array<unsigned int, 4> key;    ///< the nodes in ascending order
  };

  /// Those of all hexahedra, ascending by key: the two of a face between hexahedra follow each other.
  std::vector<HexFace> all_faces(const HexMesh &mesh);

  /// Those that belong to one hexahedron only.
  std::vector<HexFace> outer_faces(const HexMesh &mesh);

  /// Centre of a face [m] and its normal times its area [m²].
  struct FaceGeometry
  {
    HexMesh::Point       centre;
    dealii::Tensor<1, 3> area_normal;
  };

  FaceGeometry face_geometry(const HexMesh &mesh, const std::array<unsigned int, 4> &nodes);

  /// How deep a point is in a cell, below the nearest face; negative outside.
  struct Depth
  {
    double relative; ///< to the extent of the cell across that face [-]
    double length;   ///< [m]
  };

  /// By Newton's method for the coordinates in the cell; nothing for points that are more than about three quarters of its extent away.
  std::optional<Depth> depth_in_cell(const HexMesh &mesh, const HexMesh::Hexahedron &cell, const HexMesh::Point &point);

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
