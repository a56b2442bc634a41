#pragma once

#include <squeal/geometry/plan.h>

#include <vector>

namespace Squeal
{
  /**
   * Ends of n intervals of [0, 1], 0 and 1 included, each interval shorter than the one before by @p ratio: all of them the same at
   * ratio 1.
   */
  std::vector<double> graded_intervals(unsigned int n, double ratio);

  /**
   * Makes the rings of elements of round pins thinner towards the outline, each by @p ratio: nodes move on straight lines through
   * the centre, those of the outline stay. Under a pin that is held at its end stresses are singular along the edge.
   */
  void grade_round_pins(Plan &plan, double ratio);
} // namespace Squeal
