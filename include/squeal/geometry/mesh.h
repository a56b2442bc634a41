// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/shape.h>
#include <squeal/parameters/contact.h>

#include <boost/container/static_vector.hpp>
#include <deal.II/base/point.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /**
   * A mesh with named parts, common to all geometries (built-in, .geo, .msh). Cells are Lagrange elements of one degree; different bodies
   * share no nodes.
   */
  struct Mesh
  {
    using Point = dealii::Point<3>;
    using Nodes = boost::container::static_vector<unsigned int, most_nodes>;

    struct Cell
    {
      Shape        shape;
      Nodes        nodes;  ///< see reference_nodes()
      unsigned int volume; ///< index into volume_names
    };

    struct Face
    {
      Shape        shape;
      Nodes        nodes;   ///< see reference_nodes()
      unsigned int surface; ///< index into surface_names
    };

    unsigned int              degree = 1;
    std::vector<Point>        points; ///< coordinates [m]
    std::vector<Cell>         cells;
    std::vector<Face>         faces; ///< faces on named surfaces only, once for each name
    std::vector<std::string>  volume_names;
    std::vector<std::string>  body_names;     ///< names of the bodies, the disc first
    std::vector<unsigned int> body_of_volume; ///< index of the body of each volume, see find_bodies()
    std::vector<std::string>  surface_names;
    std::vector<TiedPair>     tied;         ///< pairs of surfaces that are bonded
    std::vector<std::string>  notes;        ///< notes for the user
    std::vector<std::size_t>  element_tags; ///< Gmsh's tags of the cells, for messages; empty for an extruded plan

    unsigned int body_of(const Cell &cell) const
    {
      return body_of_volume[cell.volume];
    }

    const Point &corner(const Cell &cell, const unsigned int i) const
    {
      return points[cell.nodes[i]];
    }
  };

  /// Number of cells of each shape, as text: "180 tetrahedra, 20 wedges".
  std::string cell_counts(const Mesh &mesh);

  /// Checksum of the nodal coordinates, rounded to 1e-8 of the mesh size or less (about a nanometre for a brake disc). It distinguishes
  /// meshes with equal numbers of nodes.
  std::uint64_t checksum(const Mesh &mesh);

  /**
   * Finds the bodies. Volumes that share nodes or are tied form one body; all volumes of the disc form the first body, `disc`. The other
   * bodies follow in the order of their first volumes. A body of one volume has the name of this volume. A body of several volumes has the
   * common beginning of their names, up to the end of a word: `pin_1` for `pin_1_lining` and `pin_1_backplate`. If the names have no common
   * beginning, or if another part has this name, the body has the name of its first volume.
   */
  void find_bodies(Mesh &mesh);

  /// Pairs of nodes that connect the tied surfaces in Mesh::tied.
  std::vector<std::pair<unsigned int, unsigned int>> tied_links(const Mesh &mesh);

  std::vector<unsigned int> body_of_nodes(const Mesh &mesh);

  struct CellFace
  {
    std::size_t                 cell;   ///< index among the cells
    unsigned int                number; ///< index among the faces of the cell
    unsigned int                body;
    unsigned int                n_corners;
    std::array<unsigned int, 4> corners; ///< nodes, ordered outwards by the right-hand rule; a triangle repeats its last node
    std::array<unsigned int, 4> key;     ///< see face_key()
  };

  /// Key of a face, equal for all faces with the same corners: ascending node numbers; the last one is repeated for a triangle.
  std::array<unsigned int, 4> face_key(const Mesh::Face &face);

  CellFace face_of_cell(const Mesh &mesh, std::size_t cell, unsigned int number);

  /// Faces of all cells, ascending by key, so that both sides of an internal face are adjacent in the list.
  std::vector<CellFace> all_faces(const Mesh &mesh);

  /// Faces that belong to only one cell.
  std::vector<CellFace> outer_faces(const Mesh &mesh);

  /// Centre of a face [m] and its normal times its area [m²], computed from its corners.
  struct FaceGeometry
  {
    Mesh::Point          centre;
    dealii::Tensor<1, 3> area_normal;
  };

  FaceGeometry face_geometry(const Mesh &mesh, const CellFace &face);
  FaceGeometry face_geometry(const Mesh &mesh, const Mesh::Face &face);

  /// Reference coordinates of a point by Newton's method on the isoparametric map; empty if the iteration does not converge or the point
  /// is farther from the cell than about 0.75 of its extent. The nodes must be in the order of reference_nodes().
  std::optional<Mesh::Point> reference_coordinates(Shape                           shape,
                                                   unsigned int                    degree,
                                                   const std::vector<Mesh::Point> &nodes,
                                                   const Mesh::Point              &point);

  /// Distance of a point inside a cell from the nearest face; negative outside the cell.
  struct Depth
  {
    double relative; ///< relative to the extent of the cell normal to the face [-]
    double length;   ///< [m]
  };

  /// Text with number, volume and position of a cell, for messages.
  std::string describe_cell(const Mesh &mesh, std::size_t cell);

  /// Mean of the corners of a cell [m].
  Mesh::Point centre(const Mesh &mesh, const Mesh::Cell &cell);

  /// Depth of a point in a cell, whose edges are assumed straight; empty if reference_coordinates() fails.
  std::optional<Depth> depth_in_cell(const Mesh &mesh, const Mesh::Cell &cell, const Mesh::Point &point);

  /// Index of a pin among the body names, which begin with the disc; throws a ParameterError that names @p parameter and all pins.
  unsigned int pin_number(const std::vector<std::string> &body_names, const std::string &pin, const char *parameter);

  namespace PhysicalNames
  {
    inline constexpr const char *disc         = "disc";         ///< volume: the disc or a part of it; names of other parts begin with disc_
    inline constexpr const char *pin_prefix   = "pin_";         ///< beginning of the names of pins
    inline constexpr const char *disc_contact = "disc_contact"; ///< surface: disc side of all contacts
    inline constexpr const char *pin_contact  = "pin_contact";  ///< surface: pin side of all contacts
    inline constexpr const char *pin_clamp    = "pin_clamp";    ///< surface: clamped outer faces of the pins
    inline constexpr const char *pin_side     = "pin_side";     ///< surface, optional: lateral faces of the pins
    inline constexpr const char *disc_bore    = "disc_bore";    ///< surface, optional: inner boundary of the disc
    inline constexpr const char *disc_rim     = "disc_rim";     ///< surface, optional: outer boundary of the disc

  } // namespace PhysicalNames
} // namespace Squeal
