// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/studies/sensitivity/sensitivity_results.h>

#include <ostream>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    constexpr double one_percent = 0.01;

    /// Change in a mode per 1 % and per unit of a parameter.
    struct SensitivityRow
    {
      int                         mode; ///< index of the mode, from 0
      const ModeSensitivity      *of;
      const SensitivityParameter *parameter;
      Complex                     derivative; ///< dλ/dp
      std::optional<Complex>      change;     ///< change in the derivative due to the last extension of the basis

      double growth_per_percent() const
      {
        return one_percent * parameter->value * derivative.real();
      }

      /// Change in the divergence rate: 100 dξ, with ξ = R/ω.
      double divergence_per_percent() const
      {
        const Complex &lambda = of->lambda;
        return 100. * one_percent * parameter->value * (derivative.real() - lambda.real() / lambda.imag() * derivative.imag()) /
               lambda.imag();
      }

      double frequency_per_percent() const
      {
        return hertz(one_percent * parameter->value * derivative.imag());
      }
    };

    std::vector<SensitivityRow> rows_of(const ModeSensitivity &mode, const int number, const std::vector<SensitivityParameter> &parameters)
    {
      std::vector<SensitivityRow> rows;
      for (std::size_t p = 0; p < parameters.size(); ++p)
        rows.push_back(
          {number, &mode, &parameters[p], mode.derivatives[p], mode.changes.empty() ? std::nullopt : std::make_optional(mode.changes[p])});
      return rows;
    }

    Table mode_sensitivity_table(const std::vector<ModeSensitivity> &modes, const std::vector<SensitivityParameter> &parameters)
    {
      using Row = SensitivityRow;
      std::vector<Row> rows;
      for (std::size_t m = 0; m < modes.size(); ++m)
        for (const Row &row : rows_of(modes[m], static_cast<int>(m), parameters))
          rows.push_back(row);
      // Empty for a parameter that is zero, which has no relative change
      const auto percent = [](double (Row::*value)() const) {
        return [value](const Row &row) { return row.parameter->value != 0. ? Entry((row.*value)()) : Entry(); };
      };
      return Table(
        Columns<Row>{{"mode", "-", [](const Row &row) { return row.mode + 1; }},
                     {"label", "", [](const Row &row) { return row.of->label; }},
                     {"frequency", "Hz", [](const Row &row) { return modal_quantities(row.of->lambda).frequency; }},
                     {"growth rate", "1/s", [](const Row &row) { return row.of->lambda.real(); }},
                     {"divergence rate", "%", [](const Row &row) { return 100. * modal_quantities(row.of->lambda).divergence_rate; }},
                     {"parameter", "", [](const Row &row) { return row.parameter->path; }},
                     {"body", "", [](const Row &row) { return row.parameter->body; }},
                     {"value", "", [](const Row &row) { return row.parameter->value; }},
                     {"unit", "", [](const Row &row) { return row.parameter->unit; }},
                     {"growth rate per 1 %", "1/s", percent(&Row::growth_per_percent)},
                     {"divergence rate per 1 %", "percentage points", percent(&Row::divergence_per_percent)},
                     {"frequency per 1 %", "Hz", percent(&Row::frequency_per_percent)},
                     {"growth rate per unit", "1/s", [](const Row &row) { return row.derivative.real(); }},
                     {"frequency per unit", "Hz", [](const Row &row) { return hertz(row.derivative.imag()); }},
                     {"estimated error of the growth rate per unit", "1/s",
                      [](const Row &row) { return row.change ? Entry(std::abs(row.change->real())) : Entry(); }},
                     {"estimated error of the frequency per unit", "Hz",
                      [](const Row &row) { return row.change ? Entry(hertz(std::abs(row.change->imag()))) : Entry(); }},
                     {"derivative of", "", [](const Row &row) { return row.of->kind; }}},
        rows);
    }

    /// One row for each threshold and parameter; a single row for a threshold without derivatives.
    Table threshold_sensitivity_table(const std::vector<ThresholdSensitivity> &thresholds,
                                      const SweepChart                        &chart,
                                      const std::vector<SensitivityParameter> &parameters)
    {
      struct Row
      {
        const ThresholdSensitivity *of;
        const SensitivityParameter &parameter;
        std::size_t                 number; ///< index of the parameter

        bool has_value() const
        {
          return of->obstacle.empty();
        }
      };
      std::vector<Row> rows;
      for (const ThresholdSensitivity &threshold : thresholds)
        for (std::size_t p = 0; p < (threshold.obstacle.empty() ? parameters.size() : 1); ++p)
          // Omit the friction coefficient, which is the threshold itself
          if (parameters[p].operation != &OperationParameters::friction_coefficient)
            rows.push_back({&threshold, parameters[p], p});
      const auto of_threshold = [](const auto &value) { return [value](const Row &row) { return Entry(value(*row.of->threshold)); }; };
      const auto known        = [](const auto &value) {
        return [value](const Row &row) { return row.has_value() ? Entry(value(row)) : Entry(); };
      };
      const auto percent = [](const auto &value) {
        return [value](const Row &row) { return row.has_value() && row.parameter.value != 0. ? Entry(value(row)) : Entry(); };
      };
      const auto label = [&](const int branch) { return branch >= 0 ? Entry(chart.labels[branch]) : Entry(); };
      return Table(Columns<Row>{{"mu", "-", of_threshold([](const Threshold &t) { return t.friction_coefficient; })},
                                {"event", "", of_threshold([](const Threshold &t) { return t.event; })},
                                {"label", "", of_threshold([=](const Threshold &t) { return label(t.branch); })},
                                {"partner label", "", of_threshold([=](const Threshold &t) { return label(t.partner); })},
                                {"frequency", "Hz", of_threshold([](const Threshold &t) { return modal_quantities(t.lambda).frequency; })},
                                {"parameter", "", known([](const Row &row) { return row.parameter.path; })},
                                {"body", "", known([](const Row &row) { return row.parameter.body; })},
                                {"value", "", known([](const Row &row) { return row.parameter.value; })},
                                {"unit", "", known([](const Row &row) { return row.parameter.unit; })},
                                {"mu per 1 %", "-", percent([](const Row &row) {
                                   return one_percent * row.parameter.value * row.of->derivatives[row.number];
                                 })},
                                {"mu per unit", "-", known([](const Row &row) { return row.of->derivatives[row.number]; })},
                                {"estimated error per unit", "-", known([](const Row &row) { return row.of->errors[row.number]; })},
                                {"derivative of", "",
                                 [](const Row &row) {
                                   return !row.has_value() ? "none" :
                                          row.of->threshold->mechanism == ThresholdMechanism::zero_growth ?
                                                             "growth rate" :
                                                             "squared difference of the pair";
                                 }},
                                {"remark", "", [](const Row &row) { return row.of->obstacle; }}},
                   rows);
    }

    /// Parameters sorted by the effect of 1 % on the divergence rate of a mode, at most @p most rows; 0: all rows.
    Table ranking_table(const ModeSensitivity                   &mode,
                        const std::vector<SensitivityParameter> &parameters,
                        const bool                               with_single_pins,
                        const std::size_t                        most)
    {
      using Row             = SensitivityRow;
      std::vector<Row> rows = rows_of(mode, 0, parameters);
      rows.erase(
        std::remove_if(rows.begin(), rows.end(),
                       [&](const Row &row) { return row.parameter->value == 0. || (!with_single_pins && !row.parameter->body.empty()); }),
        rows.end());
      std::stable_sort(rows.begin(), rows.end(), [](const Row &a, const Row &b) {
        return std::abs(a.divergence_per_percent()) > std::abs(b.divergence_per_percent());
      });
      if (most > 0 && rows.size() > most)
        rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(most), rows.end());
      Columns<Row> columns = {{"parameter", "", [](const Row &row) { return row.parameter->path; }}};
      if (with_single_pins)
        columns.push_back({"body", "", [](const Row &row) { return row.parameter->body; }});
      columns.push_back({"value", "", [](const Row &row) { return row.parameter->value; }, 4, true});
      columns.push_back({"unit", "", [](const Row &row) { return row.parameter->unit; }});
      columns.push_back({"divergence rate per 1 %", "percentage points", [](const Row &row) { return row.divergence_per_percent(); }, 6});
      columns.push_back({"growth rate per 1 %", "1/s", [](const Row &row) { return row.growth_per_percent(); }, 4});
      columns.push_back({"frequency per 1 %", "Hz", [](const Row &row) { return row.frequency_per_percent(); }, 4});
      return Table(columns, rows);
    }

    /// Maximum number of rows of the ranking on the screen.
    constexpr std::size_t n_shown_parameters = 12;

    /// Friction coefficients of the sweep for thresholds, including Operation/Friction coefficient.
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
      run.progress.note(text("  changes per 1 % of a parameter for ", to_string(mode.label), " at ", decimal_text(q.frequency), " Hz, ",
                             mode.is_unstable ?
                               text("which grows with a divergence rate of ", decimal_text(100. * q.divergence_rate), " %") :
                               "the least damped mode, because none grows",
                             ":"));
      run.screen << '\n';
      ranking_table(mode, parameters, false, n_shown_parameters).print(run.screen);
      run.screen << '\n';
    }

    /// Derivatives of the modal damping in the coupled system of a sweep; empty without modal damping.
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

  /// `Study = sensitivity`: derivatives of λ and of thresholds with respect to parameters of the model, from right and left vectors.
  static void run_sensitivity_study(Scene &scene, Run &run)
  {
    const Parameters &p  = run.parameters;
    const double      mu = p.operation.friction_coefficient;
    write_scene_system(scene, run);
    const BodyTerms                   bodies     = assemble_scene(scene, run);
    std::vector<SensitivityParameter> parameters = sensitivity_parameters(scene, p);
    for (SensitivityParameter &parameter : geometry_sensitivity_parameters(scene, bodies, run))
      parameters.push_back(std::move(parameter));

    const SweepPlan plan   = sweep_plan(scene, {line_of(p)}, run);
    const auto      closed = plan.closed_at(mu);
    const auto      regime =
      std::find_if(plan.regimes.begin(), plan.regimes.end(), [&](const ContactRegime &other) { return other.closed == closed; });
    if (plan.regimes.size() > 1)
      run.progress.note(text("  note: thresholds refer to the contact set at mu = ", exact_text(mu), ", one of ", plan.regimes.size(),
                             " contact sets of the sweep"));
    SweepModel sweep(plan, *regime, run);
    evaluate_points(sweep);
    std::optional<SweepChart> chart;
    if (p.sensitivity.thresholds)
      {
        std::vector<double> grid;
        for (const int i : regime->on_line(0))
          if (sweep.known.count({0, regime->points[i].friction_coefficient}) > 0)
            grid.push_back(regime->points[i].friction_coefficient);
        chart = follow_branches(sweep, 0, grid);
      }

    SensitivityModel                   model{sweep, bodies, parameters, modal_damping_derivatives(sweep, p.damping)};
    const std::vector<ModeSensitivity> modes = mode_sensitivities(model, run);
    report(modes.front(), parameters, run);
    run.store_table("sensitivities", mode_sensitivity_table(modes, parameters));
    run.store_table("sensitivity_ranking", ranking_table(modes.front(), parameters, true, 0));
    if (chart)
      {
        const std::vector<ThresholdSensitivity> thresholds = threshold_sensitivities(model, *chart, run);
        if (const auto n = std::count_if(thresholds.begin(), thresholds.end(), [](const auto &found) { return !found.obstacle.empty(); });
            n > 0)
          run.progress.note(text("  note: ", n, " of ", thresholds.size(),
                                 " thresholds have no derivatives (sensitivities_thresholds.csv, column `remark`)"));
        run.store_table("sensitivities_thresholds", threshold_sensitivity_table(thresholds, *chart, parameters));
      }
    run.finish();
  }

  extern const Study sensitivity_study = [] {
    const auto no_thresholds = [](const Parameters &p) { return unless(p.sensitivity.thresholds, "Sensitivity/Thresholds = false"); };
    Study      study{"sensitivity",
                run_sensitivity_study,
                {"Sensitivity/", "Sweep/First friction coefficient", "Sweep/Last friction coefficient",
                      "Sweep/Number of friction coefficients", "Sweep/Tolerance", "Sweep/Maximum basis", "Sweep/Threshold tolerance",
                      "Output/Write system"}};
    study.rules         = {{"Output/Write system", is_used},
                           {"Output/", [](const Parameters &) { return "not written by Study = sensitivity"; }},
                           {"Complex modes/", [](const Parameters &) { return "modes are solved with a reduced model"; }},
                           {"Sweep/First friction coefficient", no_thresholds},
                           {"Sweep/Last friction coefficient", no_thresholds},
                           {"Sweep/Number of friction coefficients", no_thresholds},
                           {"Sweep/Threshold tolerance", no_thresholds}};
    study.run_of_system = run_sensitivity_of_system;
    return study;
  }();
} // namespace Squeal
