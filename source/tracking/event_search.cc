// SPDX-License-Identifier: GPL-3.0-or-later

#include "tracked_modes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Largest |λ_1 + λ̄_2| / R of two modes ±R + iω: differences up to this limit are rounding errors [-].
    constexpr double mirror_tolerance = 1e-6;

    /// Pairs with a larger δ² / |λ|² are far enough from their coalescence for the use of corrections [-].
    constexpr double separate = 1e-6;

    Complex square_difference(const Complex &x, const Complex &y)
    {
      return (x - y) * (x - y);
    }

    bool in_band(const TrackedModes &modes, const int branch, const int k)
    {
      return modes.mode(branch, k) >= 0 && modes.lambda(branch, k).imag() <= modes.options.largest_circular_frequency;
    }

    /// True if two modes form one double mode at a point.
    bool is_double(const TrackedModes &modes, const EventSearch &search, const int k)
    {
      return modes.mode(search.branch, k) >= 0 && modes.mode(search.partner, k) >= 0 &&
             std::abs(modes.lambda(search.branch, k) - modes.lambda(search.partner, k)) <=
               indistinguishable * std::abs(modes.lambda(search.branch, k));
    }

    /// Branch with −R + iω if the given branch has R + iω; -1: none.
    int mirror_branch(const TrackedModes &modes, const int branch, const int k)
    {
      const Complex here = modes.lambda(branch, k);
      int           best = -1;
      // Allow for rounding errors of λ, because R is small close to a coalescence
      double least = std::max(mirror_tolerance * std::abs(here.real()), 1e-13 * std::abs(here));
      for (std::size_t j = 0; j < modes.points[k].lambda.size(); ++j)
        if (const double distance = std::abs(modes.points[k].lambda[j] + std::conj(here));
            static_cast<int>(j) != modes.mode(branch, k) && distance <= least)
          {
            least = distance;
            best  = modes.branch_of[k][j];
          }
      return best;
    }

    /// Moves the interval of a threshold to the sign change of its function, because growth is detected only above a negligible rate.
    void enclose(const TrackedModes &modes, EventSearch &search)
    {
      const int direction = search.upward ? -1 : 1;
      for (int k = search.upward ? search.interval : search.interval + 1;; k += direction)
        {
          const auto f = search_value(modes, search, k);
          if (f && *f <= 0.)
            search.interval = search.upward ? k : k - 1;
          if (!f || *f <= 0. || modes.verdict(search.branch, k) != Verdict::neutral)
            return;
        }
    }

    std::optional<EventSearch> find_threshold(const TrackedModes &modes, const int k, const int branch)
    {
      const auto grows   = [&](const int point) { return modes.verdict(branch, point) == Verdict::unstable; };
      const auto neutral = [&](const int of, const int point) { return modes.verdict(of, point) == Verdict::neutral; };
      const bool onset   = grows(k + 1);
      if (grows(k) == onset)
        return {};
      const int   growing = onset ? k + 1 : k, other = onset ? k : k + 1;
      const int   partner = mirror_branch(modes, branch, growing);
      EventSearch search{EventSearch::growth, k, branch, -1, onset};
      if (partner >= 0 && modes.mode(partner, other) >= 0 && neutral(branch, other) && neutral(partner, other))
        {
          search.kind    = EventSearch::coalescence;
          search.partner = partner;
        }
      enclose(modes, search);
      search.at_once =
        search.interval == 0 && onset && neutral(branch, 0) && (search.kind == EventSearch::growth || is_double(modes, search, 0));
      if (onset && search.kind == EventSearch::coalescence && search.interval > 0)
        {
          search.multiple = true;
          for (int point = 0; point <= search.interval && search.multiple; ++point)
            search.multiple = is_double(modes, search, point);
        }
      return search;
    }

    /// ((λ_1 − λ_2)/2)² of the two adjacent real eigenvalues that replace the oscillating mode of a search.
    std::optional<double> real_pair(const TrackedModes &modes, const EventSearch &search, const int k)
    {
      const int                  seen   = search.upward ? search.interval + 1 : search.interval;
      const double               centre = modes.lambda(search.branch, seen).real();
      const std::vector<double> &values = modes.points[k].real_values;
      std::optional<double>      best;
      double                     least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i + 1 < values.size(); ++i)
        if (const double distance = std::abs(0.5 * (values[i] + values[i + 1]) - centre); distance < least)
          {
            least = distance;
            best  = 0.25 * square_difference(values[i], values[i + 1]).real();
          }
      return best;
    }

    /// Zero of a search, and its uncertainty due to the remaining interval.
    std::pair<double, double> zero(const TrackedModes &modes, const EventSearch &search)
    {
      const int    k = search.interval;
      const double l = modes.mu(k), r = modes.mu(k + 1);
      if (search.at_once && grows_at_once(modes, search))
        return {l, 0.};
      // The growth of the double mode exceeds rounding errors only in this interval: the onset may be anywhere from the first point to the
      // end of the interval
      if (search.multiple)
        return {modes.mu(0), r - modes.mu(0)};
      if (modes.width(k) > modes.tolerance(k))
        return {0.5 * (l + r), 0.5 * (r - l)};
      const auto fl = search_value(modes, search, k), fr = search_value(modes, search, k + 1);
      if (!fl || !fr || !(*fl * *fr < 0.))
        return {0.5 * (l + r), r - l};
      return {l - *fl * (r - l) / (*fr - *fl), r - l};
    }

    /// |df/dμ| from the points around an interval.
    double slope(const TrackedModes &modes, const EventSearch &search)
    {
      const int  k     = search.interval;
      const int  first = search_value(modes, search, k - 1) ? k - 1 : k, last = search_value(modes, search, k + 2) ? k + 2 : k + 1;
      const auto fl = search_value(modes, search, first), fr = search_value(modes, search, last);
      return fl && fr ? std::abs(*fr - *fl) / (modes.mu(last) - modes.mu(first)) : 0.;
    }

    /// Effect of the corrections, to second order, on Re λ (growth) or |Im λ|, at most the uncertainty of λ. At the real axis, and without
    /// corrections, the result is the uncertainty of λ.
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

    /// Effect of the corrections on δ² at point k.
    double change_of_discriminant(const TrackedModes &modes, const EventSearch &search, const int k)
    {
      const ComplexDenseMatrix &D = modes.points[k].corrections;
      const int                 i = modes.mode(search.branch, k), j = modes.mode(search.partner, k);
      if (std::max(i, j) >= D.rows() || std::max(i, j) >= D.cols())
        return 0.;
      const Complex shift = D(i, i) - D(j, j);
      return std::abs(shift * (2. * (modes.points[k].lambda[i] - modes.points[k].lambda[j]) + shift) + 4. * D(i, j) * D(j, i));
    }

    /// Shift of μ at a coalescence due to corrections, evaluated at points on both sides at some distance.
    double shift_of_coalescence(const TrackedModes &modes, const EventSearch &search, const double threshold)
    {
      double result = 0.;
      for (const int direction : {-1, 1})
        {
          const int start = direction < 0 ? search.interval : search.interval + 1;
          int       best  = -1;
          double    f     = 0.; // value of the function at the best point
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
            // δ² ~ (μ − μ_0)² if a double mode grows from the first point, else δ² ~ μ − μ_0
            result = std::max(result, distance * (search.at_once || search.multiple ? std::sqrt(part) : part));
        }
      return result;
    }

    double uncertainty(const TrackedModes &modes, const EventSearch &search, const double threshold)
    {
      if (search.kind == EventSearch::coalescence)
        return error_safety * shift_of_coalescence(modes, search, threshold);
      double error = error_safety * uncertainty_of_lambda(modes, search);
      // Im λ = √|f|: an error of Im λ changes f by 2 √|f| times this error
      if (search.kind == EventSearch::real_axis)
        error *= 2. * modes.lambda(search.branch, search.upward ? search.interval + 1 : search.interval).imag();
      if (error == 0.)
        return 0.;
      // The slope cannot be computed if the mode is missing at one end of the interval: use the width of the interval
      const double change = slope(modes, search);
      return change > 0. ? error / change : modes.width(search.interval);
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

  std::optional<double> search_value(const TrackedModes &modes, const EventSearch &search, const int k)
  {
    if (k < 0 || k >= modes.n_points())
      return std::nullopt;
    if (modes.mode(search.branch, k) < 0)
      return search.kind == EventSearch::real_axis ? real_pair(modes, search, k) : std::nullopt;
    const Complex lambda = modes.lambda(search.branch, k);
    switch (search.kind)
      {
        case EventSearch::growth:
          return lambda.real();
        case EventSearch::coalescence:
          if (modes.mode(search.partner, k) < 0)
            return std::nullopt;
          return square_difference(lambda, modes.lambda(search.partner, k)).real();
        case EventSearch::end_of_band:
          return lambda.imag() - modes.options.largest_circular_frequency;
        case EventSearch::real_axis:
          return -lambda.imag() * lambda.imag();
      }
    return std::nullopt;
  }

  bool grows_at_once(const TrackedModes &modes, const EventSearch &search)
  {
    if (modes.width(0) <= modes.options.smallest_step)
      return true;
    const auto near = search_value(modes, search, 1), far = search_value(modes, search, 2);
    if (!near || !far || modes.verdict(search.branch, 2) != Verdict::unstable)
      return false;
    const double power = search.kind == EventSearch::coalescence ? 2. : 1., h1 = modes.mu(1) - modes.mu(0), h2 = modes.mu(2) - modes.mu(0);
    const double q1 = *near / std::pow(h1, power), q2 = *far / std::pow(h2, power), q0 = q1 + (q1 - q2) * h1 / (h2 - h1);
    return q0 > 0.5 * q1 && q0 < 2. * q1;
  }

  std::vector<EventSearch> find_events(const TrackedModes &modes)
  {
    std::vector<EventSearch> searches;
    for (int k = 0; k + 1 < modes.n_points(); ++k)
      {
        for (int b = 0; b < static_cast<int>(modes.branches.size()); ++b)
          if (modes.mode(b, k) >= 0 && modes.mode(b, k + 1) >= 0)
            {
              if (const auto threshold = find_threshold(modes, k, b))
                searches.push_back(*threshold);
              if (const bool after = in_band(modes, b, k + 1); after != in_band(modes, b, k))
                searches.push_back({EventSearch::end_of_band, k, b, -1, after});
            }
        // Ignore modes beyond the band, where the lists of modes are truncated
        const ModeLinks &links = *modes.intervals[k].links;
        const int        n_new = modes.points[k + 1].n_real() - modes.points[k].n_real();
        for (const int i : links.lost)
          if (n_new > 0 && modes.points[k].lambda[i].imag() <= modes.options.largest_circular_frequency)
            searches.push_back({EventSearch::real_axis, k, modes.branch_of[k][i], -1, false});
        for (const int j : links.gained)
          if (n_new < 0 && modes.points[k + 1].lambda[j].imag() <= modes.options.largest_circular_frequency)
            searches.push_back({EventSearch::real_axis, k, modes.branch_of[k + 1][j], -1, true});
      }
    return searches;
  }

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
