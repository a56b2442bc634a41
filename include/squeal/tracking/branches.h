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
  /// Evaluates the modes at several friction coefficients, in that order; the same on every process.
  using EvaluateChart = std::function<std::vector<ChartPoint>(const std::vector<double> &friction_coefficients)>;

  /// Accuracy of the tracking.
  struct ChartOptions
  {
    double largest_circular_frequency = 0.;   ///< end of the band [rad/s]
    double threshold_tolerance        = 1e-6; ///< largest interval of μ around a threshold or a crossing [-]
    double smallest_step              = 1e-5; ///< smallest step of μ; smaller steps are not halved to distinguish modes [-]
    int    maximum_refinements        = 1000; ///< evaluations in addition to the grid
  };

  /**
   * A mode followed over the friction coefficient. The identity of two modes is lost at an exceptional point: by convention the branch with
   * the lower frequency becomes the growing mode, and the growing mode becomes the lower one if the pair separates again.
   */
  struct Branch
  {
    std::vector<int> modes; ///< index of the mode at each point of the chart; -1: not in the list

    /// First point at which the mode is in the list.
    int begin() const
    {
      return static_cast<int>(std::find_if(modes.begin(), modes.end(), [](const int mode) { return mode >= 0; }) - modes.begin());
    }
  };

  /// Type of a threshold.
  enum class ThresholdEvent
  {
    onset,          ///< growth begins
    restabilisation ///< growth ends
  };

  template <>
  inline constexpr EnumName<ThresholdEvent> enum_table<ThresholdEvent>[] = {{ThresholdEvent::onset, "onset"},
                                                                            {ThresholdEvent::restabilisation, "restabilisation"}};

  /// Mechanism of a threshold.
  enum class ThresholdMechanism
  {
    coalescence, ///< λ_1 = λ_2 of two neutral modes; a growing and a decaying mode on the other side
    zero_growth  ///< Re λ = 0 of one mode
  };

  template <>
  inline constexpr EnumName<ThresholdMechanism> enum_table<ThresholdMechanism>[] = {{ThresholdMechanism::coalescence, "coalescence"},
                                                                                    {ThresholdMechanism::zero_growth, "zero growth"}};

  /// A threshold at which a branch begins or ceases to grow.
  struct Threshold
  {
    double               friction_coefficient = 0.;
    double               uncertainty          = 0.; ///< of the friction coefficient: due to the search and to λ
    ThresholdEvent       event                = ThresholdEvent::onset;
    ThresholdMechanism   mechanism            = ThresholdMechanism::zero_growth;
    int                  branch               = -1; ///< growing branch
    int                  partner              = -1; ///< decaying branch of a coalescence; -1: none
    std::complex<double> lambda;                    ///< at the threshold [rad/s]
  };

  /// Boundary of the set of oscillating modes in the band.
  enum class BandEdge
  {
    end_of_band, ///< Im λ is the upper end of the band
    real_axis    ///< λ meets its conjugate: the mode becomes overdamped or divergent
  };

  template <>
  inline constexpr EnumName<BandEdge> enum_table<BandEdge>[] = {{BandEdge::end_of_band, "end of band"}, {BandEdge::real_axis, "real axis"}};

  /// A crossing at which a branch enters or leaves the band.
  struct BandCrossing
  {
    double   friction_coefficient = 0.;
    double   uncertainty          = 0.; ///< of the friction coefficient
    int      branch               = -1;
    bool     enters               = false;
    BandEdge edge                 = BandEdge::end_of_band;
  };

  /// Number of modes at a point, and the number implied by the crossings.
  struct ChartCount
  {
    double friction_coefficient = 0.;
    int    n_modes              = 0; ///< oscillating modes in the band
    int    n_expected           = 0; ///< number at the first point, plus entries, minus exits
    int    n_overdamped         = 0; ///< pairs of nonzero real λ
  };

  /// Modes over the friction coefficient.
  struct StabilityChart
  {
    std::vector<ChartPoint>   points;               ///< ascending, including refinement
    std::vector<bool>         is_refinement;        ///< true for points that are not in the grid
    std::vector<Branch>       branches;             ///< in the order of their first points; includes modes beyond the band
    std::vector<Threshold>    thresholds;           ///< ascending
    std::vector<BandCrossing> crossings;            ///< ascending
    std::vector<ChartCount>   counts;               ///< one for each point
    int                       n_doubtful_steps = 0; ///< number of steps in which modes were distinguished only by closeness of λ
  };

  /**
   * Follows modes over the friction coefficients of @p grid, ascending, possibly empty. Modes of neighbouring points are linked by
   * link_modes(); doubtful steps are halved, all of one round in one batch. Steps in which two branches exchange their order are halved,
   * too, if the vectors show an interaction: Λ_b, transformed to the modes at a, and Λ_a, interpolated, predict where and how closely the
   * branches approach; and steps in which extrapolated growth rates or frequencies come close.
   *
   * A branch that grows at one end of a step but not at the other has a threshold in between. At a coalescence δ²(μ) = (λ_1 − λ_2)² is
   * analytic and real with a simple zero, while λ has a branch point; otherwise the zero of Re λ is computed. Zeros are enclosed tightly
   * around the prediction of @p predict, else by inverse quadratic interpolation and bisection, until the interval is smaller than the
   * tolerance. Modes that are neutral at the first point and grow from there, such as a double mode of the frictionless problem, have their
   * onset at the first point; if growth exceeds the rounding errors of a multiple mode only later, the uncertainty extends back to the
   * first point.
   *
   * Uncertainties: half the width of the interval if it exceeds the tolerance, its width otherwise, plus three times the effect of the
   * corrections of λ. At a coalescence this is the change of δ² to
   *
   *   (λ_1 + D_11 − λ_2 − D_22)² + 4 D_12 D_21,
   *
   * divided by dδ²/dμ, at points at some distance from the coalescence, close to which D is large and cancels; otherwise the change of Re λ
   * or Im λ divided by their slopes, |Re D_ii| + Σ |D_ij D_ji / (λ_i − λ_j)|, at most the uncertainty of λ.
   *
   * Throws Error if the grid is not ascending or an option is not positive.
   */
  StabilityChart stability_chart(const std::vector<double> &grid,
                                 const EvaluateChart       &evaluate,
                                 const ChartOptions        &options,
                                 const PredictZero         &predict = {});

  /// Fastest growing, or least damped, mode of the band; -1: none.
  int leading_mode(const ChartPoint &point, double largest_circular_frequency);

  /// Branch at point k that is most similar to a mode of another point, among growing branches if @p is_growing; -1: none.
  int similar_branch(const StabilityChart &chart, int k, const ChartPoint &point, int mode, bool is_growing);

  /// Onset of growth, or of growth above a level, of the modes in the band.
  struct GrowthOnset
  {
    double               friction_coefficient = 0.;
    double               uncertainty          = 0.; ///< of the friction coefficient: due to the search and to λ
    int                  branch               = -1;
    std::complex<double> lambda; ///< at the onset [rad/s]
  };

  /// Onset of growth beyond the uncertainty of λ for a branch in the band: the threshold or band crossing at which this growth begins. If
  /// the branch grows at the first point, the onset is between @p before, the last known friction coefficient below the chart, and this
  /// point; the uncertainty is their distance.
  std::optional<GrowthOnset> onset_of(int branch, const StabilityChart &chart, double largest_circular_frequency, double before);

  /// The first onset of all branches.
  std::optional<GrowthOnset> first_onset(const StabilityChart &chart, double largest_circular_frequency, double before);

  /**
   * Smallest friction coefficient at which the largest divergence rate ξ of the band exceeds a level. Modes are evaluated between two
   * points of the chart until the interval is within the tolerance; the uncertainty is its width plus three times the estimated error of ξ
   * divided by dξ/dμ. See onset_of() for @p before.
   *
   * @param level    divergence rate [-]
   * @param evaluate as for the chart
   * @param options  as for the chart
   * @param branch   use ξ of this branch instead of the largest one; -1: none
   */
  std::optional<GrowthOnset> onset_beyond(double                level,
                                          const StabilityChart &chart,
                                          const EvaluateChart  &evaluate,
                                          const ChartOptions   &options,
                                          double                before,
                                          int                   branch = -1);
} // namespace Squeal
