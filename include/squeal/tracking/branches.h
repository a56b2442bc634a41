// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/tracking/chart_point.h>

#include <algorithm>
#include <complex>
#include <functional>
#include <optional>
#include <vector>

namespace Squeal
{
  /// Modes at several friction coefficients at once, in that order; the same on every process.
  using EvaluateChart = std::function<std::vector<ChartPoint>(const std::vector<double> &friction_coefficients)>;

  /// How closely modes are followed.
  struct ChartOptions
  {
    double largest_circular_frequency = 0.;   ///< end of the band [rad/s]
    double threshold_tolerance        = 1e-6; ///< widest interval of μ left around a threshold or a crossing [-]
    double smallest_step              = 1e-5; ///< of μ, below which steps are not halved to tell modes apart [-]
    int    maximum_refinements        = 1000; ///< evaluations beyond those of the grid
  };

  /**
   * A mode followed over the friction coefficient. Two modes have no identity
   * beyond an exceptional point: by convention the branch that was lower in frequency
   * goes on as the growing mode, and the growing mode as the lower one
   * where the pair separates again.
   */
  struct Branch
  {
    std::vector<int> modes; ///< number of the mode at each point of the chart, -1 where it is not in the list

    /// The first point at which it is in the list.
    int begin() const
    {
      return static_cast<int>(std::find_if(modes.begin(), modes.end(), [](const int mode) { return mode >= 0; }) - modes.begin());
    }
  };

  /// What happens to a branch at a threshold.
  enum class ThresholdEvent
  {
    onset,          ///< it grows from there on
    restabilisation ///< it has ceased to grow
  };

  template <>
  inline constexpr EnumName<ThresholdEvent> enum_table<ThresholdEvent>[] = {{ThresholdEvent::onset, "onset"},
                                                                            {ThresholdEvent::restabilisation, "restabilisation"}};

  /// How a branch begins or ceases to grow.
  enum class ThresholdMechanism
  {
    coalescence, ///< λ_1 = λ_2 of two neutral modes, the growing and the decaying mode on the other side
    zero_growth  ///< Re λ = 0 of one mode
  };

  template <>
  inline constexpr EnumName<ThresholdMechanism> enum_table<ThresholdMechanism>[] = {{ThresholdMechanism::coalescence, "coalescence"},
                                                                                    {ThresholdMechanism::zero_growth, "zero growth"}};

  /// Where a branch begins or ceases to grow.
  struct Threshold
  {
    double               friction_coefficient = 0.;
    double               uncertainty          = 0.; ///< of the friction coefficient: of the search and of λ
    ThresholdEvent       event                = ThresholdEvent::onset;
    ThresholdMechanism   mechanism            = ThresholdMechanism::zero_growth;
    int                  branch               = -1; ///< the one that grows
    int                  partner              = -1; ///< the one that decays after a coalescence; -1: none
    std::complex<double> lambda;                    ///< there [rad/s]
  };

  /// An edge of the set of oscillating modes in the band.
  enum class BandEdge
  {
    end_of_band, ///< Im λ is the largest frequency
    real_axis    ///< λ meets its conjugate: the mode becomes overdamped, or divergent
  };

  template <>
  inline constexpr EnumName<BandEdge> enum_table<BandEdge>[] = {{BandEdge::end_of_band, "end of band"}, {BandEdge::real_axis, "real axis"}};

  /// Where a branch enters or leaves the band.
  struct BandCrossing
  {
    double   friction_coefficient = 0.;
    double   uncertainty          = 0.; ///< of the friction coefficient
    int      branch               = -1;
    bool     enters               = false;
    BandEdge edge                 = BandEdge::end_of_band;
  };

  /// Modes at a point and how many the crossings imply.
  struct ChartCount
  {
    double friction_coefficient = 0.;
    int    n_modes              = 0; ///< oscillating modes in the band
    int    n_expected           = 0; ///< those at the first point, and entered less left since
    int    n_overdamped         = 0; ///< pairs of real λ, zeros aside
  };

