// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/studies/steps/mode_results.h>
#include <squeal/studies/steps/parameter_usage.h>
#include <squeal/studies/sweep/sweep_charts.h>
#include <squeal/tracking/mode_links.h>

#include <ostream>

namespace Squeal
{
  namespace
  {
    /// Stability at one point of the map.
    struct MapCell
    {
      double                         friction_coefficient; ///< [-]
      double                         value;                ///< load [N], speed [rad/s] or second parameter
      std::size_t                    n_open;               ///< number of open contact nodes
      std::optional<ModalQuantities> leading;              ///< fastest growing, or least damped, mode; empty if not computed
      ModeLabel                      label;                ///< label of this mode
      int                            n_unstable  = 0;
      int                            n_undecided = 0;  ///< number of undecided modes
      double                         error       = 0.; ///< largest estimated |δλ| / |λ| [-]
    };

    /// A mode of the band at one of the friction coefficients of the complex plane.
    struct PlaneMode
    {
      double               friction_coefficient; ///< [-]
      RadialDissipation    dissipation;
      std::complex<double> lambda; ///< [rad/s]
      ModeLabel            label;
      double               error; ///< estimated |δλ| / |λ| [-]
      Verdict              verdict;
    };

    /// Numbers of modes at one friction coefficient from the sweep and from the argument principle.
    struct CountAt
    {
      double       friction_coefficient;
      int          n_found; ///< number of modes of the sweep in the rectangle
      ContourCount count;
      bool         has_real_modes; ///< the system has a definite part
    };

    /// Label of the branch with the most similar mode at the nearest point of the chart.
    ModeLabel nearest_label(const SweepChart &main, const ChartPoint &point, const int mode)
    {
      const auto &points   = main.chart.points;
      const auto  distance = [&](const ChartPoint &other) { return std::abs(other.friction_coefficient - point.friction_coefficient); };
      const auto  nearest =
        std::min_element(points.begin(), points.end(), [&](const ChartPoint &a, const ChartPoint &b) { return distance(a) < distance(b); });
      const int branch = similar_branch(main.chart, static_cast<int>(nearest - points.begin()), point, mode, false);
      return branch >= 0 ? main.labels[branch] : ModeLabel();
    }

    /// Modes of a line at a requested friction coefficient; prints a note if the estimated error of a new point exceeds the tolerance.
    ChartPoint modes_at(SweepModel &model, const double mu, const int line = 0)
    {
      const bool       is_new    = model.known.count({line, mu}) == 0;
      const ChartPoint point     = model.evaluate(line, {mu}).front();
      const double     tolerance = model.run.parameters.sweep.tolerance, error = model.largest_error(point);
      if (is_new && !(error <= tolerance))
        model.run.progress.note(text("  note: at ", model.plan.axis.name, " = ", mu, line > 0 ? " without radial dissipation" : "",
                                     ", the estimated error ", error, " of the modes exceeds the tolerance of ", tolerance));
      return point;
    }

    /// Appends the points of the map in a contact set; modes are labelled by the branches of the chart @p main unless it is null.
    void append_map_cells(const SweepModel &model, const SweepChart *main, std::vector<MapCell> &cells)
    {
      for (const OperatingPoint &operating : model.regime.points)
        {
          const SweepLine &line = model.plan.lines[operating.line];
          if (line.kind != SweepLine::Kind::map)
            continue;
          cells.push_back({operating.friction_coefficient,
                           line.value,
                           model.plan.scene != nullptr ? model.plan.scene->interface.size() - model.regime.closed.size() : 0,
                           {},
                           {}});
          const auto found = model.known.find({operating.line, operating.friction_coefficient});
          if (found == model.known.end())
            continue;
          MapCell          &cell  = cells.back();
          const ChartPoint &point = found->second;
          if (const int mode = leading_mode(point, model.largest_circular_frequency); mode >= 0)
            {
              cell.leading = modal_quantities(point.lambda[mode]);
              if (main)
                cell.label = nearest_label(*main, point, mode);
            }
          cell.n_unstable  = model.n_of(point, Verdict::unstable);
          cell.n_undecided = model.n_of(point, Verdict::undecided);

          cell.error = model.largest_error(point);
        }
    }

