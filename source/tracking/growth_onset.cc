#include <squeal/base/conventions.h>
#include <squeal/tracking/branches.h>

#include <boost/math/tools/roots.hpp>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    double divergence_rate(const ChartPoint &point, const int mode)
    {
      return modal_quantities(point.lambda[mode]).divergence_rate;
    }

    bool grows_in_band(const ChartPoint &point, const int mode, const double largest_circular_frequency)
    {
      return mode >= 0 && point.lambda[mode].imag() <= largest_circular_frequency && point.verdicts[mode] == Verdict::unstable;
    }

    /// Friction coefficient of the point before point i.
    double previous(const StabilityChart &chart, const int i, const double before)
    {
      return i > 0 ? chart.points[i - 1].friction_coefficient : before;
    }
  } // namespace

  int similar_branch(const StabilityChart &chart, const int k, const ChartPoint &point, const int mode, const bool is_growing)
  {
    int    result  = -1;
    double largest = 0.;
    for (int b = 0; b < static_cast<int>(chart.branches.size()); ++b)
      if (const int j = chart.branches[b].modes[k]; j >= 0 && (!is_growing || chart.points[k].lambda[j].real() > 0.))
        {
          const ComplexDenseMatrix &X = point.right, &Y = chart.points[k].right;
          const auto                r       = std::min(X.rows(), Y.rows());
          const double              overlap = std::abs(X.col(mode).head(r).dot(Y.col(j).head(r)));
          if (overlap > largest)
            {
              largest = overlap;
              result  = b;
            }
        }
    return result;
  }

  int leading_mode(const ChartPoint &point, const double largest_circular_frequency)
  {
    int result = -1;
    for (int j = 0; j < static_cast<int>(point.lambda.size()); ++j)
      if (point.lambda[j].imag() <= largest_circular_frequency &&
          (result < 0 || divergence_rate(point, j) > divergence_rate(point, result)))
        result = j;
    return result;
  }

  std::optional<GrowthOnset> first_onset(const StabilityChart &chart, const double largest_circular_frequency, const double before)
  {
    std::optional<GrowthOnset> result;
    for (int b = 0; b < static_cast<int>(chart.branches.size()); ++b)
      {
        const std::vector<int> &modes = chart.branches[b].modes;
        int                     i     = 0;
        while (i < static_cast<int>(modes.size()) && !grows_in_band(chart.points[i], modes[i], largest_circular_frequency))
          ++i;
        if (i == static_cast<int>(modes.size()))
          continue;
        const int    first = chart.branches[b].begin();
        const double mu = chart.points[i].friction_coefficient, begin = chart.points[first].friction_coefficient;
        GrowthOnset  found{begin, begin - previous(chart, first, before), b, chart.points[first].lambda[modes[first]]};
        for (const Threshold &threshold : chart.thresholds)
          if (threshold.branch == b && threshold.event == ThresholdEvent::onset && threshold.friction_coefficient <= mu)
            found = {threshold.friction_coefficient, threshold.uncertainty, b, threshold.lambda};
        for (const BandCrossing &crossing : chart.crossings)
          if (crossing.branch == b && crossing.enters && crossing.friction_coefficient <= mu &&
              crossing.friction_coefficient > found.friction_coefficient)
            found = {crossing.friction_coefficient, crossing.uncertainty, b, chart.points[i].lambda[modes[i]]};
        if (!result || found.friction_coefficient < result->friction_coefficient)
          result = found;
      }
    return result;
  }

  std::optional<GrowthOnset> onset_beyond(const double          level,
                                          const StabilityChart &chart,
                                          const EvaluateChart  &evaluate,
                                          const ChartOptions   &options,
                                          const double          before)
  {
    const double omega_max = options.largest_circular_frequency;
    const auto   excess    = [&](const ChartPoint &point) {
      const int leading = leading_mode(point, omega_max);
      return leading < 0 ? -level : divergence_rate(point, leading) - level;
    };
    const auto first = std::find_if(chart.points.begin(), chart.points.end(), [&](const ChartPoint &point) {
      const int leading = leading_mode(point, omega_max);
      return grows_in_band(point, leading, omega_max) && divergence_rate(point, leading) > level;
    });
    if (first == chart.points.end())
      return {};
    int k = static_cast<int>(first - chart.points.begin());
    while (k > 0 && excess(chart.points[k - 1]) > 0.)
      --k;
    const ChartPoint &above = chart.points[k];
    const double      right = above.friction_coefficient, left = previous(chart, k, before);
    if (k == 0)
      {
        const int leading = leading_mode(above, omega_max);
        return GrowthOnset{right, right - left, similar_branch(chart, 0, above, leading, true), above.lambda[leading]};
      }

    const auto     at       = [&](const double mu) { return evaluate({mu}).front(); };
    const auto     value    = [&](const double mu) { return excess(at(mu)); };
    const auto     is_close = [&](const double a, const double b) { return std::abs(b - a) <= options.threshold_tolerance; };
    std::uintmax_t n_steps  = 60;
    const auto     bracket =
      boost::math::tools::toms748_solve(value, left, right, excess(chart.points[k - 1]), excess(above), is_close, n_steps);
    const double     width = bracket.second - bracket.first;
    const ChartPoint there = at(bracket.second);
    const int        mode  = leading_mode(there, omega_max);
    // Growth by √(μ − μ_c) or by its slope: across the bracket or a short step behind it
    const double step      = std::max(width, 1e-3 * (right - left));
    const double far       = bracket.second + step <= right ? bracket.second + step : bracket.second - step;
    const double slope     = (value(far) - excess(there)) / (far - bracket.second);
    const double by_lambda = slope > 0. ? error_safety * there.errors[mode] / slope : right - left;
    return GrowthOnset{bracket.second, width + by_lambda, similar_branch(chart, k, there, mode, true), there.lambda[mode]};
  }
} // namespace Squeal
