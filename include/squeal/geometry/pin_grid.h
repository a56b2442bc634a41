// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/plan.h>

namespace Squeal
{
  /// Boundaries of n intervals of [0, 1], including 0 and 1; each interval is shorter than the previous one by the factor @p ratio.
  std::vector<double> graded_intervals(unsigned int n, double ratio);

  /// Rings of quadrilaterals along the outline of a pin.
  struct PinRings
  {
    unsigned int number  = 0;
    double       grading = 1.; ///< width of a ring, except the innermost, relative to the next outer ring
  };

  struct PinGrid
  {
    std::vector<Plan::Face>   faces;
    std::vector<unsigned int> ring_nodes; ///< nodes of the rings inside the outline
  };

  /**
   * Fills a closed, counter-clockwise polygon of 6 k nodes with three blocks of k x k quadrilaterals around its centre: 3 k (k + 1) + 1
   * nodes in total. The first node and every 2 k-th node after it are the ends of the spokes between the blocks. Appends the new nodes to
   * @p points.
   */
  std::vector<Plan::Face> fill_with_o_grid(const std::vector<unsigned int> &loop, std::vector<Plan::Point> &points);

  /**
   * Fills a polygon with rings of 6 k quadrilaterals each between the outline and the blocks; each ring adds 6 k nodes.
   *
   * Without rings, each block has a flat corner on a round outline: its two edges meet at 180 - 60 / k degrees, and at 180 degrees if
   * elements follow the circle. In addition, stresses at the clamped end of the pin are singular on the outline. Rings have right angles at
   * the outline. All rings except the innermost lie between outlines scaled towards the centre, down to 0.8. The innermost ring ends at a
   * triangle with curved sides, halfway between the arcs and the chords from corner to corner. The angles of the blocks are then below 130
   * degrees.
   */
  PinGrid fill_pin(const std::vector<unsigned int> &outline, const PinRings &rings, std::vector<Plan::Point> &points);
} // namespace Squeal