    /// Appends the modes of the band at the friction coefficients of the complex plane that belong to the contact set, on the main line and
    /// on the line without radial dissipation. The basis is not extended, so that charts do not change.
    void append_plane_modes(SweepModel &model, std::vector<PlaneMode> &modes)
    {
      for (const double mu : model.run.parameters.sweep.complex_plane())
        for (std::size_t line = 0; line < model.plan.lines.size(); ++line)
          {
            if (model.plan.lines[line].kind == SweepLine::Kind::map || model.plan.closed_at(mu) != model.regime.closed)
              continue;
            const ChartPoint             point   = modes_at(model, mu, static_cast<int>(line));
            const std::vector<int>       in_band = model.in_band(point);
            const std::vector<ModeLabel> labels  = model.labels_in_band(point);

            for (std::size_t k = 0; k < in_band.size(); ++k)
              {
                const int j = in_band[k];
                modes.push_back({mu, model.plan.lines[line].operation.radial_dissipation, point.lambda[j], labels[k], point.errors[j],
                                 point.verdicts[j]});
              }
          }
    }

    /// Counts the modes at the requested friction coefficients that belong to the contact set.
    void append_counts(SweepModel &model, std::vector<CountAt> &counts)
    {
      Run &run = model.run;
      for (const double mu : run.parameters.sweep.counts)
        {
          if (model.plan.closed_at(mu) != model.regime.closed)
            continue;
          run.progress.begin("Argument principle");
          const auto [options, count] = counted_modes(model.linearisation_at(mu).coupled, mu, model.frictionless, run);
          const int n_found           = n_in_rectangle(modes_at(model, mu).lambda, options);
          counts.push_back({mu, n_found, count, model.reduced != nullptr});
          run.progress.finish(text(counted(count.n_modes, "mode"), " counted, ", n_found, " found at ", model.plan.axis.name, " = ", mu,
                                   ", ", counted(count.n_points, "point")));
          if (count.n_modes != n_found)
            run.progress.note(text("  note: at ", model.plan.axis.name, " = ", mu, ", the sweep found ", counted(n_found, "mode"),
                                   ", but the count is ", count.n_modes));
        }
    }

    /// Writes fields of the leading modes at the requested friction coefficients that belong to the contact set.
    void write_leading_modes(SweepModel &model)
    {
      Run        &run    = model.run;
      const auto &wanted = run.parameters.sweep.mode_shapes;
      if (wanted.empty() || run.parameters.output.fields == FieldSelection::none)
        return;
      const Scene &scene = *model.plan.scene;
      FieldWriter  writer(*scene.model, scene.interface, model.regime.closed, run.folder());
      run.progress.begin("Mode shapes");
      int n_written = 0;
      for (const double mu : wanted)
        {
          if (model.plan.closed_at(mu) != model.regime.closed)
            continue;
          const ChartPoint point = modes_at(model, mu);
          const int        mode  = leading_mode(point, model.largest_circular_frequency);
          if (mode < 0 || verdict_of(point.lambda[mode]) != Verdict::unstable)
            {
              run.progress.note(text("  no mode grows at mu = ", mu, ", so no mode shape is written"));
              continue;
            }
          const auto [re, im] = model.shapes(point, {mode});
          const auto label    = model.labels(point, {mode}).front();
          const auto name     = text("mu_", mu, "_", file_text(label));
          ModeField  field    = mode_field(model.linearisation_at(mu), name, point.lambda[mode], re, im);
          field.title         = mode_title(label, point.lambda[mode]);
          writer.write_mode(field);
          if (run.parameters.output.animation_frames > 0)
            writer.write_animation(name, {field}, animation_options(run.parameters.output));
          ++n_written;
        }
      run.progress.finish(counted(n_written, "leading mode"));
    }

    /// Throws ParameterError if no result depends on the parameter of the map.
    void check_map(const Parameters &parameters)
    {
      const MapParameter varied = parameters.sweep.map_parameter;
      if (varied == MapParameter::none)
        return;
      const OperationParameters &operation = parameters.operation;
      const bool                 is_steady = parameters.needs_steady_sliding();
      const bool has_effect = operation.has_contact_damping() || (varied == MapParameter::load ? is_steady : operation.rotating_disc);
      if (!has_effect)
        throw ParameterError("no term of the model depends on the " + to_string(varied) + " of the map", "parameter Sweep/Map parameter",
                             text("set Operation/Radial dissipation or Operation/Friction slope",
                                  varied == MapParameter::speed ? " or Operation/Gyroscopic forces" : "",
                                  ", or Sweep/Map parameter = none"));
      if (is_steady && varied == MapParameter::load && !parameters.uses_load_per_side())
        throw ParameterError("the steady sliding state does not depend on the load of the map", "parameter Steady sliding/Control",
                             "set it to load per side or pressure, or Sweep/Map parameter = none");
    }

