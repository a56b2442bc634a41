// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/studies/steps/imported_modes.h>
#include <squeal/tracking/branches.h>
#include <squeal/tracking/error_controlled_sweep.h>

namespace Squeal
{
  /// Friction coefficients at one load and speed.
  struct SweepLine
  {
    enum class Kind
    {
      main,                ///< as the operation says
      without_dissipation, ///< the same without radial dissipation
      map                  ///< at another load or speed
    };

    Kind                kind;
    OperationParameters operation;             ///< but for the friction coefficient
    double              value;                 ///< of the second axis, on a line of the map
    std::vector<double> friction_coefficients; ///< or values of the varied parameter of a system file
    ParameterValues     values = {};           ///< of other parameters of the system

    OperationParameters at(double friction_coefficient) const;
  };

  /// Operating points with the same closed contact nodes: one coupled system, one basis.
  struct ContactRegime
  {
    std::size_t                 number; ///< from one on
    std::vector<unsigned int>   closed; ///< numbers of the closed pairs
    std::vector<OperatingPoint> points;

    /// Numbers of the points of a line.
    std::vector<int> on_line(int line) const;
  };

  /// The regime of a contact set, new if there is none.
  ContactRegime &regime_of(const std::vector<unsigned int> &closed, std::vector<ContactRegime> &regimes);

  /// What varies along a line of a sweep, or from line to line of a map.
  struct SweepAxis
  {
    std::string name, unit;
  };

  /// What a sweep asks for, with the states of contact there. The main line is the first.
  struct SweepPlan
  {
    const Scene                  *scene; ///< null: of a system file
    std::optional<SystemFile>     file;
    ParameterValues               values; ///< of the file's parameters, but for those that vary
    SweepAxis                     axis, second_axis;
    SlidingParameters             sliding_parameters;
    std::unique_ptr<SlidingModel> sliding; ///< serves all states; null: equal shares of the load
    std::vector<SweepLine>        lines;
    std::vector<ContactRegime>    regimes;

    /// The steady sliding state, or nothing if the load is shared equally. Throws SolverError if there is no such state.
    std::optional<SlidingState> sliding_state(const OperationParameters &operation) const;

    StateOfContact state_at(int line, double friction_coefficient) const;

    /// Numbers of the closed pairs on the main line.
    std::vector<unsigned int> closed_at(const double friction_coefficient) const
    {
      return state_at(0, friction_coefficient).closed;
    }

    /// A point of a line with its values, and the damping of those contact nodes that are closed in a regime.
    OperatingPoint point(int line, double friction_coefficient, const std::vector<unsigned int> &closed) const;
  };

  /// Finds the states of contact at all operating points that the parameters ask for, as steps of the run. @p scene must outlive the plan.
  SweepPlan sweep_plan(const Scene &scene, Run &run);

  /// Reads a system file: the parameters that vary in it, as a step of the run. Its main line has the other parameters at their values.
  SweepPlan sweep_plan_of_system(Run &run);

  /// The parameter of a system file that a sweep varies. Throws ParameterError unless the file has it with the range of the sweep.
  NamedRange swept_parameter(const SystemFile &file, const Run &run);

  /// The same for some lines of operating points.
  SweepPlan sweep_plan(const Scene &scene, const std::vector<SweepLine> &lines, Run &run);

  /// The coupled system of a contact set with its basis, and what is known of its modes. A system file without a definite part has no basis:
  /// every point is solved at full order, and ChartPoint has vectors of the scaled dofs instead of coordinates in a basis.
  struct SweepModel
  {
    /// Linearises where contact damps most: the basis starts from the responses to that damping. All arguments must outlive the model.
    SweepModel(const SweepPlan &plan, const ContactRegime &regime, Run &run);

    /// Starts a reduced model from the modes without friction and damping.
    SweepModel(const SweepPlan &plan, const ContactRegime &regime, Run &run, FrictionlessModes frictionless);

    /// Modes of a line, known ones or new ones. All processes must call.
    std::vector<ChartPoint> evaluate(int line, const std::vector<double> &friction_coefficients);

    /// Modes of a point at full order by direct_modes(); its residuals are backward errors. All processes must call.
    ChartPoint evaluate_directly(const OperatingPoint &point) const;

    /// Largest estimated |δλ| / |λ| of the modes of a point inside the band.
    double largest_error(const ChartPoint &point) const;

    /// Right vectors of some modes of a point at full order, real and imaginary parts.
    std::pair<MultiVector, MultiVector> shapes(const ChartPoint &point, const std::vector<int> &modes) const;

