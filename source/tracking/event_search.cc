#include "tracked_modes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// |Re λ_1 + Re λ_2| and |Im λ_1 − Im λ_2| of ±R + iω by R.
    constexpr double mirror_tolerance = 1e-6;

    Complex square_difference(const Complex &x, const Complex &y)
    {
      return (x - y) * (x - y);
    }

    bool in_band(const TrackedModes &modes, const int branch, const int k)
    {
      return modes.mode(branch, k) >= 0 && modes.lambda(branch, k).imag() <= modes.options.largest_circular_frequency;
    }

    /// Whether two modes are one double mode at a point.
    bool is_double(const TrackedModes &modes, const EventSearch &search, const int k)
    {
      return modes.mode(search.branch, k) >= 0 && modes.mode(search.partner, k) >= 0 &&
             std::abs(modes.lambda(search.branch, k) - modes.lambda(search.partner, k)) <=
               indistinguishable * std::abs(modes.lambda(search.branch, k));
    }

    /// The branch with −R + iω where this one has R + iω, or -1.
    int mirror_branch(const TrackedModes &modes, const int branch, const int k)
    {
      const Complex here = modes.lambda(branch, k);
      int           best = -1;
      // Close to a coalescence, R is small and known to rounding errors of λ only
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

    /**
     * Moves the interval of a threshold to where the function itself changes
     * sign: the growth of a mode is seen only beyond what is negligible.
     */
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

    /// ((λ_1 − λ_2)/2)² of neighbouring real values that a mode, last seen nearby, has become.
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
        // A list that is cut may lose modes beyond the band
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
} // namespace Squeal
