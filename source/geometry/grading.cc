#include <squeal/geometry/grading.h>

#include <cmath>

namespace Squeal
{
  std::vector<double> graded_intervals(const unsigned int n, const double ratio)
  {
    std::vector<double> ends = {0.};
    if (ratio == 1.)
      for (unsigned int i = 1; i <= n; ++i)
        ends.push_back(double(i) / n);
    else
      for (unsigned int i = 1; i <= n; ++i)
        ends.push_back((1. - std::pow(ratio, -double(i))) / (1. - std::pow(ratio, -double(n))));
    return ends;
  }
} // namespace Squeal
