#pragma once

#include <squeal/tracking/branches.h>

#include <complex>
#include <optional>

namespace Squeal
{
  /// The mode of the band that grows most, or is damped least; -1: none.
  int leading_mode(const ChartPoint &point, double largest_circular_frequency);

  /// Where modes of the band begin to grow, or to grow faster than a level.
  struct GrowthOnset
  {
    double               friction_coefficient = 0.;
    double               uncertainty          = 0.; ///< of the friction coefficient: of the search and of λ
    int                  branch               = -1;
    std::complex<double> lambda; ///< there [rad/s]
  };

  /**
   * The smallest friction coefficient from which on a mode of the band grows by more than the uncertainty of λ at some point of
   * the chart: the threshold or the band crossing with which that growth begins. Growth that is there at the first point began
   * between @p before, the last friction coefficient known below the chart, and this point; the uncertainty is their distance.
   */
  std::optional<GrowthOnset> first_onset(const StabilityChart &chart, double largest_circular_frequency, double before);

  /**
   * The smallest friction coefficient at which the largest divergence rate ξ of the band exceeds a level. Modes are evaluated
   * between two points of the chart until the interval is no wider than the tolerance; the uncertainty is its width and three times
   * the estimated error of ξ by dξ/dμ. See first_onset() for @p before.
   *
   * @param level    divergence rate [-]
   * @param evaluate the function with which the chart was made
   * @param options  likewise
   */
  std::optional<GrowthOnset> onset_beyond(double                level,
                                          const StabilityChart &chart,
                                          const EvaluateChart  &evaluate,
                                          const ChartOptions   &options,
                                          double                before);
} // namespace Squeal