    /// Identities of some modes of a point, without the signs of doublets.
    std::vector<ModeLabel> labels(const ChartPoint &point, const std::vector<int> &modes) const;

    /// The linearised scene with the contact damping at a point of the main line.
    Linearisation linearisation_at(double friction_coefficient) const;

    bool is_in_band(const std::complex<double> &lambda) const
    {
      return lambda.imag() <= largest_circular_frequency;
    }

    /// Numbers of the modes of a point inside the band.
    std::vector<int> in_band(const ChartPoint &point) const;

    /// How many of them have a verdict.
    int n_of(const ChartPoint &point, Verdict verdict) const;

    /// Their identities: as in a run at one friction coefficient, the mode of a doublet that grows is plus.
    std::vector<ModeLabel> labels_in_band(const ChartPoint &point) const;

    const SweepPlan                             &plan;
    const ContactRegime                         &regime;
    Run                                         &run;
    const double                                 largest_circular_frequency; ///< end of the band [rad/s]
    FrictionlessModes                            frictionless;
    std::unique_ptr<ChartModel>                  reduced; ///< null without a definite part
    std::map<std::pair<int, double>, ChartPoint> known;   ///< by line and friction coefficient

  private:
    /// Begins the reduced model.
    void start();

    /// What names the modes of a point, from products with the basis.
    std::vector<ShapeShares> shape_shares(const ChartPoint &point, const std::vector<int> &modes) const;

    /// Labels without a basis: numbers of the most similar modes at the first point that is labelled.
    std::vector<ModeLabel> labels_by_number(const ChartPoint &point, const std::vector<int> &modes) const;

    mutable std::optional<ChartPoint> first_point;
    mutable std::vector<DenseMatrix>  reference_products; ///< with the basis as it was when modes were last named
  };

  /// Places among n friction coefficients at which a basis learns most: the ends, the middle and the quarters, the last one first.
  std::vector<int> ends_and_quarters(int n);

  /// The damping of the contact where a sweep's is largest.
  const OperatingPoint &most_damped(const ContactRegime &regime);

  /// Evaluates all points of the contact set to the tolerance that the parameters ask for, as a step of the run.
  void evaluate_points(SweepModel &model);

  /// `Output/Write system`: the system of a contact set, or its reduced model with the basis, in the folder `system` of the results.
  void write_system_of(const SweepModel &model);

  /// Modes over the friction coefficient at one load and speed, as far as the contact set is the same.
  struct SweepChart
  {
    StabilityChart         chart;
    std::vector<ModeLabel> labels; ///< one for each branch

    std::optional<GrowthOnset> onset;      ///< where the first mode begins to grow
    std::optional<GrowthOnset> weak_onset; ///< where the first divergence rate exceeds weak_divergence
  };

  /// Where squeal begins on a line, in one of its charts.
  struct SquealOnset
  {
    double      divergence_rate; ///< that is exceeded from there on [-]
    GrowthOnset onset;
    ModeLabel   label;
  };

  /// Follows the branches of a line over known friction coefficients, with their thresholds, for which the basis grows, as a step of the run.
  SweepChart follow_branches(SweepModel &model, int line, const std::vector<double> &friction_coefficients);

  /// Follows the branches on all lines but those of the map, with their thresholds, as steps of the run; appends to the @p charts of each line.
  void follow_branches(SweepModel &model, std::vector<std::vector<SweepChart>> &charts);

  /// Where the modes of a line begin to grow, and where their divergence rates exceed weak_divergence, over its known friction coefficients:
  /// once for each label and rate. The basis stays as it is. All processes must call.
  std::vector<SquealOnset> mode_onsets(SweepModel &model, int line);

  /// The first onsets of all stretches of a line: of growth and of divergence rates beyond weak_divergence, where there are such.
  std::vector<SquealOnset> squeal_onsets(const std::vector<SweepChart> &charts);

  /// From which friction coefficient on there is squeal, and what grows most: of the stretches of the main line, of @p n_asked values.
  std::string verdict(const std::vector<SweepChart> &charts,
                      std::size_t                    n_asked,
                      double                         largest_circular_frequency,
                      const std::string             &parameter);

  /// Contact sets along the lines: where they change.
  Table contact_table(const SweepPlan &plan, std::size_t n_pairs);

  /// Tables of the @p charts of each line of the plan: branches, counts, thresholds, band crossings.
  void write_charts(const SweepPlan &plan, const std::vector<std::vector<SweepChart>> &charts, double omega_max, Run &run);
} // namespace Squeal
