// SPDX-License-Identifier: GPL-3.0-or-later

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

    /// A mode may continue a branch if its overlap exceeds this fraction of the largest overlap: both modes of a coalescence have nearly
    /// the same shape [-].
    constexpr double alike = 0.9;

    /// Mode between points k - 1 and k of the chart that continues a branch: the mode with the largest divergence rate among the most
    /// similar modes.
    int mode_between(const StabilityChart &chart, const int branch, const int k, const ChartPoint &point)
    {
      const auto          n = static_cast<int>(point.lambda.size());
      std::vector<double> overlaps(n, 0.);
      for (const int i : {k - 1, k})
        if (const int j = chart.branches[branch].modes[i]; j >= 0)
          {
            const ComplexDenseMatrix &X = point.right, &Y = chart.points[i].right;
            const auto                r = std::min(X.rows(), Y.rows());
            for (int m = 0; m < n; ++m)
              overlaps[m] = std::max(overlaps[m], std::abs(X.col(m).head(r).dot(Y.col(j).head(r))));
          }
      const double largest = n == 0 ? 0. : *std::max_element(overlaps.begin(), overlaps.end());
      int          result  = -1;
      for (int m = 0; m < n; ++m)
        if (overlaps[m] >= alike * largest && (result < 0 || divergence_rate(point, m) > divergence_rate(point, result)))
          result = m;
      return result;
    }

    /// Friction coefficient of the point before point i; @p before for the first point.
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

  std::optional<GrowthOnset> onset_of(const int             branch,
                                      const StabilityChart &chart,
                                      const double          largest_circular_frequency,
                                      const double          before)
  {
    const std::vector<int> &modes = chart.branches[branch].modes;
    int                     i     = 0;
    while (i < static_cast<int>(modes.size()) && !grows_in_band(chart.points[i], modes[i], largest_circular_frequency))
      ++i;
    if (i == static_cast<int>(modes.size()))
      return {};
    const int    first = chart.branches[branch].begin();
    const double mu = chart.points[i].friction_coefficient, begin = chart.points[first].friction_coefficient;
    GrowthOnset  result{begin, begin - previous(chart, first, before), branch, chart.points[first].lambda[modes[first]]};
    for (const Threshold &threshold : chart.thresholds)
      if (threshold.branch == branch && threshold.event == ThresholdEvent::onset && threshold.friction_coefficient <= mu)
        result = {threshold.friction_coefficient, threshold.uncertainty, branch, threshold.lambda};
    for (const BandCrossing &crossing : chart.crossings)
      if (crossing.branch == branch && crossing.enters && crossing.friction_coefficient <= mu &&
          crossing.friction_coefficient > result.friction_coefficient)
        result = {crossing.friction_coefficient, crossing.uncertainty, branch, chart.points[i].lambda[modes[i]]};
    return result;
  }

  std::optional<GrowthOnset> first_onset(const StabilityChart &chart, const double largest_circular_frequency, const double before)
  {
    std::optional<GrowthOnset> result;
    for (int b = 0; b < static_cast<int>(chart.branches.size()); ++b)
      if (const auto found = onset_of(b, chart, largest_circular_frequency, before);
          found && (!result || found->friction_coefficient < result->friction_coefficient))
        result = found;
    return result;
  }

  std::optional<GrowthOnset> onset_beyond(const double          level,
                                          const StabilityChart &chart,
                                          const EvaluateChart  &evaluate,
                                          const ChartOptions   &options,
                                          const double          before,
                                          const int             branch)
  {
    const double omega_max = options.largest_circular_frequency;
    const auto   excess    = [&](const ChartPoint &point, const int mode) {
      return mode < 0 || point.lambda[mode].imag() > omega_max ? -level : divergence_rate(point, mode) - level;
    };
    const auto mode_of = [&](const int i) {
      return branch < 0 ? leading_mode(chart.points[i], omega_max) : chart.branches[branch].modes[i];
    };
    const auto excess_of = [&](const int i) { return excess(chart.points[i], mode_of(i)); };
    const auto branch_of = [&](const int i, const ChartPoint &point, const int mode) {
      return branch < 0 ? similar_branch(chart, i, point, mode, true) : branch;
    };
    const int n = static_cast<int>(chart.points.size());
    int       k = 0;
    while (k < n && !(excess_of(k) > 0. && grows_in_band(chart.points[k], mode_of(k), omega_max)))
      ++k;
    if (k == n)
      return {};
    while (k > 0 && excess_of(k - 1) > 0.)
      --k;
    const ChartPoint &above = chart.points[k];
    const double      right = above.friction_coefficient, left = previous(chart, k, before);
    if (k == 0)
      return GrowthOnset{right, right - left, branch_of(0, above, mode_of(0)), above.lambda[mode_of(0)]};

    const auto at      = [&](const double mu) { return evaluate({mu}).front(); };
    const auto mode_at = [&](const ChartPoint &point) {
      return branch < 0 ? leading_mode(point, omega_max) : mode_between(chart, branch, k, point);
    };
    const auto value = [&](const double mu) {
      const ChartPoint point = at(mu);
      return excess(point, mode_at(point));
    };
    const auto       is_close = [&](const double a, const double b) { return std::abs(b - a) <= options.threshold_tolerance; };
    std::uintmax_t   n_steps  = 60;
    const auto       bracket  = boost::math::tools::toms748_solve(value, left, right, excess_of(k - 1), excess_of(k), is_close, n_steps);
    const double     width    = bracket.second - bracket.first;
    const ChartPoint there    = at(bracket.second);
    const int        mode     = mode_at(there);
    // Compute the slope over a finite step, because growth may begin as √(μ − μ_c)
    const double step      = std::max(width, 1e-3 * (right - left));
    const double far       = bracket.second + step <= right ? bracket.second + step : bracket.second - step;
    const double slope     = (value(far) - excess(there, mode)) / (far - bracket.second);
    const double by_lambda = slope > 0. ? error_safety * there.errors[mode] / slope : right - left;
    return GrowthOnset{bracket.second, width + by_lambda, branch_of(k, there, mode), there.lambda[mode]};
  }
} // namespace Squeal
