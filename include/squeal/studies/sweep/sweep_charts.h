// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/studies/steps/imported_modes.h>
#include <squeal/tracking/branches.h>
#include <squeal/tracking/error_controlled_sweep.h>

namespace Squeal
{
  /// A sequence of friction coefficients at one load and speed.
  struct SweepLine
  {
    enum class Kind
    {
      main,                ///< operation in the parameter file
      without_dissipation, ///< operation in the parameter file, without radial dissipation
      map                  ///< another load, speed or second parameter
    };

    Kind                kind;
    OperationParameters operation;             ///< operation; its friction coefficient is not used
    double              value;                 ///< load, speed or second parameter of a line of the map
    std::vector<double> friction_coefficients; ///< friction coefficients, or values of the varied parameter of a system file
    ParameterValues     values = {};           ///< values of other parameters of the system

    OperationParameters at(double friction_coefficient) const;
  };

  /// Operating points with the same closed contact nodes, which share one coupled system and one basis.
  struct ContactRegime
  {
    std::size_t                 number; ///< counted from one
    std::vector<unsigned int>   closed; ///< indices of the closed pairs
    std::vector<OperatingPoint> points;

    /// Indices of the points of a line.
    std::vector<int> on_line(int line) const;
  };

  /// Regime of a contact set; added if it does not exist.
  ContactRegime &regime_of(const std::vector<unsigned int> &closed, std::vector<ContactRegime> &regimes);

  /// Quantity that varies along a line of a sweep, or between the lines of a map.
  struct SweepAxis
  {
    std::string name, unit;
  };

  /// Lines of a sweep with their contact states. The main line is the first.
  struct SweepPlan
  {
    const Scene                  *scene; ///< null for a system file
    std::optional<SystemFile>     file;
    ParameterValues               values; ///< fixed parameters of the system file
    SweepAxis                     axis, second_axis;
    SlidingParameters             sliding_parameters;
    std::unique_ptr<SlidingModel> sliding; ///< data for all steady sliding states; null without steady sliding
    std::vector<SweepLine>        lines;
    std::vector<ContactRegime>    regimes;

    /// Steady sliding state; empty if Steady sliding/Contact state = equal load. Throws SolverError if no such state exists.
    std::optional<SlidingState> sliding_state(const OperationParameters &operation) const;

    StateOfContact state_at(int line, double friction_coefficient) const;

    /// Indices of the closed pairs on the main line.
    std::vector<unsigned int> closed_at(const double friction_coefficient) const
    {
      return state_at(0, friction_coefficient).closed;
    }

    /// A point of a line with its parameter values, and the damping of the contact nodes in @p closed.
    OperatingPoint point(int line, double friction_coefficient, const std::vector<unsigned int> &closed) const;
  };

  /// Computes the contact states at all requested operating points, as steps of the run. @p scene must outlive the plan.
  SweepPlan sweep_plan(const Scene &scene, Run &run);

  /// Reads a system file and the ranges of its varied parameters, as a step of the run. Other parameters have their given values.
  SweepPlan sweep_plan_of_system(Run &run);

  /// Swept parameter of a system file. Throws ParameterError unless the file contains it and its range includes the range of the sweep.
  NamedRange swept_parameter(const SystemFile &file, const Run &run);

  /// sweep_plan() for given lines of operating points.
  SweepPlan sweep_plan(const Scene &scene, const std::vector<SweepLine> &lines, Run &run);

  /// Coupled system of a contact set, with its basis and evaluated points. A system file without a definite part has no basis: every point
  /// is solved at full order, and ChartPoint contains vectors of the scaled dofs instead of basis coordinates.
  struct SweepModel
  {
    /// Line and friction coefficient of a point.
    using Place = std::pair<int, double>;

    /// A meshed model is linearised at the point with the largest contact damping, because the basis starts from the responses to this
    /// damping. All arguments must outlive the object.
    SweepModel(const SweepPlan &plan, const ContactRegime &regime, Run &run);

    /// Creates a reduced model from the undamped modes without friction.
    SweepModel(const SweepPlan &plan, const ContactRegime &regime, Run &run, FrictionlessModes frictionless);

    /// Replaces the reduced model and removes the evaluated points.
    void restart(std::unique_ptr<ChartModel> model);

    /// Modes on a line; only new points are computed. Collective.
    std::vector<ChartPoint> evaluate(int line, const std::vector<double> &friction_coefficients);

    /// Modes of a point at full order by direct_modes(); its residuals are backward errors. Collective.
    ChartPoint evaluate_directly(const OperatingPoint &point) const;

    /// Largest estimated |δλ| / |λ| of the modes of a point in the band.
    double largest_error(const ChartPoint &point) const;

    /// Full-order right vectors of some modes of a point, real and imaginary parts.
    std::pair<MultiVector, MultiVector> shapes(const ChartPoint &point, const std::vector<int> &modes) const;

    /// Labels of some modes of a point, without the signs of doublets.
    std::vector<ModeLabel> labels(const ChartPoint &point, const std::vector<int> &modes) const;

    /// Linearised model with the contact damping at a point of the main line.
    Linearisation linearisation_at(double friction_coefficient) const;