    /// Reports requested friction coefficients at which the contact set is none of the contact sets of the sweep.
    void note_unknown_contact(const SweepPlan &plan, Run &run)
    {
      const SweepParameters                                                  &sweep  = run.parameters.sweep;
      const std::vector<std::pair<const std::vector<double> *, const char *>> chosen = {
        {&sweep.mode_shapes, "no mode shape is written"},
        {&sweep.complex_plane(), "the complex plane is omitted"},
        {&sweep.counts, "modes are not counted"}};
      for (const auto &[values, what_is_missing] : chosen)
        for (const double mu : *values)
          if (const auto closed = plan.closed_at(mu);
              std::none_of(plan.regimes.begin(), plan.regimes.end(), [&](const ContactRegime &regime) { return regime.closed == closed; }))
            run.progress.note(text("  note: at mu = ", mu, ", ", what_is_missing,
                                   ", because the contact set is none of the contact sets of the sweep. Raise Sweep/Number of friction "
                                   "coefficients, or extend the range of the sweep to this value"));
    }

    // ------------------------------------------------------------------ tables

    /// Onsets of growth and of divergence rates above weak_divergence.
    Table onset_table(const std::vector<SquealOnset> &onsets, const SweepAxis &axis)
    {
      using Row     = SquealOnset;
      const auto of = [](auto GrowthOnset::*member) { return [member](const Row &row) { return row.onset.*member; }; };
      return Table(Columns<Row>{{"divergence rate beyond", "%", [](const Row &row) { return 100. * row.divergence_rate; }, 4},
                                {axis.name, axis.unit, of(&GrowthOnset::friction_coefficient), 6},
                                {"uncertainty", "-", of(&GrowthOnset::uncertainty), 1, true},
                                {"label", "", &Row::label},
                                {"frequency", "Hz", [](const Row &row) { return modal_quantities(row.onset.lambda).frequency; }, 3}},
                   onsets);
    }

    Table map_table(std::vector<MapCell> cells, const SweepPlan &plan)
    {
      using Row        = MapCell;
      const auto known = [](const auto &value) {
        return [value](const Row &row) { return row.leading ? Entry(std::invoke(value, row)) : Entry(); };
      };
      const auto leading = [](double ModalQuantities::*quantity, const double factor = 1.) {
        return [quantity, factor](const Row &row) { return row.leading ? Entry(factor * ((*row.leading).*quantity)) : Entry(); };
      };
      std::sort(cells.begin(), cells.end(), [](const Row &a, const Row &b) {
        return std::tie(a.value, a.friction_coefficient) < std::tie(b.value, b.friction_coefficient);
      });
      return Table(Columns<Row>{{plan.axis.name, plan.axis.unit, &Row::friction_coefficient, 4},
                                {plan.second_axis.name, plan.second_axis.unit, &Row::value, 3},
                                {"unstable modes", "-", known(&Row::n_unstable)},
                                {"undecided modes", "-", known(&Row::n_undecided)},
                                {"label", "", known(&Row::label)},
                                {"frequency", "Hz", leading(&ModalQuantities::frequency), 2},
                                {"growth rate", "1/s", leading(&ModalQuantities::growth_rate), 4},
                                {"divergence rate", "%", leading(&ModalQuantities::divergence_rate, 100.), 4},
                                {"estimated error of lambda", "-", known(&Row::error), 1, true},
                                {"open contact nodes", "-", &Row::n_open}},
                   cells);
    }

    Table plane_table(const std::vector<PlaneMode> &modes, const SweepAxis &axis)
    {
      using Row           = PlaneMode;
      const auto quantity = [](double ModalQuantities::*member, const double factor = 1.) {
        return [member, factor](const Row &row) { return factor * (modal_quantities(row.lambda).*member); };
      };
      return Table(Columns<Row>{{axis.name, axis.unit, &Row::friction_coefficient, 4},
                                {"radial dissipation", "", [](const Row &row) { return to_string(row.dissipation); }},
                                {"label", "", &Row::label},
                                {"frequency", "Hz", quantity(&ModalQuantities::frequency), 3},
                                {"growth rate", "1/s", quantity(&ModalQuantities::growth_rate), 4},
                                {"divergence rate", "%", quantity(&ModalQuantities::divergence_rate, 100.), 4},
                                {"estimated error of lambda", "-", &Row::error, 1, true},
                                {"verdict", "", &Row::verdict}},
                   modes);
    }

