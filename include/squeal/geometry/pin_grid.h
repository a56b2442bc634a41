// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/plan.h>

namespace Squeal
{
  /// Ends of n intervals of [0, 1], 0 and 1 included, each interval shorter than the one before by @p ratio: all of them the same at ratio
  /// 1.
  std::vector<double> graded_intervals(unsigned int n, double ratio);

  /// Rings of quadrilaterals along the outline of a pin.
  struct PinRings
  {
    unsigned int number  = 0;
    double       grading = 1.; ///< width of a ring over that of the next one outwards
  };

  /// What fills the outline of a pin.
  struct PinGrid
  {
    std::vector<Plan::Face>   faces;
    std::vector<unsigned int> ring_nodes; ///< inside the outline, of rings
  };

  /**
   * Fills a closed polygon of 6 k nodes, counter-clockwise, with three blocks of
   * k x k quadrilaterals around its centre: 3 k (k + 1) + 1 nodes in total. The
   * first node and every 2 k-th after it lie at the end of a spoke. Appends the
   * new nodes to @p points.
   */
  std::vector<Plan::Face> fill_with_o_grid(const std::vector<unsigned int> &loop, std::vector<Plan::Point> &points);

  /**
   * The same with rings of 6 k quadrilaterals each between the outline and the blocks, which adds 6 k nodes for each ring.
   *
   * On a round outline the outer corners of the blocks, one for each, are flat: their two edges meet at 180 - 60 / k degrees, and at
   * 180 degrees where elements follow the circle. There, at the held end of the pin, stresses are singular as well. Rings have right
   * angles at the outline. All but the innermost ring lie between outlines scaled towards the centre, down to four fifths; the
   * innermost one goes from there to a triangle with bulging sides, halfway between the arcs and the chords from corner to corner, so that
   * the corners of the blocks have less than 130 degrees.
   */
  PinGrid fill_pin(const std::vector<unsigned int> &outline, const PinRings &rings, std::vector<Plan::Point> &points);
} // namespace Squeal
