// SPDX-License-Identifier: GPL-3.0-or-later

#include "tracked_modes.h"

#include <squeal/base/tasks.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Largest |Im (λ_1 − λ_2)| / Im λ_1 of modes that may coalesce within a step [-].
    constexpr double nearby = 0.1;
    /// An approach to zero is evaluated if the predicted |δ²| or |Re λ| falls below this fraction of its smaller value at the ends of the
    /// step [-].
    constexpr double remaining = 0.3;
    /// Two modes do not interact if their coupling is below this fraction of the difference between their growth rates [-].
    constexpr double interacting = 0.1;
    /// Two modes with a larger |Re (λ_1 − λ_2)| / |Im (λ_1 − λ_2)| are assumed not to coalesce because their growth rates differ [-].
    constexpr double other_growth = 0.5;
    /// Fraction of a step within which several approaches share one evaluation [-].
    constexpr double one_look = 0.2;
    /// Number of successive steps that reduce the interval by less than half before it is bisected.
    constexpr int patience = 2;
    /// Number of such steps before predictions are no longer used; each prediction adds up to two points.
    constexpr int most_predictions = 5;

    /// True if a step must be divided before the mode of a branch can be distinguished from others.
    bool is_tangled(const TrackedModes &modes, const int k, const int branch)
    {
      if (modes.width(k) <= modes.options.smallest_step)
        return false;
      const std::vector<ModeBlock> &blocks = modes.intervals[k].links->blocks;
      return std::any_of(blocks.begin(), blocks.end(), [&](const ModeBlock &block) {
        return !block.resolved && std::find(block.first.begin(), block.first.end(), modes.mode(branch, k)) != block.first.end();
      });
    }

    bool located(const TrackedModes &modes, const EventSearch &search)
    {
      return search.multiple || modes.width(search.interval) <= modes.tolerance(search.interval) ||
             (search.at_once && grows_at_once(modes, search));
    }

    /// Next point of the search for a zero.
    double proposal(const TrackedModes &modes, const EventSearch &search)
    {
      const int    k = search.interval;
      const double l = modes.mu(k), r = modes.mu(k + 1), middle = 0.5 * (l + r);
      const auto   fl = search_value(modes, search, k), fr = search_value(modes, search, k + 1);
      if (search.at_once || !fl || !fr || !(*fl * *fr <= 0.) || *fl == *fr || modes.intervals[k].stalls >= patience)
        return middle;

      double x = l - *fl * (r - l) / (*fr - *fl);
      // The nearer neighbour is the third point of inverse quadratic interpolation
      const auto before = search_value(modes, search, k - 1), after = search_value(modes, search, k + 2);
      const bool left = before && (!after || modes.width(k - 1) < modes.width(k + 1));
      if (const auto fc = left ? before : after; fc && *fc != *fl && *fc != *fr)
        {
          const double c = left ? modes.mu(k - 1) : modes.mu(k + 2);
          const double q = l * *fr * *fc / ((*fl - *fr) * (*fl - *fc)) + r * *fl * *fc / ((*fr - *fl) * (*fr - *fc)) +
                           c * *fl * *fr / ((*fc - *fl) * (*fc - *fr));
          if (q > l && q < r)
            x = q;
        }
      // Choose a point slightly beyond the zero, as seen from the nearer end of the interval. The next interval is then normally short, and
      // points avoid the exact coalescence, where eigenvectors coincide
      const double margin = 0.5 * std::min(modes.tolerance(k), r - l);
      return std::clamp(x + (x < middle ? 0.5 : -0.5) * margin, l + margin, r - margin);
    }

    /// Points on both sides of the predicted zero, at a distance smaller than the tolerance; empty without a prediction.
    std::vector<double> predictions(const TrackedModes &modes, const EventSearch &search, const PredictZero &predict)
    {
      const int k = search.interval;
      if (!predict || search.at_once || search.multiple || search.kind == EventSearch::real_axis ||
          modes.intervals[k].stalls > most_predictions)
        return {};
      const auto at = [&](const int point) -> std::optional<ModesAtPoint> {
        if (point < 0 || point >= modes.n_points())
          return {};
        ModesAtPoint result{&modes.points[point], {}};
        for (const int branch : {search.branch, search.partner})
          if (branch >= 0)
            {
              result.modes.push_back(modes.mode(branch, point));
              if (result.modes.back() < 0)
                return {};
            }
        return result;
      };
      const auto first = at(k), second = at(k + 1);
      if (!first || !second)
        return {};
      ZeroSearch asked{search.kind == EventSearch::growth      ? ModeFunction::growth :
                       search.kind == EventSearch::coalescence ? ModeFunction::discriminant :
                                                                 ModeFunction::frequency,
                       modes.options.largest_circular_frequency,
                       *first,
                       *second,
                       {}};
      for (const int point : {k - 1, k + 2})
        if (const auto found = at(point))
          asked.beyond.push_back(*found);
      const auto zero = predict(asked);
      if (!zero)
        return {};
      std::vector<double> result;
      const double        half = 0.3 * modes.tolerance(k);
      for (const double value : {*zero - half, *zero + half})
        if (value > modes.mu(k) && value < modes.mu(k + 1))
          result.push_back(value);
      return result;
    }

    /// True if two modes are beyond the band at both ends of a step and therefore not in the results.
    bool are_beyond(const TrackedModes &modes, const int k, const int p, const int q)
    {
      const double limit = modes.options.largest_circular_frequency;
      for (const int branch : {p, q})
        for (const int point : {k, k + 1})
          if (modes.lambda(branch, point).imag() <= limit)
            return false;
      return true;
    }

    /**
     * Points at which branches that exchange their order in a step would coalesce if they interact. The 2 × 2 problem is interpolated
     * linearly between the diagonal matrix Λ_a and B = X Λ_b X⁻¹ with Φ_b = Φ_a X. At the position t at which the frequencies are equal, δ²
     * = (Re λ_1 − Re λ_2)² + 4 t² B_12 B_21. Modes whose growth rates differ too much are ignored.
     */
    std::vector<double> interactions(const TrackedModes &modes, const int k)
    {
      std::vector<double> result;
      const ChartPoint   &a = modes.points[k], &b = modes.points[k + 1];
      const int           r = std::max(a.right.rows(), b.right.rows());
      for (std::size_t p = 0; p < modes.branches.size(); ++p)
        for (std::size_t q = 0; q < p; ++q)
          {
            if (modes.mode(p, k) < 0 || modes.mode(q, k) < 0 || modes.mode(p, k + 1) < 0 || modes.mode(q, k + 1) < 0 ||
                are_beyond(modes, k, p, q))
              continue;
            const Complex before = modes.lambda(p, k) - modes.lambda(q, k), after = modes.lambda(p, k + 1) - modes.lambda(q, k + 1);
            const double  size = std::abs(modes.lambda(p, k)), least = indistinguishable * size;
            if (before.imag() * after.imag() >= 0. || std::min(std::abs(before), std::abs(after)) <= least)
              continue;
            const auto X =
              transformation(with_rows(a.right(Eigen::placeholders::all, std::vector{modes.mode(p, k), modes.mode(q, k)}), r),
                             with_rows(b.right(Eigen::placeholders::all, std::vector{modes.mode(p, k + 1), modes.mode(q, k + 1)}), r));
            if (!X)
              continue;
            const double  t            = before.imag() / (before.imag() - after.imag());
            const Complex product      = -X->X(0, 0) * X->inverse(0, 1) * X->X(1, 1) * X->inverse(1, 0) * after * after;
            const Complex discriminant = 4. * t * t * product;
            const double  gap          = std::sqrt(std::abs(discriminant));
            if (gap < interacting * std::abs((1. - t) * before.real() + t * after.real()))
              continue;
            // Frequencies that only repel each other are close over a range of gap / slope: ignore ranges below the smallest step
            const bool repel =
              discriminant.real() < 0. && modes.verdict(p, k) == Verdict::neutral && modes.verdict(q, k) == Verdict::neutral;
            const double extent = gap * modes.width(k) / std::abs(after.imag() - before.imag());
            if (gap > least && !(repel && extent < modes.options.smallest_step))
              {
                const double x = modes.mu(k) + t * modes.width(k), margin = 0.25 * modes.options.smallest_step;
                result.push_back(std::clamp(x, modes.mu(k) + margin, modes.mu(k + 1) - margin));
              }
          }
      return result;
    }

    /// Point within a step at which a negative function is closer to zero than at the ends.
    std::optional<double> peak_within(const TrackedModes &modes, const EventSearch &search)
    {
      const int    k    = search.interval;
      const double ends = std::max(*search_value(modes, search, k), *search_value(modes, search, k + 1));
      if (ends >= 0.)
        return std::nullopt;
      std::vector<double> x, f;
      for (int point = k - 1; point <= k + 2; ++point)
        if (const auto y = search_value(modes, search, point))
          {
            // Skip points at which the function is larger than at the adjacent end of the step, and points of much shorter steps, whose
            // differences are dominated by rounding errors
            if ((point < k && (modes.width(point) < 0.1 * modes.width(k) || *y > *search_value(modes, search, k))) ||
                (point > k + 1 && (modes.width(point - 1) < 0.1 * modes.width(k) || *y > *search_value(modes, search, k + 1))))
              continue;
            x.push_back(modes.mu(point));
            f.push_back(*y);
          }
      if (x.size() < 3)
        return std::nullopt;

      // Coefficients of the products in the Lagrange polynomial
      for (std::size_t a = 0; a < x.size(); ++a)
        for (std::size_t b = 0; b < x.size(); ++b)
          if (a != b)
            f[a] /= x[a] - x[b];
      double                peak = remaining * ends;
      std::optional<double> result;
      constexpr int         n_samples = 16;
      for (int i = 1; i < n_samples; ++i)
        {
          const double t   = modes.mu(k) + modes.width(k) * i / n_samples;
          double       sum = 0.;
          for (std::size_t a = 0; a < x.size(); ++a)
            {
              double term = f[a];
              for (std::size_t b = 0; b < x.size(); ++b)
                if (a != b)
                  term *= t - x[b];
              sum += term;
            }
          if (sum > peak)
            {
              peak   = sum;
              result = t;
            }
        }
      return result;
    }

    /// The middle value of each group of values, which are within @p distance of the first value of the group.
    std::vector<double> one_of_each_cluster(std::vector<double> values, const double distance)
    {
      std::sort(values.begin(), values.end());
      std::vector<double> result;
      for (auto first = values.begin(); first != values.end();)
        {
          const auto last = std::find_if(first, values.end(), [&](const double x) { return x - *first > distance; });
          result.push_back(*(first + (last - first) / 2));
          first = last;
        }
      return result;
    }

    /**
     * Points at which an event may be hidden inside a step: Re λ of a decaying mode, or δ² of two separate modes, is about to reach zero
     * according to the polynomial through the surrounding points. Several approaches close to each other, for example of equal pins, share
     * one evaluation; if it is not sufficient, the next round adds another evaluation.
     */
    std::vector<double> approaches(const TrackedModes &modes, const int k)
    {
      std::vector<double> result;
      const auto          look = [&](const EventSearch &search) {
        if (const auto peak = peak_within(modes, search))
          result.push_back(*peak);
      };
      const int n = static_cast<int>(modes.branches.size());
      for (int p = 0; p < n; ++p)
        {
          if (modes.mode(p, k) < 0 || modes.mode(p, k + 1) < 0)
            continue;
          const Complex before = modes.lambda(p, k), after = modes.lambda(p, k + 1);
          if (modes.verdict(p, k) == Verdict::stable && modes.verdict(p, k + 1) == Verdict::stable)
            look({EventSearch::growth, k, p, -1, true});
          for (int q = 0; q < p; ++q)
            if (modes.mode(q, k) >= 0 && modes.mode(q, k + 1) >= 0 && !are_beyond(modes, k, p, q))
              {
                const Complex x = before - modes.lambda(q, k), y = after - modes.lambda(q, k + 1);
                const double  size = before.imag(), nearest = std::min(std::abs(x.imag()), std::abs(y.imag())),
                             farthest = std::max(std::abs(x.imag()), std::abs(y.imag()));
                const auto may_meet   = [](const Complex &d) { return std::abs(d.real()) < other_growth * std::abs(d.imag()); };
                if (x.imag() * y.imag() > 0. && farthest < nearby * size && nearest > indistinguishable * size && may_meet(x) &&
                    may_meet(y))
                  look({EventSearch::coalescence, k, p, q, true});
              }
        }
      return one_of_each_cluster(std::move(result), one_look * modes.width(k));
    }
  } // namespace

  std::vector<double> refinement_requests(const TrackedModes &modes, const std::vector<EventSearch> &searches, const PredictZero &predict)
  {
    const std::size_t left = std::max(0, modes.options.maximum_refinements - modes.n_refinements);
    if (left == 0)
      return {};
    std::vector<double> wanted;
    for (const EventSearch &search : searches)
      if (!located(modes, search) && !is_tangled(modes, search.interval, search.branch))
        {
          const auto predicted = predictions(modes, search, predict);
          wanted.insert(wanted.end(), predicted.begin(), predicted.end());
          if (predicted.empty())
            wanted.push_back(proposal(modes, search));
        }
    // Steps are examined in parallel, and their requests are collected in order
    std::vector<std::vector<double>> suspicions(std::max(0, modes.n_points() - 1));
    run_tasks(static_cast<int>(suspicions.size()), [&](const int k) {
      if (modes.width(k) <= modes.options.smallest_step)
        return;
      if (!modes.intervals[k].links->resolved)
        suspicions[k] = {0.5 * (modes.mu(k) + modes.mu(k + 1))};
      else
        for (const auto &found : {interactions(modes, k), approaches(modes, k)})
          suspicions[k].insert(suspicions[k].end(), found.begin(), found.end());
    });
    for (const std::vector<double> &values : suspicions)
      wanted.insert(wanted.end(), values.begin(), values.end());
    std::sort(wanted.begin(), wanted.end());

    // Merge nearly equal points requested by different searches
    std::vector<double> result;
    for (const double value : wanted)
      if (result.empty() || value - result.back() > 0.25 * modes.options.threshold_tolerance)
        result.push_back(value);

    // If fewer evaluations are left, distribute them over the range
    if (result.size() > left)
      {
        for (std::size_t i = 0; i < left; ++i)
          result[i] = result[i * result.size() / left];
        result.resize(left);
      }
    return result;
  }
} // namespace Squeal
