#pragma once

#include <squeal/geometry/plan.h>

namespace Squeal
{
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
} // namespace Squeal
