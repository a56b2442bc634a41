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
   * Disc and pins seen along the axis: quadrilaterals that cover the annulus,
   * those under each pin, and the named parts of the annulus' boundary. A face
   * may lie under a top and a bottom pin, also where the two are not exactly
   * opposite: then both are displaced from their common place in the plan.
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
      Point                     displacement;       ///< from the place in the plan to that on the disc [m]
      bool                      is_round   = false; ///< filled by fill_pin(): it may turn about its centre
      std::vector<unsigned int> ring_nodes = {};    ///< inside its outline, of rings: smoothing leaves them where they are
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
   * The plan in a meshed two-dimensional model with these physical groups:
   *
   * - surface `disc`: the annulus, with or without what is under the pins;
   * - surfaces `pin_top*`, `pin_bottom*`: the faces under that pin;
   * - curves `pin_top*`, `pin_bottom*`: a closed curve around a hole of the
   *   surfaces, which is filled by fill_pin();
   * - points `pin_top*`, `pin_bottom*`: where the centre of the pin of that
   *   name is on its side of the disc, if it is not the centre of its curve;
   * - other curves: parts of the annulus' boundary.
   *
   * Throws MeshError, naming @p where, for other names and for a plan that
   * does not fit together: other elements than four-node quadrilaterals,
   * surfaces that are not joined, open curves, pins of one side that touch, a
   * named curve inside the annulus, no pin.
   */
  Plan make_plan(const GmshMesh &mesh, const PinRings &rings, const std::string &where);

  /**
   * Moves the nodes of round outlines away from their centres until the polygon has the area of the circle: by
   * √(π r² / A), A the polygon's area with its nodes on the circle. For n equal sides, θ = 2π/n, the polar moment of area then
   * exceeds the circle's by θ⁴/180 only (4e-4 for 12 sides) and the second moments by as much, while with nodes on the circle
   * area and moments are too small by θ²/6 and θ²/3.
   *
   * Round is a pin whose outline, or a named curve of the plan that closes, lies on one circle. A pin's inner nodes move with
   * its outline.
   */
  void enlarge_to_true_area(Plan &plan);

  /// Edges that belong to one of the given faces only, in the sense of rotation of that face.
  std::vector<Plan::Edge> boundary_edges(const std::vector<Plan::Face> &faces);

  /// Nodes of faces or edges.
  template <typename Parts>
  std::set<unsigned int> nodes_of(const Parts &parts)
  {
    std::set<unsigned int> nodes;
    for (const auto &part : parts)
      nodes.insert(part.begin(), part.end());
    return nodes;
  }

  /// Edges from a corner of a face to the next corner and to the one before.
  struct Corner
  {
    Corner(const Plan::Face &face, unsigned int v, const std::vector<Plan::Point> &points);

    dealii::Tensor<1, 2> a, b;
    double               cross; ///< a × b
  };

  /**
   * Disc and pins over their plan: the disc from z = -thickness/2 to
   * +thickness/2, each pin outwards from the face of its side. Pins have nodes
   * of their own, at exactly the places of the disc's.
   *
   * Volumes: disc, then the pins in the order of the plan. Surfaces:
   * disc_contact, pin_contact, pin_clamp, pin_side, then one for each curve of
   * the plan.
   */
  Mesh extrude(const Plan &plan, const GeometryParameters &parameters);
} // namespace Squeal