  /// Modes over the friction coefficient.
  struct StabilityChart
  {
    std::vector<ChartPoint>   points;               ///< ascending, those of refinement included
    std::vector<bool>         is_refinement;        ///< whether a point is none of the grid
    std::vector<Branch>       branches;             ///< in the order in which they begin; modes beyond the band, too
    std::vector<Threshold>    thresholds;           ///< ascending
    std::vector<BandCrossing> crossings;            ///< ascending
    std::vector<ChartCount>   counts;               ///< one for each point
    int                       n_doubtful_steps = 0; ///< in which modes could not be told apart but by closeness of λ
  };

  /**
   * Follows modes over the friction coefficients of @p grid, ascending, which may
   * be empty. Modes of neighbouring points are linked by link_modes(); steps
   * in which that is in doubt are halved, those of one round in one batch. Steps
   * in which two branches change places are examined, too, if the vectors say
   * that the branches interact: Λ_b, transformed to the modes at a, and Λ_a,
   * interpolated between, predict where the two would meet and how close; and
   * steps in which growth rates or frequencies, extrapolated, come close.
   *
   * A branch that grows at one end of a step but not at the other has a
   * threshold between. At a coalescence δ²(μ) = (λ_1 − λ_2)² is analytic, real and
   * has a simple zero, while λ has a branch point; elsewhere the zero of Re λ is
   * wanted. Zeros are enclosed closely on both sides of where @p predict expects them, else by inverse quadratic interpolation and
   * bisection, until the interval is no wider than the tolerance. Modes that are
   * neutral at the first point and grow from there on, such as
   * a double mode of the frictionless problem, have their onset at the first point;
   * where growth emerges from the rounding errors of a multiple mode only later,
   * the uncertainty reaches from there to the first point.
   *
   * Uncertainties: half the width of the interval if it is wider than the
   * tolerance, its width otherwise, and three times what the corrections of λ
   * imply. At a coalescence these are the change of δ² to
   *
   *   (λ_1 + D_11 − λ_2 − D_22)² + 4 D_12 D_21,
   *
   * divided by dδ²/dμ, at points some way from the coalescence, near to which D
   * is large and cancels; otherwise the change of Re λ or Im λ by their slopes,
   * |Re D_ii| + Σ |D_ij D_ji / (λ_i − λ_j)|, at most the uncertainty of λ.
   *
   * Throws Error if the grid is not ascending or an option not positive.
   */
  StabilityChart stability_chart(const std::vector<double> &grid,
                                 const EvaluateChart       &evaluate,
                                 const ChartOptions        &options,
                                 const PredictZero         &predict = {});

  /// The mode of the band that grows most, or is damped least; -1: none.
  int leading_mode(const ChartPoint &point, double largest_circular_frequency);

  /// The branch that a mode of another point resembles most at point k, of those that grow there if @p is_growing; -1: none.
  int similar_branch(const StabilityChart &chart, int k, const ChartPoint &point, int mode, bool is_growing);

  /// Where modes of the band begin to grow, or to grow faster than a level.
  struct GrowthOnset
  {
    double               friction_coefficient = 0.;
    double               uncertainty          = 0.; ///< of the friction coefficient: of the search and of λ
    int                  branch               = -1;
    std::complex<double> lambda; ///< there [rad/s]
  };

  /// Where a branch begins to grow by more than the uncertainty of λ in the band: the threshold or the band crossing with which that growth
  /// begins. Growth that is there at the first point began between @p before, the last friction coefficient known below the chart, and this
  /// point; the uncertainty is their distance.
  std::optional<GrowthOnset> onset_of(int branch, const StabilityChart &chart, double largest_circular_frequency, double before);

  /// The first onset of all branches.
  std::optional<GrowthOnset> first_onset(const StabilityChart &chart, double largest_circular_frequency, double before);

  /**
   * The smallest friction coefficient at which the largest divergence rate ξ of the band exceeds a level. Modes are evaluated
   * between two points of the chart until the interval is no wider than the tolerance; the uncertainty is its width and three times
   * the estimated error of ξ by dξ/dμ. See onset_of() for @p before.
   *
   * @param level    divergence rate [-]
   * @param evaluate the function with which the chart was made
   * @param options  likewise
   * @param branch   whose ξ is meant in place of the largest one; -1: none
   */
  std::optional<GrowthOnset> onset_beyond(double                level,
                                          const StabilityChart &chart,
                                          const EvaluateChart  &evaluate,
                                          const ChartOptions   &options,
                                          double                before,
                                          int                   branch = -1);
} // namespace Squeal
