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
   * A mesh with named parts: the one form in which every geometry (built in, a user's .geo, a user's .msh) enters the program. Cells are Lagrange
   * elements of one degree; nodes of different bodies are never shared.
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
    std::vector<Face>         faces; ///< on named surfaces only; once for each name that a face bears
    std::vector<std::string>  volume_names;
    std::vector<std::string>  body_names;     ///< the disc's first
    std::vector<unsigned int> body_of_volume; ///< of each volume, see find_bodies()
    std::vector<std::string>  surface_names;
    std::vector<TiedPair>     tied;         ///< surfaces that are bonded
    std::vector<std::string>  notes;        ///< what was corrected, for the user
    std::vector<std::size_t>  element_tags; ///< of the cells in the file, for messages; empty without one

    unsigned int body_of(const Cell &cell) const
    {
      return body_of_volume[cell.volume];
    }

    const Point &corner(const Cell &cell, const unsigned int i) const
    {
      return points[cell.nodes[i]];
    }
  };

  /// How many cells there are of each shape, as text: "180 tetrahedra, 20 wedges".
  std::string cell_counts(const Mesh &mesh);

  /// Of the places of the nodes, to 1e-8 of the size or less (a nanometre for some decimetres): tells two meshes with the same
  /// numbers of nodes apart.
  std::uint64_t checksum(const Mesh &mesh);

  /**
   * Finds the bodies: volumes that share nodes or are tied, and all volumes of the disc, which comes first; the others follow in the order of their first
   * volumes. A body bears the name of its volume; one of several volumes what their names have in common up to the end of a word, as `pin_1`
   * of `pin_1_lining` and `pin_1_backplate`, or, where nothing is or another part has that name, the name of the first. The disc is `disc`.
   */
  void find_bodies(Mesh &mesh);

  /// Pairs of nodes that join what Mesh::tied bonds.
  std::vector<std::pair<unsigned int, unsigned int>> tied_links(const Mesh &mesh);

  /// Index of the body that each node belongs to.
  std::vector<unsigned int> body_of_nodes(const Mesh &mesh);

  /// A face of a cell.
  struct CellFace
  {
    std::size_t                 cell;   ///< index among the cells
    unsigned int                number; ///< among the faces of the cell
    unsigned int                body;
    unsigned int                n_corners;
    std::array<unsigned int, 4> corners; ///< nodes around the face, outwards by the right-hand rule; a triangle repeats the last
    std::array<unsigned int, 4> key;     ///< see face_key()
  };

  /// The same for each face with these corners: their nodes in ascending order, of a triangle the last one twice.
  std::array<unsigned int, 4> face_key(const Mesh::Face &face);

  CellFace face_of_cell(const Mesh &mesh, std::size_t cell, unsigned int number);

  /// Those of all cells, ascending by key: the two of a face between cells follow each other.
  std::vector<CellFace> all_faces(const Mesh &mesh);

  /// Those that belong to one cell only.
  std::vector<CellFace> outer_faces(const Mesh &mesh);

  /// Centre of a face [m] and its normal times its area [m²], of its corners.
  struct FaceGeometry
  {
    Mesh::Point          centre;
    dealii::Tensor<1, 3> area_normal;
  };

  FaceGeometry face_geometry(const Mesh &mesh, const CellFace &face);
  FaceGeometry face_geometry(const Mesh &mesh, const Mesh::Face &face);

  /// Reference coordinates of a point by Newton's method on the map of the nodes; nothing for points that are more than about three quarters of
  /// the cell's extent away. Nodes' places are those of a Lagrange element of the given shape and degree.
  std::optional<Mesh::Point> reference_coordinates(Shape                           shape,
                                                   unsigned int                    degree,
                                                   const std::vector<Mesh::Point> &nodes,
                                                   const Mesh::Point              &point);

  /// How deep a point is in a cell, below the nearest face; negative outside.
  struct Depth
  {
    double relative; ///< to the extent of the cell across that face [-]
    double length;   ///< [m]
  };

  /// Number, volume and place of a cell, for messages.
  std::string describe_cell(const Mesh &mesh, std::size_t cell);

  /// Mean of the corners [m].
  Mesh::Point centre(const Mesh &mesh, const Mesh::Cell &cell);

  /// Of the cell with straight edges between its corners; nothing where reference_coordinates() finds none.
  std::optional<Depth> depth_in_cell(const Mesh &mesh, const Mesh::Cell &cell, const Mesh::Point &point);

  /// Index of a pin among the names of the bodies, the disc's first; throws ParameterError naming @p parameter and all pins.
  unsigned int pin_number(const std::vector<std::string> &body_names, const std::string &pin, const char *parameter);

  /// Physical names that every geometry uses.
  namespace PhysicalNames
  {
    inline constexpr const char *disc         = "disc";         ///< volume: the disc, or part of it; other parts begin with disc_
    inline constexpr const char *pin_prefix   = "pin_";         ///< surfaces of a plan: every pin or pad
    inline constexpr const char *disc_contact = "disc_contact"; ///< surface: the disc's side of every contact
    inline constexpr const char *pin_contact  = "pin_contact";  ///< surface: the pins' side of every contact
    inline constexpr const char *pin_clamp    = "pin_clamp";    ///< surface: clamped outer faces of the pins
    inline constexpr const char *pin_side     = "pin_side";     ///< surface, optional: lateral faces of the pins
    inline constexpr const char *disc_bore    = "disc_bore";    ///< surface, optional: inner boundary of the disc
    inline constexpr const char *disc_rim     = "disc_rim";     ///< surface, optional: outer boundary of the disc

  } // namespace PhysicalNames
} // namespace Squeal
