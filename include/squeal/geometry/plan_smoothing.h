#pragma once

#include <squeal/geometry/plan.h>

namespace Squeal
{
  /**
   * Moves nodes inside the disc and inside the pins until no badly shaped face
   * gets better by moving one of its nodes. Nodes on the boundary of the
   * annulus, on the outlines of pins and of their rings stay.
   *
   * The shape at the corner between edges a and b is 2 a x b / (a² + b²): 1 for
   * a square, 0 for a flat corner or an edge of length 0, negative if inverted.
   * A node moves to where the least shape of the faces around it is greatest.
   *
   * Gmsh halves elements after meshing and then puts new nodes of round
   * outlines on the circle; with few nodes on a circle and a neighbour close to
   * it, the elements between them would be flat or inverted without this.
   */
  void smooth(Plan &plan);

  /**
   * Points of the plan as they are on one face of the disc: the pins of that
   * side at their places, the boundary of the annulus where it was, and the
   * rest displaced evenly in between and smoothed. Where that leaves bad faces,
   * round pins turn about their own centres as well.
   */
  std::vector<Plan::Point> points_on_side(const Plan &plan, const Plan::Side side);

  /// Points at the height (1 - t) lower + t upper through the disc: on straight lines unless faces turn over on the way.
  std::vector<Plan::Point> points_between(const Plan                     &plan,
                                          const std::vector<Plan::Point> &lower,
                                          const std::vector<Plan::Point> &upper,
                                          double                          t);
} // namespace Squeal
