// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/tracking/branches.h>
#include <squeal/tracking/mode_links.h>

#include <complex>
#include <optional>
#include <vector>

namespace Squeal
{
  /// A step between neighbouring points.
  struct ChartInterval
  {
    std::optional<ModeLinks> links;
    int                      stalls = 0; ///< how often in a row it shrank by less than half
  };

  /// Modes of a multiple λ, with orthonormal bases of the spans of their right and left vectors.
  struct MultipleModes
  {
    std::vector<int>   modes;
    ComplexDenseMatrix right, left;
  };

  /// Modes over the friction coefficient: the points evaluated so far, and the mode of each branch at each of them.
  struct TrackedModes
  {
    const ChartOptions                     &options;
    std::vector<ChartPoint>                 points;   ///< ascending
    std::vector<std::vector<MultipleModes>> multiple; ///< of each point
    std::vector<bool>                       is_refinement;
    std::vector<ChartInterval>              intervals;
    std::vector<Branch>                     branches;
    std::vector<std::vector<int>>           branch_of; ///< branch of each mode of each point
    int                                     n_refinements = 0;

    int n_points() const
    {
      return static_cast<int>(points.size());
    }

    double mu(const int k) const
    {
      return points[k].friction_coefficient;
    }

    double width(const int k) const
    {
      return mu(k + 1) - mu(k);
    }

    /// Number of the mode of a branch, -1 beyond the chart.
    int mode(const int branch, const int k) const
    {
      return k < 0 || k >= n_points() ? -1 : branches[branch].modes[k];
    }

    std::complex<double> lambda(const int branch, const int k) const
    {
      return points[k].lambda[mode(branch, k)];
    }

    /// Intervals of this width are not searched further.
    double tolerance(const int k) const
    {
      constexpr double rounding = 8. * std::numeric_limits<double>::epsilon();
      return std::max(options.threshold_tolerance, rounding * std::max(std::abs(mu(k)), std::abs(mu(k + 1))));
    }

    /// Of a branch at a point, from its λ alone: what rounding leaves open counts as neutral.
    Verdict verdict(const int branch, const int k) const
    {
      return verdict_of(lambda(branch, k));
    }
  };

  /// Divides the modes of all points into branches, by the links of neighbouring points.
  void follow_branches(TrackedModes &modes);

  /// A sign to be located in a step, of a function of the branches.
  struct EventSearch
  {
    enum Kind
    {
      growth,      ///< Re λ
      coalescence, ///< δ²
      end_of_band, ///< Im λ − ω_max
      real_axis    ///< ((λ − λ̄)/2)², of real λ afterwards
    };
    Kind kind;
    int  interval;
    int  branch, partner;
    bool upward;           ///< onset, or entering the band
    bool at_once  = false; ///< neutral at the first point of the chart
    bool multiple = false; ///< two modes that nothing tells apart from the first point up to this interval
  };

  /// Steps in which a branch begins or ceases to grow, or enters or leaves the band.
  std::vector<EventSearch> find_events(const TrackedModes &modes);

  /// The function whose zero is searched, where the branches exist.
  std::optional<double> search_value(const TrackedModes &modes, const EventSearch &search, int k);

  /// Whether a branch that is neutral at the first point grows from there on: Re λ ~ μ, or δ² ~ μ² of a double mode, with a factor that
  /// linear extrapolation leaves positive.
  bool grows_at_once(const TrackedModes &modes, const EventSearch &search);

  /// Friction coefficients that would tell more; @p predict may be empty.
  std::vector<double> refinement_requests(const TrackedModes &modes, const std::vector<EventSearch> &searches, const PredictZero &predict);

  /// The chart, with what the searches have found.
  StabilityChart finished_chart(TrackedModes modes, const std::vector<EventSearch> &searches);
} // namespace Squeal
