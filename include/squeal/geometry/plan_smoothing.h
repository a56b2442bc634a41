// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/plan.h>

#include <vector>

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

  /// Nodes that keep their distances and turn together about a centre: a pin's.
  struct TurningPart
  {
    std::vector<unsigned int> nodes;
    Plan::Point               centre;
  };

  /**
   * Turns faces over that are inverted or nearly flat, where smooth() finds no
   * way because several nodes must move at once. Nodes around such faces and
   * whole parts move so that the energy of all corners becomes least,
   *
   *   Σ (a² + b²) / χ(a × b),  χ(D) = (D + √(ε² + D²)) / 2
   *
   * for the edges a, b of a corner; ε decreases, so that inverted corners, of
   * finite energy at first, are pressed to the other side, which they cannot
   * leave again (V. Garanzha, I. Kaporin, L. Kudryavtseva, F. Protais, N. Ray,
   * D. Sokolov, ACM Trans. Graph. 40 (2021) 154).
   *
   * Points stay as they are, to the last bit, where no face is bad, and where
   * bad faces cannot be avoided.
   *
   * @param fixed nodes that move only with a part
   */
  void untangle(const std::vector<Plan::Face>  &faces,
                const std::vector<bool>        &fixed,
                const std::vector<TurningPart> &parts,
                std::vector<Plan::Point>       &points);
} // namespace Squeal
