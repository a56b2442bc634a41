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
  /// Function that evaluates the modes at several friction coefficients, in the given order; the results are identical on every process.
  using EvaluateChart = std::function<std::vector<ChartPoint>(const std::vector<double> &friction_coefficients)>;

  /// Accuracy of the tracking.
  struct ChartOptions
  {
    double largest_circular_frequency = 0.;   ///< end of the band [rad/s]
    double threshold_tolerance        = 1e-6; ///< largest interval of the varied parameter around a threshold or a crossing
    double smallest_step              = 1e-5; ///< steps of the varied parameter up to this length are not divided to distinguish modes
    int    maximum_refinements        = 1000; ///< maximum number of refinement points in addition to the grid
  };

  /**
   * A mode tracked as the friction coefficient varies. The identity of two modes is lost at an exceptional point: by convention, the branch
   * with the lower frequency becomes the growing mode, and the growing mode has the lower frequency if the pair separates again.
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

  enum class ThresholdEvent
  {
    onset,          ///< growth begins
    restabilisation ///< growth ends
  };

  template <>
  inline constexpr EnumName<ThresholdEvent> enum_table<ThresholdEvent>[] = {{ThresholdEvent::onset, "onset"},
                                                                            {ThresholdEvent::restabilisation, "restabilisation"}};

  enum class ThresholdMechanism
  {
    coalescence, ///< λ_1 = λ_2 of two neutral modes, which become a growing and a decaying mode
    zero_growth  ///< Re λ = 0 of one mode
  };

  template <>
  inline constexpr EnumName<ThresholdMechanism> enum_table<ThresholdMechanism>[] = {{ThresholdMechanism::coalescence, "coalescence"},
                                                                                    {ThresholdMechanism::zero_growth, "zero growth"}};

  /// A threshold at which a branch begins or ceases to grow.
  struct Threshold
  {
    double               friction_coefficient = 0.;
    double               uncertainty          = 0.; ///< uncertainty of μ due to the search and the errors of λ
    ThresholdEvent       event                = ThresholdEvent::onset;
    ThresholdMechanism   mechanism            = ThresholdMechanism::zero_growth;
    int                  branch               = -1; ///< growing branch
    int                  partner              = -1; ///< decaying branch of a coalescence; -1: none
    std::complex<double> lambda;                    ///< λ at the threshold [rad/s]
  };

  /// Boundary at which an oscillating mode enters or leaves the band.
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
    double   uncertainty          = 0.; ///< uncertainty of μ
    int      branch               = -1;
    bool     enters               = false;
    BandEdge edge                 = BandEdge::end_of_band;
  };

  /// Number of modes at a point, and the number expected from the crossings.
  struct ChartCount
  {
    double friction_coefficient = 0.;
    int    n_modes              = 0; ///< number of oscillating modes in the band
    int    n_expected           = 0; ///< number of modes at the first point, plus entries, minus exits
    int    n_overdamped         = 0; ///< number of pairs of nonzero real λ
  };

  /// Stability chart: modes as functions of the friction coefficient, with thresholds and band crossings.
  struct StabilityChart
  {
    std::vector<ChartPoint>   points;               ///< evaluated points in ascending order, including refinement
    std::vector<bool>         is_refinement;        ///< true for points that are not in the grid
    std::vector<Branch>       branches;             ///< branches in the order of their first points, including modes beyond the band
    std::vector<Threshold>    thresholds;           ///< ascending
    std::vector<BandCrossing> crossings;            ///< ascending
    std::vector<ChartCount>   counts;               ///< numbers of modes at each point
    int                       n_doubtful_steps = 0; ///< number of steps in which the links between modes of the band are ambiguous
  };

  /**
   * Tracks modes through the friction coefficients of @p grid, in ascending order; the grid may be empty. Modes of neighbouring points are
   * linked by link_modes(); steps with ambiguous links are halved, and all points of a round are evaluated together. A step is also divided
   * if two branches exchange their order and the interpolation between Λ_a and Λ_b, transformed to the modes at a, predicts an interaction,
   * or if interpolated growth rates approach zero, or if interpolated frequencies approach each other.
   *
   * A branch that grows at only one end of a step has a threshold in the step. At a coalescence δ²(μ) = (λ_1 − λ_2)² is analytic and real
   * with a simple zero, while λ has a branch point; otherwise the zero of Re λ is computed. The interval of a zero is reduced to the
   * tolerance, either to two points close to the prediction of @p predict, or by interpolation and bisection. If modes are neutral at the
   * first point and grow from there, for example a double mode of the frictionless problem, their onset is at the first point. If the
   * growth of a multiple mode exceeds rounding errors only at a later point, the uncertainty extends back to the first point.
   *
   * The uncertainty is the width of the interval (half the width if it exceeds the tolerance) plus three times the effect of the
   * corrections of λ. At a coalescence, this effect is the change of δ² to
   *
   *   (λ_1 + D_11 − λ_2 − D_22)² + 4 D_12 D_21,
   *
   * divided by dδ²/dμ. It is evaluated at some distance from the coalescence, close to which the entries of D are large and cancel.
   * Otherwise the effect is the change of Re λ or Im λ divided by its slope. The change of Re λ is |Re D_ii| + Σ |D_ij D_ji / (λ_i − λ_j)|,
   * similarly for Im λ, but at most the uncertainty of λ, which is used at the real axis.
   *
   * Throws Error if the grid is not ascending or a real-valued option is not positive.
   */
  StabilityChart stability_chart(const std::vector<double> &grid,
                                 const EvaluateChart       &evaluate,
                                 const ChartOptions        &options,
                                 const PredictZero         &predict = {});

  /// Mode of the band with the largest divergence rate; -1: none.
  int leading_mode(const ChartPoint &point, double largest_circular_frequency);

  /// Branch at point k that is most similar to a mode of another point; -1: none. Considers only growing branches if @p is_growing is set.
  int similar_branch(const StabilityChart &chart, int k, const ChartPoint &point, int mode, bool is_growing);

  /// Onset of growth, or of growth above a level, of the modes in the band.
  struct GrowthOnset
  {
    double               friction_coefficient = 0.;
    double               uncertainty          = 0.; ///< uncertainty of μ due to the search and the errors of λ
    int                  branch               = -1;
    std::complex<double> lambda; ///< λ at the onset [rad/s]
  };

  /// Onset of growth beyond the uncertainty of λ for a branch in the band: the threshold or band crossing at which this growth begins.
  /// Without a threshold or crossing, the result is the first point of the branch, with its distance from the previous point as
  /// uncertainty. Empty if the branch does not grow. @p before is the last friction coefficient evaluated below the chart.
  std::optional<GrowthOnset> onset_of(int branch, const StabilityChart &chart, double largest_circular_frequency, double before);

  /// The onset with the smallest friction coefficient among all branches.
  std::optional<GrowthOnset> first_onset(const StabilityChart &chart, double largest_circular_frequency, double before);

  /**
   * Smallest friction coefficient at which the largest divergence rate ξ of the band exceeds a level. Modes are evaluated between two
   * points of the chart until the interval meets the tolerance; the uncertainty is the width of the interval plus three times the estimated
   * error of ξ divided by dξ/dμ. Empty if ξ does not exceed the level. See onset_of() for @p before.
   *
   * @param level    divergence rate [-]
   * @param evaluate see stability_chart()
   * @param options  see stability_chart()
   * @param branch   use ξ of this branch instead of the largest ξ; -1: use the largest ξ
   */
  std::optional<GrowthOnset> onset_beyond(double                level,
                                          const StabilityChart &chart,
                                          const EvaluateChart  &evaluate,
                                          const ChartOptions   &options,
                                          double                before,
                                          int                   branch = -1);
} // namespace Squeal
