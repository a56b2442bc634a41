// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/tracking/branches.h>
#include <squeal/tracking/mode_links.h>

#include <complex>
#include <optional>
#include <vector>

namespace Squeal
{
  struct ChartInterval
  {
    std::optional<ModeLinks> links;
    int                      stalls = 0; ///< number of successive steps of the search that reduced the interval by less than half
  };

  /// Modes of a multiple λ, with orthonormal bases for their right and left vectors.
  struct MultipleModes
  {
    std::vector<int>   modes;
    ComplexDenseMatrix right, left;
  };

  /// Modes as functions of the friction coefficient: evaluated points, and the mode of each branch at each point.
  struct TrackedModes
  {
    const ChartOptions                     &options;
    std::vector<ChartPoint>                 points;   ///< points in ascending order
    std::vector<std::vector<MultipleModes>> multiple; ///< multiple λ of each point
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

    /// Index of the mode of a branch at a point; -1: none.
    int mode(const int branch, const int k) const
    {
      return k < 0 || k >= n_points() ? -1 : branches[branch].modes[k];
    }

    std::complex<double> lambda(const int branch, const int k) const
    {
      return points[k].lambda[mode(branch, k)];
    }

    /// Intervals up to this width are not searched further.
    double tolerance(const int k) const
    {
      constexpr double rounding = 8. * std::numeric_limits<double>::epsilon();
      return std::max(options.threshold_tolerance, rounding * std::max(std::abs(mu(k)), std::abs(mu(k + 1))));
    }

    /// Verdict on a branch at a point from λ without its uncertainty; growth within rounding errors counts as neutral.
    Verdict verdict(const int branch, const int k) const
    {
      return verdict_of(lambda(branch, k));
    }
  };

  /// Joins the linked modes of all points to form branches.
  void follow_branches(TrackedModes &modes);

  /// Search for the sign change of a function of one or two branches in a step.
  struct EventSearch
  {
    enum Kind
    {
      growth,      ///< Re λ
      coalescence, ///< δ²
      end_of_band, ///< Im λ − ω_max
      real_axis    ///< ((λ − λ̄)/2)², continued by ((λ_1 − λ_2)/2)² of real λ
    };
    Kind kind;
    int  interval;
    int  branch, partner;
    bool upward;           ///< true for an onset, or for a mode that enters the band
    bool at_once  = false; ///< true for an onset in the first step, with neutral modes at the first point
    bool multiple = false; ///< true for two modes that are indistinguishable from the first point up to this interval
  };

  std::vector<EventSearch> find_events(const TrackedModes &modes);

  /// Value of the function of a search at point k; empty if its branches do not exist there.
  std::optional<double> search_value(const TrackedModes &modes, const EventSearch &search, int k);

  /// True if a branch that is neutral at the first point grows from there: the first step is too short to be divided, or Re λ / Δμ (δ² /
  /// Δμ² for a double mode), extrapolated linearly to the first point, is similar to its value at the next point.
  bool grows_at_once(const TrackedModes &modes, const EventSearch &search);

  /// Friction coefficients for further evaluations; @p predict may be empty.
  std::vector<double> refinement_requests(const TrackedModes &modes, const std::vector<EventSearch> &searches, const PredictZero &predict);

  /// The final chart with the results of the searches.
  StabilityChart finished_chart(TrackedModes modes, const std::vector<EventSearch> &searches);
} // namespace Squeal
