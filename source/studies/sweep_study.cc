#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/version.h>
#include <squeal/studies/parameter_usage.h>
#include <squeal/studies/sweep_tables.h>
#include <squeal/tracking/branches.h>
#include <squeal/tracking/error_controlled_sweep.h>
#include <squeal/tracking/mode_links.h>

#include <algorithm>
#include <ostream>

namespace Squeal
{
  namespace
  {
    /// Everything on which the results of a sweep depend: the version of the program, the parameters, the mesh.
    std::string identity(const Run &run, const Scene &scene)
    {
      // What only adds to the results does not change them
      Parameters parameters        = run.parameters;
      parameters.output            = {};
      parameters.sweep.mode_shapes = {};
      parameters.sweep.counts      = {};
      std::ostringstream stream;
      stream << "# squeal " << version << '\n';
      parameters.print(stream, false);
      stream << "# mesh: " << scene.mesh.hexahedra.size() << " hexahedra, " << scene.model->free_map().NumGlobalElements()
             << " dofs, nodes " << std::hex << checksum(scene.mesh) << '\n';
      return stream.str();
    }

    /// Throws ParameterError where nothing depends on what a map varies.
    void check_map(const Parameters &parameters)
    {
      const MapParameter varied = parameters.sweep.map_parameter;
      if (varied == MapParameter::none)
        return;
      const OperationParameters &operation = parameters.operation;
      const bool                 is_steady = parameters.needs_steady_sliding();
      if (operation.radial_dissipation == RadialDissipation::none && operation.friction_slope == 0. &&
          !(is_steady && varied == MapParameter::load))
        throw ParameterError("without contact damping nothing depends on the " + to_string(varied), "parameter Sweep/Map parameter",
                             "set Operation/Radial dissipation or Operation/Friction slope, or Sweep/Map parameter = none");
      if (is_steady && varied == MapParameter::load && parameters.sliding.control != BackplateControl::load_per_side)
        throw ParameterError("a map over the load needs backplates that are pressed with it", "parameter Steady sliding/Control",
                             "set it to load per side, or Sweep/Map parameter = none");
    }

    /// Friction coefficients of the parameters at which other contact nodes are closed than at any value of the sweep.
    void note_unknown_contact(const SweepPlan &plan, Run &run)
    {
      const SweepParameters &sweep = run.parameters.sweep;
      for (const auto *chosen : {&sweep.mode_shapes, &sweep.counts})
        for (const double mu : *chosen)
          if (const auto closed = plan.closed_at(mu);
              std::none_of(plan.regimes.begin(), plan.regimes.end(), [&](const ContactRegime &regime) { return regime.closed == closed; }))
            run.progress.note(text("  note: at mu = ", mu, " other contact nodes are closed than at any value of the sweep: ",
                                   chosen == &sweep.counts ? "modes are not counted" : "no mode shape is written",
                                   ". Raise Sweep/Number of friction coefficients"));
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

    ChartCheckpoint checkpoint(checkpoint_folder(run.folder().name()), identity(run, scene), run.communicator, omega_max);
    if (checkpoint.n_found() > 0)
      run.progress.note(text("  an interrupted sweep goes on: ", checkpoint.n_found(), " operating points are known"));
    assemble_scene(scene, run);

    const SweepPlan                      plan = sweep_plan(scene, run);
    std::vector<std::vector<SweepChart>> charts(plan.lines.size());
    const std::vector<SweepChart>       &main = charts[0];
    std::vector<MapCell>                 map;
    std::vector<CountAt>                 counts;
    for (const ContactRegime &regime : plan.regimes)
      {
        SweepModel model(scene, plan, regime, run);
        evaluate_points(model, *store_of(model, checkpoint, "sweep"));
        follow_branches(model, checkpoint, charts);
        append_map_cells(model, main.empty() ? nullptr : &main.back(), map);
        append_counts(model, counts);
        write_leading_modes(model);
      }
    note_unknown_contact(plan, run);

    if (!main.empty())
      run.progress.note("\n" + verdict(main, plan.lines[0].friction_coefficients.size(), omega_max));
    write_charts(plan, charts, omega_max, run);
    if (!counts.empty())
      run.write_table("argument_counts", argument_table(counts));
    if (plan.regimes.size() > 1)
      {
        run.store_table("contact_sets", contact_table(plan, scene.interface.size()));
        run.progress.note(text("  note: ", plan.regimes.size(), " contact sets, see contact_sets.csv; branches end where the set changes"));
      }
    if (!map.empty())
      run.store_table("map", map_table(map, parameters.sweep.map_parameter));
    run.finish();
    checkpoint.remove();
  }

  extern const Study sweep_study = [] {
    const auto map_axis = [](const Parameters &p) {
      return unless(p.sweep.map_parameter != MapParameter::none, "Sweep/Map parameter = none");
    };
    Study study{"sweep", run_sweep_study, {"Sweep/"}};
    study.rules          = {{"Operation/Friction coefficient",
                             [](const Parameters &) { return "a sweep goes from Sweep/First to Sweep/Last friction coefficient"; }},
                            {"Operation/Rotation speed", no_sliding_speed},
                            {"Complex modes/", [](const Parameters &) { return "a sweep solves reduced models"; }},
                            {"Sweep/First map value", map_axis},
                            {"Sweep/Last map value", map_axis},
                            {"Sweep/Number of map values", map_axis},
                            {"Sweep/Map friction coefficients", map_axis}};
    study.no_mode_shapes = [](const Parameters &p) {
      return unless(!p.sweep.mode_shapes.empty(), "a sweep writes mode shapes for Sweep/Mode shapes at");
    };
    study.check = check_map;
    return study;
  }();
} // namespace Squeal
