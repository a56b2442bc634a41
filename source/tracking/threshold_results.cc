#include "tracked_modes.h"

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// δ² / |λ|² of pairs far enough from their coalescence for corrections to be read there.
    constexpr double separate = 1e-6;

    /// Zero of a search, with what is left of its interval.
    std::pair<double, double> zero(const TrackedModes &modes, const EventSearch &search)
    {
      const int    k = search.interval;
      const double l = modes.mu(k), r = modes.mu(k + 1);
      if (search.at_once && grows_at_once(modes, search))
        return {l, 0.};
      // The growth of a double mode emerges from rounding errors only here
      if (search.multiple)
        return {modes.mu(0), r - modes.mu(0)};
      if (modes.width(k) > modes.tolerance(k))
        return {0.5 * (l + r), 0.5 * (r - l)};
      const auto fl = search_value(modes, search, k), fr = search_value(modes, search, k + 1);
      if (!fl || !fr || !(*fl * *fr < 0.))
        return {0.5 * (l + r), r - l};
      return {l - *fl * (r - l) / (*fr - *fl), r - l};
    }

    /// |df/dμ| over the points around an interval.
    double slope(const TrackedModes &modes, const EventSearch &search)
    {
      const int  k     = search.interval;
      const int  first = search_value(modes, search, k - 1) ? k - 1 : k, last = search_value(modes, search, k + 2) ? k + 2 : k + 1;
      const auto fl = search_value(modes, search, first), fr = search_value(modes, search, last);
      return fl && fr ? std::abs(*fr - *fl) / (modes.mu(last) - modes.mu(first)) : 0.;
    }

    /**
     * What corrections change of Re λ (growth) or Im λ to second order, the latter without regard to its sign; no more than the
     * uncertainty of λ, which is what remains at the real axis and where no corrections are known.
     */
    double uncertainty_of_lambda(const TrackedModes &modes, const EventSearch &search)
    {
      double result = 0.;
      for (const int k : {search.interval, search.interval + 1})
        if (const int m = modes.mode(search.branch, k); m >= 0)
          {
            const ChartPoint         &point  = modes.points[k];
            const double              bound  = m < static_cast<int>(point.uncertainties.size()) ? point.uncertainties[m] : 0.;
            const ComplexDenseMatrix &D      = point.corrections;
            double                    change = bound;
            if (m < D.rows() && search.kind != EventSearch::real_axis)
              {
                change = std::abs(search.kind == EventSearch::growth ? D(m, m).real() : D(m, m).imag());
                for (int j = 0; j < D.cols(); ++j)
                  if (const Complex product = D(m, j) * D(j, m); j != m && product != 0.)
                    change += std::abs(product / (point.lambda[m] - point.lambda[j]));
              }
            result = std::max(result, std::min(change, bound));
          }
      return result;
    }

    /// What corrections change of δ² at point k.
    double change_of_discriminant(const TrackedModes &modes, const EventSearch &search, const int k)
    {
      const ComplexDenseMatrix &D = modes.points[k].corrections;
      const int                 i = modes.mode(search.branch, k), j = modes.mode(search.partner, k);
      if (std::max(i, j) >= D.rows() || std::max(i, j) >= D.cols())
        return 0.;
      const Complex shift = D(i, i) - D(j, j);
      return std::abs(shift * (2. * (modes.points[k].lambda[i] - modes.points[k].lambda[j]) + shift) + 4. * D(i, j) * D(j, i));
    }

    /// Shift of μ at a coalescence by corrections read on both sides at points away from it.
    double shift_of_coalescence(const TrackedModes &modes, const EventSearch &search, const double threshold)
    {
      double result = 0.;
      for (const int direction : {-1, 1})
        {
          const int start = direction < 0 ? search.interval : search.interval + 1;
          int       best  = -1;
          double    f     = 0.; // at the best point
          for (int k = start; const auto here = search_value(modes, search, k); k += direction)
            {
              if (best >= 0 && (*here * f < 0. || std::abs(*here) < std::abs(f)))
                break;
              best = k;
              f    = *here;
              if (std::abs(f) > separate * std::norm(modes.lambda(search.branch, k)) || !modes.is_refinement[k])
                break;
            }
          if (best < 0 || modes.mu(best) == threshold)
            continue;
          const double distance = std::abs(modes.mu(best) - threshold), part = change_of_discriminant(modes, search, best) / std::abs(f);
          if (f != 0.)
            // δ² ~ (μ − μ_0)² where a double mode grows at once, else linear
            result = std::max(result, distance * (search.at_once || search.multiple ? std::sqrt(part) : part));
        }
      return result;
    }

    double uncertainty(const TrackedModes &modes, const EventSearch &search, const double threshold)
    {
      if (search.kind == EventSearch::coalescence)
        return error_safety * shift_of_coalescence(modes, search, threshold);
      double error = error_safety * uncertainty_of_lambda(modes, search);
      // Im λ = √|f| changes by the error: f by 2 √|f| times as much, away from the axis
      if (search.kind == EventSearch::real_axis)
        error *= 2. * modes.lambda(search.branch, search.upward ? search.interval + 1 : search.interval).imag();
      return error == 0. ? 0. : error / slope(modes, search);
    }

    Complex lambda_at(const TrackedModes &modes, const EventSearch &search, const double threshold)
    {
      const int  k    = search.multiple ? 0 : search.interval;
      const auto mean = [&](const int point) {
        return search.partner >= 0 ? 0.5 * (modes.lambda(search.branch, point) + modes.lambda(search.partner, point)) :
                                     modes.lambda(search.branch, point);
      };
      const double t = (threshold - modes.mu(k)) / modes.width(k);
      return (1. - t) * mean(k) + t * mean(k + 1);
    }
  } // namespace

  StabilityChart finished_chart(TrackedModes modes, const std::vector<EventSearch> &searches)
  {
    StabilityChart   result;
    std::vector<int> change(modes.n_points(), 0);
    for (const EventSearch &search : searches)
      {
        const auto [threshold, left] = zero(modes, search);
        const double total           = left + uncertainty(modes, search, threshold);
        if (search.kind == EventSearch::growth || search.kind == EventSearch::coalescence)
          result.thresholds.push_back(
            {threshold, total, search.upward ? ThresholdEvent::onset : ThresholdEvent::restabilisation,
             search.kind == EventSearch::growth ? ThresholdMechanism::zero_growth : ThresholdMechanism::coalescence, search.branch,
             search.partner, lambda_at(modes, search, threshold)});
        else
          {
            result.crossings.push_back({threshold, total, search.branch, search.upward,
                                        search.kind == EventSearch::real_axis ? BandEdge::real_axis : BandEdge::end_of_band});
            change[search.interval + 1] += search.upward ? 1 : -1;
          }
      }
    const auto ascending = [](const auto &x, const auto &y) { return x.friction_coefficient < y.friction_coefficient; };
    std::stable_sort(result.thresholds.begin(), result.thresholds.end(), ascending);
    std::stable_sort(result.crossings.begin(), result.crossings.end(), ascending);

    int expected = 0;
    for (int k = 0; k < modes.n_points(); ++k)
      {
        const auto &values  = modes.points[k].lambda;
        const int   n_modes = std::count_if(values.begin(), values.end(),
                                            [&](const Complex &l) { return l.imag() <= modes.options.largest_circular_frequency; });
        expected            = k == 0 ? n_modes : expected + change[k];
        result.counts.push_back({modes.mu(k), n_modes, expected, static_cast<int>(modes.points[k].real_values.size()) / 2});
        if (k + 1 < modes.n_points() && !modes.intervals[k].links->resolved)
          ++result.n_doubtful_steps;
      }
    result.points        = std::move(modes.points);
    result.is_refinement = std::move(modes.is_refinement);
    result.branches      = std::move(modes.branches);
    return result;
  }
} // namespace Squeal
