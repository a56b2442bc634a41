#include <squeal/base/conventions.h>
#include <squeal/studies/sensitivity/sensitivity_tables.h>

#include <algorithm>
#include <complex>
#include <optional>
#include <ostream>

namespace Squeal
{
  namespace
  {
    /// Rows of the ranking on the screen.
    constexpr std::size_t n_shown_parameters = 12;

    /// Keeps nothing: a study of sensitivities begins anew when it is interrupted.
    class ForgetfulStore : public ChartStore
    {
    public:
      std::optional<ChartPoint> find(const OperatingPoint &) const override
      {
        return {};
      }
      void                     keep(const OperatingPoint &, const ChartPoint &) override {}
      std::vector<MultiVector> basis() const override
      {
        return {};
      }
      void keep(const MultiVector &) override {}
    };

    /// Friction coefficients of the sweep where thresholds are wanted, with that of the operation among them.
    SweepLine line_of(const Parameters &parameters)
    {
      SweepLine    line{SweepLine::Kind::main, parameters.operation, 0., {}};
      const double mu = parameters.operation.friction_coefficient;
      if (parameters.sensitivity.thresholds)
        line.friction_coefficients = parameters.sweep.friction_coefficients.linear();
      auto &grid = line.friction_coefficients;
      if (const auto place = std::lower_bound(grid.begin(), grid.end(), mu); place == grid.end() || *place != mu)
        grid.insert(place, mu);
      return line;
    }

    void report(const ModeSensitivity &mode, const std::vector<SensitivityParameter> &parameters, Run &run)
    {
      const ModalQuantities q = modal_quantities(mode.lambda);
      run.screen << '\n';
      run.progress.note(text("  one per cent of each parameter changes ", to_string(mode.label), " at ", decimal_text(q.frequency), " Hz, ",
                             mode.is_unstable ?
                               text("which grows with a divergence rate of ", decimal_text(100. * q.divergence_rate), " %") :
                               "the least damped mode, since none grows",
                             ", by"));
      run.screen << '\n';
      ranking_table(mode, parameters, false, n_shown_parameters).print(run.screen);
      run.screen << '\n';
    }

    void note_obstacles(const std::vector<ThresholdSensitivity> &thresholds, Run &run)
    {
      const auto n = std::count_if(thresholds.begin(), thresholds.end(),
                                   [](const ThresholdSensitivity &threshold) { return !threshold.obstacle.empty(); });
      if (n > 0)
        run.progress.note(
          text("  note: ", n, " of ", thresholds.size(), " thresholds have no derivatives, see sensitivities_thresholds.csv"));
    }

    /// Of the modal damping that the coupled system of a sweep has; nothing without it.
    std::optional<ModalDampingDerivatives> modal_damping_derivatives(const SweepModel &sweep, const DampingParameters &damping)
    {
      if (damping.modal_ratios.empty())
        return {};
      const FrictionlessModes &modes   = sweep.frictionless;
      const CoupledSystem     &coupled = modes.linearisation.coupled;
      return std::optional<ModalDampingDerivatives>(std::in_place, coupled, modes.inverse->frictionless(), modes.real, damping,
                                                    static_cast<int>(coupled.values.at(SystemParameter::modal_damping).size()));
    }
  } // namespace

  /**
   * `Study = sensitivity`: derivatives of λ and of the thresholds with respect to every continuous parameter, from right and left vectors.
   */
  static void run_sensitivity_study(Scene &scene, Run &run)
  {
    const Parameters                 &p          = run.parameters;
    const double                      mu         = p.operation.friction_coefficient;
    const BodyTerms                   bodies     = assemble_scene(scene, run);
    std::vector<SensitivityParameter> parameters = sensitivity_parameters(scene, p);
    for (SensitivityParameter &parameter : geometry_sensitivity_parameters(scene, bodies, run))
      parameters.push_back(std::move(parameter));

    const SweepPlan plan   = sweep_plan(scene, {line_of(p)}, run);
    const auto      closed = plan.closed_at(mu);
    const auto      regime =
      std::find_if(plan.regimes.begin(), plan.regimes.end(), [&](const ContactRegime &other) { return other.closed == closed; });
    if (plan.regimes.size() > 1)
      run.progress.note(text("  note: thresholds are those with the contact set at mu = ", exact_text(mu), "; there are ",
                             plan.regimes.size(), " over the range"));
    SweepModel     sweep(plan, *regime, run);
    ForgetfulStore store;
    evaluate_points(sweep, store);
    std::optional<SweepChart> chart;
    if (p.sensitivity.thresholds)
      {
        std::vector<double> grid;
        for (const int i : regime->on_line(0))
          if (sweep.known.count({0, regime->points[i].friction_coefficient}) > 0)
            grid.push_back(regime->points[i].friction_coefficient);
        chart = follow_branches(sweep, 0, grid, &store);
      }

    SensitivityModel                   model{sweep, bodies, parameters, modal_damping_derivatives(sweep, p.damping)};
    const std::vector<ModeSensitivity> modes = mode_sensitivities(model, run);
    report(modes.front(), parameters, run);
    run.store_table("sensitivities", mode_sensitivity_table(modes, parameters));
    run.store_table("sensitivity_ranking", ranking_table(modes.front(), parameters, true, 0));
    if (chart)
      {
        const std::vector<ThresholdSensitivity> thresholds = threshold_sensitivities(model, *chart, run);
        note_obstacles(thresholds, run);
        run.store_table("sensitivities_thresholds", threshold_sensitivity_table(thresholds, *chart, parameters));
      }
    run.finish();
  }

  extern const Study sensitivity_study = [] {
    const auto no_thresholds = [](const Parameters &p) { return unless(p.sensitivity.thresholds, "Sensitivity/Thresholds = false"); };
    Study      study{"sensitivity",
                run_sensitivity_study,
                {"Sensitivity/", "Sweep/First friction coefficient", "Sweep/Last friction coefficient",
                      "Sweep/Number of friction coefficients", "Sweep/Tolerance", "Sweep/Maximum basis", "Sweep/Threshold tolerance"}};
    study.rules = {{"Output/", [](const Parameters &) { return "the study writes no mode shapes"; }},
                   {"Complex modes/", [](const Parameters &) { return "the study solves reduced models"; }},
                   {"Sweep/First friction coefficient", no_thresholds},
                   {"Sweep/Last friction coefficient", no_thresholds},
                   {"Sweep/Number of friction coefficients", no_thresholds},
                   {"Sweep/Threshold tolerance", no_thresholds}};
    return study;
  }();
} // namespace Squeal
