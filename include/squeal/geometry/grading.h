#pragma once

#include <vector>

namespace Squeal
{
  /**
   * Ends of n intervals of [0, 1], 0 and 1 included, each interval shorter than the one before by @p ratio: all of them the same at
   * ratio 1.
   */
  std::vector<double> graded_intervals(unsigned int n, double ratio);
} // namespace Squeal
