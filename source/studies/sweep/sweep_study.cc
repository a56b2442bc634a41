#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/output/table.h>
#include <squeal/studies/steps/parameter_usage.h>
#include <squeal/studies/sweep/sweep_results.h>
#include <squeal/tracking/branches.h>
#include <squeal/tracking/error_controlled_sweep.h>
#include <squeal/tracking/mode_links.h>

#include <algorithm>
#include <functional>
#include <ostream>
#include <tuple>
#include <vector>

namespace Squeal
{
  namespace
  {
    /// Throws ParameterError where nothing depends on what a map varies.
    void check_map(const Parameters &parameters)
    {
      const MapParameter varied = parameters.sweep.map_parameter;
      if (varied == MapParameter::none)
        return;
      const OperationParameters &operation = parameters.operation;
      const bool                 is_steady = parameters.needs_steady_sliding();
      if (!operation.has_contact_damping() && !(is_steady && varied == MapParameter::load))
        throw ParameterError("without contact damping nothing depends on the " + to_string(varied), "parameter Sweep/Map parameter",
                             "set Operation/Radial dissipation or Operation/Friction slope, or Sweep/Map parameter = none");
      if (is_steady && varied == MapParameter::load && parameters.sliding.control != BackplateControl::load_per_side)
        throw ParameterError("a map over the load needs backplates that are pressed with it", "parameter Steady sliding/Control",
                             "set it to load per side, or Sweep/Map parameter = none");
    }

    /// Friction coefficients of the parameters at which other contact nodes are closed than at any value of the sweep.
    void note_unknown_contact(const SweepPlan &plan, Run &run)
    {
      const SweepParameters                                                  &sweep  = run.parameters.sweep;
      const std::vector<std::pair<const std::vector<double> *, const char *>> chosen = {
        {&sweep.mode_shapes, "no mode shape is written"},
        {&sweep.complex_plane(), "the complex plane is left out"},
        {&sweep.counts, "modes are not counted"}};
      for (const auto &[values, what_is_missing] : chosen)
        for (const double mu : *values)
          if (const auto closed = plan.closed_at(mu);
              std::none_of(plan.regimes.begin(), plan.regimes.end(), [&](const ContactRegime &regime) { return regime.closed == closed; }))
            run.progress.note(text("  note: at mu = ", mu, " other contact nodes are closed than at any value of the sweep: ",
                                   what_is_missing, ". Raise Sweep/Number of friction coefficients"));
    }

    // ------------------------------------------------------------------ tables

    /// Every mode of the band at every point of a chart, refined ones included: its branch, λ, residuals, error, verdict and whether λ grows.
    Table branch_table(const SweepChart &line, const double largest_circular_frequency)
    {
      struct Row : ModalQuantities
      {
        const ChartPoint &point;
        int               mode; ///< of the point
        int               branch;
        ModeLabel         label;
        bool              is_refinement;
      };
      const StabilityChart &chart = line.chart;
      std::vector<Row>      rows;
      for (std::size_t i = 0; i < chart.points.size(); ++i)
        for (std::size_t b = 0; b < chart.branches.size(); ++b)
          {
            const ChartPoint &point = chart.points[i];
            const int         j     = chart.branches[b].modes[i];
            if (j >= 0 && point.lambda[j].imag() <= largest_circular_frequency)
              rows.push_back(
                {modal_quantities(point.lambda[j]), point, j, static_cast<int>(b + 1), line.labels[b], chart.is_refinement[i]});
          }
      return Table(
        Columns<Row>{{"mu", "-", [](const Row &row) { return row.point.friction_coefficient; }, 6},
                     {"branch", "-", &Row::branch},
                     {"label", "", &Row::label},
                     {"frequency", "Hz", &Row::frequency, 3},
                     {"growth rate", "1/s", &Row::growth_rate, 4},
                     {"divergence rate", "%", [](const Row &row) { return 100. * row.divergence_rate; }, 4},
                     {"eps_res right", "-", [](const Row &row) { return row.point.right_residuals[row.mode]; }, 1, true},
                     {"eps_res left", "-", [](const Row &row) { return row.point.left_residuals[row.mode]; }, 1, true},
                     {"estimated error of lambda", "-", [](const Row &row) { return row.point.errors[row.mode]; }, 1, true},
                     {"verdict", "", [](const Row &row) { return row.point.verdicts[row.mode]; }},
                     {"refinement", "-", &Row::is_refinement},
                     {"growing", "-", [](const Row &row) { return verdict_of(row.point.lambda[row.mode]) == Verdict::unstable; }}},
        rows);
    }

