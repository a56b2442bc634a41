// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/gmsh_mesh.h>
#include <squeal/geometry/mesh.h>
#include <squeal/parameters/geometry.h>

#include <deal.II/base/point.h>

#include <array>
#include <set>
#include <string>
#include <vector>

namespace Squeal
{
  struct PinRings;

  /**
   * Plan view of disc and pins: quadrilaterals that cover the annulus, the faces under each pin, and the named parts of the boundary of the
   * annulus. A face may be under a top and a bottom pin, even if the pins are not exactly opposite: the pins are then displaced from
   * their common position in the plan.
   */
  struct Plan
  {
    using Point = dealii::Point<2>;
    using Edge  = std::array<unsigned int, 2>;
    using Face  = std::array<unsigned int, 4>; ///< counter-clockwise

    enum class Side
    {
      top,
      bottom
    };

    struct Pin
    {
      std::string               name; ///< "pin_top..." or "pin_bottom..."
      Side                      side = Side::top;
      std::vector<unsigned int> faces;              ///< indices into Plan::faces, ascending
      Point                     displacement;       ///< displacement from the position in the plan to the position on the disc [m]
      bool                      is_round   = false; ///< true for a pin filled by fill_pin(), which may rotate about its centre
      std::vector<unsigned int> ring_nodes = {};    ///< nodes of the rings inside the outline; not moved by smoothing
    };

    struct Curve
    {
      std::string       name;
      std::vector<Edge> edges;
    };

    std::vector<Face> faces_of(const Pin &pin) const;

    std::vector<Point> points; ///< [m]
    std::vector<Face>  faces;
    std::vector<Pin>   pins;
    std::vector<Curve> curves;
  };

  /**
   * Plan from a meshed two-dimensional model with these physical groups:
   *
   * - surface `disc`: the annulus, with or without the faces under the pins;
   * - surfaces `pin_top*`, `pin_bottom*`: the faces under the pin of this name;
   * - curves `pin_top*`, `pin_bottom*`: a closed curve around a hole of the
   *   surfaces, which is filled by fill_pin();
   * - points `pin_top*`, `pin_bottom*`: centre of the pin of this name on its side of the disc, if it is not the centre of its curve;
   * - other curves: parts of the boundary of the annulus.
   *
   * Throws a MeshError that names @p where for other names and for inconsistent plans: elements other than four-node quadrilaterals,
   * disconnected surfaces, open curves, touching pins on one side, a named curve inside the annulus, no pin. @p unit: unit of the nodal
   * coordinates [m], for positions in these messages.
   */
  Plan make_plan(const GmshMesh &mesh, const PinRings &rings, double unit, const std::string &where);

  /**
   * Moves the nodes of round outlines outwards until the polygon has the area of the circle: by the factor √(π r² / A), where A is the area
   * of the polygon with nodes on the circle. For n equal sides, θ = 2π/n, the polar and second moments of area then exceed the values of
   * the circle by only θ⁴/180 (4e-4 for 12 sides). With nodes on the circle, the area would be too small by θ²/6, and the moments by θ²/3.
   *
   * Round outlines are outlines of pins and closed named curves of the plan with all nodes on one circle. The inner nodes of a pin move
   * with its outline.
   */
  void enlarge_to_true_area(Plan &plan);

  /// Edges that belong to only one of the given faces, oriented as in this face.
  std::vector<Plan::Edge> boundary_edges(const std::vector<Plan::Face> &faces);

  template <typename Parts>
  std::set<unsigned int> nodes_of(const Parts &parts)
  {
    std::set<unsigned int> nodes;
    for (const auto &part : parts)
      nodes.insert(part.begin(), part.end());
    return nodes;
  }

  /// Edges from a corner of a face to the next and to the previous corner.
  struct Corner
  {
    Corner(const Plan::Face &face, unsigned int v, const std::vector<Plan::Point> &points);

    dealii::Tensor<1, 2> a, b;
    double               cross; ///< a × b
  };

  /**
   * Extrudes the plan: the disc from z = -thickness/2 to +thickness/2, each pin outwards from the face of its side. Pins have their own
   * nodes, which coincide with nodes of the disc on the contact faces.
   *
   * Volumes: disc, then the pins in the order of the plan. Surfaces: disc_contact, pin_contact, pin_clamp, pin_side, then one for each
   * curve of the plan.
   */
  Mesh extrude(const Plan &plan, const GeometryParameters &parameters);
} // namespace Squeal