    Table argument_table(const std::vector<CountAt> &counts, const SweepAxis &axis)
    {
      using Row = CountAt;
      return Table(Columns<Row>{{axis.name, axis.unit, &Row::friction_coefficient, 4},
                                {"modes of the sweep", "-", &Row::n_found},
                                {"modes counted", "-", [](const Row &row) { return row.count.n_modes; }},
                                {"real modes by inertia", "-",
                                 [](const Row &row) { return row.has_real_modes ? Entry(row.count.n_frictionless) : Entry(); }},
                                {"contour points", "-", [](const Row &row) { return row.count.n_points; }},
                                {"largest phase step", "rad", [](const Row &row) { return row.count.largest_phase_step; }, 3},
                                {"truncation bound", "-", [](const Row &row) { return row.count.truncation_bound; }, 1, true}},
                   counts);
    }
  } // namespace

  /// Solves the points of a plan, one contact set at a time, and writes the results.
  static void run_plan(const SweepPlan &plan, Run &run)
  {
    const double                         omega_max = circular_frequency(run.parameters.discretization.maximum_frequency);
    std::vector<std::vector<SweepChart>> charts(plan.lines.size());
    const std::vector<SweepChart>       &main = charts[0];
    std::vector<MapCell>                 map;
    std::vector<PlaneMode>               plane;
    std::vector<CountAt>                 counts;
    for (const ContactRegime &regime : plan.regimes)
      {
        SweepModel model(plan, regime, run);
        evaluate_points(model);
        const auto of_other_sets = charts;
        follow_branches(model, charts);
        if (model.reduced && run.parameters.output.write_system == SystemOutput::reduced)
          {
            // Evaluate all points with the final basis, so that tables agree with the written model
            evaluate_again(model);
            charts = of_other_sets;
            follow_branches(model, charts);
          }
        append_map_cells(model, main.empty() ? nullptr : &main.back(), map);
        append_plane_modes(model, plane);
        append_counts(model, counts);
        if (plan.scene != nullptr)
          write_leading_modes(model);
        write_system_of(model);
      }
    note_unknown_contact(plan, run);

    if (!main.empty())
      {
        run.progress.note("\n" + verdict(main, plan.lines[0].friction_coefficients.size(), omega_max, plan.axis.name));
        run.store_table("onsets", onset_table(squeal_onsets(main), plan.axis));
      }
    write_charts(plan, charts, omega_max, run);
    if (!plane.empty())
      run.store_table("complex_plane", plane_table(plane, plan.axis));
    if (!counts.empty())
      run.write_table("argument_counts", argument_table(counts, plan.axis));
    if (plan.regimes.size() > 1)
      {
        run.store_table("contact_sets", contact_table(plan, plan.scene->interface.size()));
        run.progress.note(text("  note: branches end where the contact set changes; ", plan.regimes.size(),
                               " contact sets are listed in contact_sets.csv"));
      }
    if (!map.empty())
      run.store_table("map", map_table(map, plan));
    run.finish();
  }

  /// `Study = sweep`: complex modes and thresholds over a range of the friction coefficient; optionally also without radial dissipation,
  /// and maps over load or speed.
  static void run_sweep_study(Scene &scene, Run &run)
  {
    assemble_scene(scene, run);
    run_plan(sweep_plan(scene, run), run);
  }

  /// `Study = sweep` for a system file: varies one parameter, or two in a map.
  static void run_sweep_of_system(Run &run)
  {
    run_plan(sweep_plan_of_system(run), run);
  }

  extern const Study sweep_study = [] {
    const auto map_axis = [](const Parameters &p) {
      return unless(p.sweep.map_parameter != MapParameter::none, "Sweep/Map parameter = none");
    };
    Study study{"sweep", run_sweep_study, {"Sweep/", "Output/Write system"}};
    study.rules = {
      {"Output/Write system", is_used},
      {"Output/",
       [](const Parameters &p) {
         return p.sweep.mode_shapes.empty() && p.output.fields != FieldSelection::none ?
                  "fields are written only for the values of Sweep/Mode shapes at" :
                  as_in_general;
       }},
      {"Operation/Friction coefficient", [](const Parameters &) { return "a sweep uses the friction coefficients of section Sweep"; }},
      {"Operation/Rotation speed", no_sliding_speed},
      {"Complex modes/", [](const Parameters &) { return "a sweep uses reduced models"; }},
      {"Sweep/First map value", map_axis},
      {"Sweep/Last map value", map_axis},
      {"Sweep/Number of map values", map_axis},
      {"Sweep/Map friction coefficients", map_axis}};
    study.check             = check_map;
    study.run_of_system     = run_sweep_of_system;
    study.has_reduced_model = true;
    return study;
  }();
} // namespace Squeal