    /// Where branches begin or cease to grow.
    Table threshold_table(const SweepChart &line)
    {
      using Row                = Threshold;
      const auto partner       = [](const Row &row) { return row.partner >= 0 ? Cell(row.partner + 1) : Cell(); };
      const auto partner_label = [&](const Row &row) { return row.partner >= 0 ? Cell(line.labels[row.partner]) : Cell(); };
      return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 6},
                                {"uncertainty", "-", &Row::uncertainty, 1, true},
                                {"event", "", &Row::event},
                                {"mechanism", "", &Row::mechanism},
                                {"branch", "-", [](const Row &row) { return row.branch + 1; }},
                                {"label", "", [&](const Row &row) { return line.labels[row.branch]; }},
                                {"partner", "-", partner},
                                {"label of partner", "", partner_label},
                                {"frequency", "Hz", [](const Row &row) { return modal_quantities(row.lambda).frequency; }, 3}},
                   line.chart.thresholds);
    }

    /// Where squeal begins, and from where on it is more than weak.
    Table onset_table(const std::vector<SquealOnset> &onsets)
    {
      using Row     = SquealOnset;
      const auto of = [](auto GrowthOnset::*member) { return [member](const Row &row) { return row.onset.*member; }; };
      return Table(Columns<Row>{{"divergence rate beyond", "%", [](const Row &row) { return 100. * row.divergence_rate; }, 4},
                                {"mu", "-", of(&GrowthOnset::friction_coefficient), 6},
                                {"uncertainty", "-", of(&GrowthOnset::uncertainty), 1, true},
                                {"label", "", &Row::label},
                                {"frequency", "Hz", [](const Row &row) { return modal_quantities(row.onset.lambda).frequency; }, 3}},
                   onsets);
    }

    /// Where branches enter or leave the band.
    Table crossing_table(const SweepChart &line)
    {
      using Row = BandCrossing;
      return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 6},
                                {"uncertainty", "-", &Row::uncertainty, 1, true},
                                {"branch", "-", [](const Row &row) { return row.branch + 1; }},
                                {"label", "", [&](const Row &row) { return line.labels[row.branch]; }},
                                {"direction", "", [](const Row &row) { return row.enters ? "enters" : "leaves"; }},
                                {"edge", "", &Row::edge}},
                   line.chart.crossings);
    }

    /// Modes in the band at every point, and how many the crossings imply.
    Table count_table(const StabilityChart &chart)
    {
      using Row = ChartCount;
      return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 6},
                                {"modes", "-", &Row::n_modes},
                                {"expected", "-", &Row::n_expected},
                                {"overdamped pairs", "-", &Row::n_overdamped}},
                   chart.counts);
    }

    /// Stability over the friction coefficient and the load or speed.
    Table map_table(std::vector<MapCell> cells, const MapParameter parameter)
    {
      using Row          = MapCell;
      const bool is_load = parameter == MapParameter::load;
      const auto known   = [](const auto &value) {
        return [value](const Row &row) { return row.leading ? Cell(std::invoke(value, row)) : Cell(); };
      };
      const auto leading = [](double ModalQuantities::*quantity, const double factor = 1.) {
        return [quantity, factor](const Row &row) { return row.leading ? Cell(factor * ((*row.leading).*quantity)) : Cell(); };
      };
      std::sort(cells.begin(), cells.end(), [](const Row &a, const Row &b) {
        return std::tie(a.value, a.friction_coefficient) < std::tie(b.value, b.friction_coefficient);
      });
      return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 4},
                                {is_load ? "load per side" : "rotation speed", is_load ? "N" : "rad/s", &Row::value, 3},
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

    /// Modes at the friction coefficients of the complex plane, in the order of the parameter, without dissipation last.
    Table plane_table(const std::vector<PlaneMode> &modes)
    {
      using Row           = PlaneMode;
      const auto quantity = [](double ModalQuantities::*member, const double factor = 1.) {
        return [member, factor](const Row &row) { return factor * (modal_quantities(row.lambda).*member); };
      };
      return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 4},
                                {"radial dissipation", "", [](const Row &row) { return to_string(row.dissipation); }},
                                {"label", "", &Row::label},
                                {"frequency", "Hz", quantity(&ModalQuantities::frequency), 3},
                                {"growth rate", "1/s", quantity(&ModalQuantities::growth_rate), 4},
                                {"divergence rate", "%", quantity(&ModalQuantities::divergence_rate, 100.), 4},
                                {"estimated error of lambda", "-", &Row::error, 1, true},
                                {"verdict", "", &Row::verdict}},
                   modes);
    }

    /// Numbers of modes beside those of the argument principle.
    Table argument_table(const std::vector<CountAt> &counts)
    {
      using Row = CountAt;
      return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 4},
                                {"modes of the sweep", "-", &Row::n_found},
                                {"modes counted", "-", [](const Row &row) { return row.count.n_modes; }},
                                {"real modes by inertia", "-", [](const Row &row) { return row.count.n_frictionless; }},
                                {"contour points", "-", [](const Row &row) { return row.count.n_points; }},
                                {"largest phase step", "rad", [](const Row &row) { return row.count.largest_phase_step; }, 3},
                                {"truncation bound", "-", [](const Row &row) { return row.count.truncation_bound; }, 1, true}},
                   counts);
    }

    /// Contact sets along the lines: where they change.
    Table contact_table(const SweepPlan &plan, const std::size_t n_pairs)
    {
      struct Row
      {
        double               friction_coefficient;
        const SweepLine     &line;
        const ContactRegime &regime;
      };
      std::vector<Row> rows;
      for (std::size_t l = 0; l < plan.lines.size(); ++l)
        if (plan.lines[l].kind != SweepLine::Kind::without_dissipation)
          for (const double mu : plan.lines[l].friction_coefficients)
            for (const ContactRegime &regime : plan.regimes)
              for (const int i : regime.on_line(static_cast<int>(l)))
                if (regime.points[i].friction_coefficient == mu)
                  rows.push_back({mu, plan.lines[l], regime});
      return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 4},
                                {"load per side", "N", [](const Row &row) { return row.line.operation.load_per_side; }, 3},
                                {"rotation speed", "rad/s", [](const Row &row) { return row.line.operation.rotation_speed; }, 3},
                                {"contact set", "-", [](const Row &row) { return row.regime.number; }},
                                {"open contact nodes", "-", [&](const Row &row) { return n_pairs - row.regime.closed.size(); }}},
                   rows);
    }

    /// @p charts of each line of the plan.
    void write_charts(const SweepPlan &plan, const std::vector<std::vector<SweepChart>> &charts, const double omega_max, Run &run)
    {
      for (std::size_t l = 0; l < charts.size(); ++l)
        for (std::size_t s = 0; s < charts[l].size(); ++s)
          {
            const SweepChart &chart   = charts[l][s];
            const bool        is_main = plan.lines[l].kind == SweepLine::Kind::main;
            const std::string suffix  = (is_main ? "" : "_without_dissipation") + (s > 0 ? text("_", s + 1) : "");
            run.store_table("branches" + suffix, branch_table(chart, omega_max));
            run.store_table("counts" + suffix, count_table(chart.chart));
            run.write_table("thresholds" + suffix, threshold_table(chart));
            const bool crosses = !chart.chart.crossings.empty();
            (run.*(crosses ? &Run::write_table : &Run::store_table))("band_crossings" + suffix, crossing_table(chart));
          }
    }

  } // namespace

  /**
   * `Study = sweep`: complex modes over a range of the friction coefficient, with and without radial dissipation, where
   * they begin and cease to grow, and maps over load or speed.
   */
  static void run_sweep_study(Scene &scene, Run &run)
  {
    const Parameters &parameters = run.parameters;
    const double      omega_max  = circular_frequency(parameters.discretization.maximum_frequency);

    ChartCheckpoint checkpoint(checkpoint_folder(run.folder().name()), sweep_identity(run, scene), run.communicator);
    if (checkpoint.n_found() > 0)
      run.progress.note(text("  an interrupted sweep goes on: ", checkpoint.n_found(), " operating points are known"));
    assemble_scene(scene, run);

    const SweepPlan                      plan = sweep_plan(scene, run);
    std::vector<std::vector<SweepChart>> charts(plan.lines.size());
    const std::vector<SweepChart>       &main = charts[0];
    std::vector<MapCell>                 map;
    std::vector<PlaneMode>               plane;
    std::vector<CountAt>                 counts;
    for (const ContactRegime &regime : plan.regimes)
      {
        SweepModel model(plan, regime, run);
        evaluate_points(model, *store_of(model, checkpoint, "sweep"));
        follow_branches(model, checkpoint, charts);
        append_map_cells(model, main.empty() ? nullptr : &main.back(), map);
        append_plane_modes(model, plane);
        append_counts(model, counts);
        write_leading_modes(model);
      }
    note_unknown_contact(plan, run);

    if (!main.empty())
      {
        run.progress.note("\n" + verdict(main, plan.lines[0].friction_coefficients.size(), omega_max));
        run.store_table("onsets", onset_table(squeal_onsets(main)));
      }
    write_charts(plan, charts, omega_max, run);
    if (!plane.empty())
      run.store_table("complex_plane", plane_table(plane));
    if (!counts.empty())
      run.write_table("argument_counts", argument_table(counts));
    if (plan.regimes.size() > 1)
      {
        run.store_table("contact_sets", contact_table(plan, scene.interface.size()));
        run.progress.note(text("  note: ", plan.regimes.size(), " contact sets, see contact_sets.csv; branches end where the set changes"));
      }
    if (!map.empty())
      run.store_table("map", map_table(map, parameters.sweep.map_parameter));
    run.finish([&] { checkpoint.remove(); });
  }

  extern const Study sweep_study = [] {
    const auto map_axis = [](const Parameters &p) {
      return unless(p.sweep.map_parameter != MapParameter::none, "Sweep/Map parameter = none");
    };
    Study study{"sweep", run_sweep_study, {"Sweep/"}};
    study.rules = {{"Output/",
                    [](const Parameters &p) {
                      return p.sweep.mode_shapes.empty() && p.output.fields != FieldSelection::none ?
                               "a sweep writes mode shapes for Sweep/Mode shapes at" :
                               as_in_general;
                    }},
                   {"Operation/Friction coefficient",
                    [](const Parameters &) { return "a sweep goes from Sweep/First to Sweep/Last friction coefficient"; }},
                   {"Operation/Rotation speed", no_sliding_speed},
                   {"Complex modes/", [](const Parameters &) { return "a sweep solves reduced models"; }},
                   {"Sweep/First map value", map_axis},
                   {"Sweep/Last map value", map_axis},
                   {"Sweep/Number of map values", map_axis},
                   {"Sweep/Map friction coefficients", map_axis}};
    study.check = check_map;
    return study;
  }();
} // namespace Squeal
