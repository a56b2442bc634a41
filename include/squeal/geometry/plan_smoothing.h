// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/plan.h>

#include <vector>

namespace Squeal
{
  /**
   * Moves single nodes inside the disc and inside the pins, in up to 100 sweeps, while this improves badly shaped faces; then calls
   * untangle(). Nodes on the boundary of the annulus, on the outlines of pins and in their rings do not move individually, but round pins
   * may rotate about their centres.
   *
   * The shape quality at the corner between edges a and b is 2 a x b / (a² + b²): 1 for a square, 0 for a flat corner or an edge of length
   * 0, negative if inverted. A node moves to maximise the smallest quality of the adjacent faces.
   *
   * Smoothing is necessary because Gmsh halves elements after meshing and then moves new nodes of round outlines onto the circle. If a
   * circle has few nodes and a close neighbour, the elements in between would be flat or inverted.
   */
  void smooth(Plan &plan);

  /**
   * Points of the plan for one face of the disc: pins of that side at their positions, the boundary of the annulus unchanged, and the
   * remaining nodes displaced by interpolation and smoothed. If bad faces remain, round pins of this side may also rotate.
   */
  std::vector<Plan::Point> points_on_side(const Plan &plan, const Plan::Side side);

  /// Nodes of a pin, which rotate as a rigid body about its centre.
  struct TurningPart
  {
    std::vector<unsigned int> nodes;
    Plan::Point               centre;
  };

  /**
   * Untangles inverted or nearly flat faces that smooth() cannot improve because several nodes must move simultaneously. Nodes around such
   * faces and whole parts move so as to minimise the energy of all corners,
   *
   *   Σ (a² + b²) / χ(a × b),  χ(D) = (D + √(ε² + D²)) / 2
   *
   * for the edges a, b of a corner. While ε is large, inverted corners have a finite energy and can be turned over; as ε decreases, they
   * cannot invert again (V. Garanzha, I. Kaporin, L. Kudryavtseva, F. Protais, N. Ray, D. Sokolov, ACM Trans. Graph. 40 (2021) 154).
   *
   * Points are not changed if no face is bad or if bad faces would remain.
   *
   * @param fixed nodes that do not move individually
   */
  void untangle(const std::vector<Plan::Face>  &faces,
                const std::vector<bool>        &fixed,
                const std::vector<TurningPart> &parts,
                std::vector<Plan::Point>       &points);
} // namespace Squeal