    bool is_in_band(const std::complex<double> &lambda) const
    {
      return lambda.imag() <= largest_circular_frequency;
    }

    /// Indices of the modes of a point in the band.
    std::vector<int> in_band(const ChartPoint &point) const;

    /// Number of modes in the band with the given verdict.
    int n_of(const ChartPoint &point, Verdict verdict) const;

    /// Labels of the modes in the band, as in a run at one friction coefficient: the growing mode of a doublet is labelled +.
    std::vector<ModeLabel> labels_in_band(const ChartPoint &point) const;

    const SweepPlan            &plan;
    const ContactRegime        &regime;
    Run                        &run;
    const double                largest_circular_frequency; ///< end of the band [rad/s]
    FrictionlessModes           frictionless;
    bool                        sharpens_thresholds = true; ///< whether follow_branches() enriches the basis for thresholds
    std::unique_ptr<ChartModel> reduced;                    ///< null without a definite part
    std::map<Place, ChartPoint> known;

  private:
    void start();

    /// Shares of component modes in the modes of a point, for labels.
    std::vector<ShapeShares> shape_shares(const ChartPoint &point, const std::vector<int> &modes) const;

    /// Labels without a basis: indices of the most similar modes at the first labelled point.
    std::vector<ModeLabel> labels_by_number(const ChartPoint &point, const std::vector<int> &modes) const;

    mutable std::optional<ChartPoint> first_point;
    mutable std::vector<DenseMatrix>  reference_products; ///< products of the component modes with the basis vectors used so far
  };

  /// Indices among n friction coefficients for training a basis: the last, the middle, the quarters and the first.
  std::vector<int> ends_and_quarters(int n);

  const OperatingPoint &most_damped(const ContactRegime &regime);

  /// Evaluates the points of the contact set, as a step of the run. With a basis, points whose estimated errors exceed Sweep/Tolerance are
  /// omitted.
  void evaluate_points(SweepModel &model);

  /// Evaluates all known points again with the current basis, which is no longer extended for thresholds. Collective.
  void evaluate_again(SweepModel &model);

  /**
   * Reduced model for a sweep that was solved at full order: a Galerkin projection onto principal axes of the right and left modes at some
   * of its points. The point with the largest error is added, or fewer axes are truncated, until the errors at all points are within the
   * tolerance of the sweep and the reduced model has no spurious modes in the band.
   *
   * @param errors receives the largest |λ̂ − λ| / |λ| of the band for every known point
   *
   * Throws SolverError if the sweep has no modes, or if the errors exceed the tolerance with every truncation.
   */
  ReducedModel snapshot_model(SweepModel &model, std::map<SweepModel::Place, double> &errors);

  /// `Output/Write system`: writes the system of a contact set, or its reduced model with the basis, to the folder `system` of the results,
  /// or `system_N` for the N-th of several contact sets.
  void write_system_of(SweepModel &model);

  /// Modes as functions of the friction coefficient at one load and speed, for one contact set.
  struct SweepChart
  {
    StabilityChart         chart;
    std::vector<ModeLabel> labels; ///< label of each branch

    std::optional<GrowthOnset> onset;      ///< smallest friction coefficient at which a mode grows
    std::optional<GrowthOnset> weak_onset; ///< smallest friction coefficient at which a divergence rate exceeds weak_divergence
  };

  /// Onset of squeal on a line.
  struct SquealOnset
  {
    double      divergence_rate; ///< divergence rate that is exceeded above the onset [-]
    GrowthOnset onset;
    ModeLabel   label;
  };

  /// Follows the branches of a line over its evaluated friction coefficients and finds their thresholds, as a step of the run. A reduced
  /// model first extends its basis at the thresholds, if sharpens_thresholds is set.
  SweepChart follow_branches(SweepModel &model, int line, const std::vector<double> &friction_coefficients);

  /// Follows the branches on all lines except those of the map and finds their thresholds, as steps of the run; appends to the @p charts of
  /// each line.
  void follow_branches(SweepModel &model, std::vector<std::vector<SweepChart>> &charts);

  /// Onsets of growth and of divergence rates above weak_divergence on a line, over its known friction coefficients; one onset for each
  /// label and rate. Does not extend the basis. Collective.
  std::vector<SquealOnset> mode_onsets(SweepModel &model, int line);

  /// First onsets of growth and of divergence rates above weak_divergence over all charts of a line.
  std::vector<SquealOnset> squeal_onsets(const std::vector<SweepChart> &charts);

  /// Verdict of the main line: smallest friction coefficient with squeal, and the mode with the largest divergence rate; @p n_asked: number
  /// of requested friction coefficients.
  std::string verdict(const std::vector<SweepChart> &charts,
                      std::size_t                    n_asked,
                      double                         largest_circular_frequency,
                      const std::string             &parameter);

  Table contact_table(const SweepPlan &plan, std::size_t n_pairs);

  /// Writes tables of the @p charts of each line: branches, counts, thresholds, band crossings.
  void write_charts(const SweepPlan &plan, const std::vector<std::vector<SweepChart>> &charts, double omega_max, Run &run);
} // namespace Squeal
