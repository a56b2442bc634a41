#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/studies/friction_modes.h>
#include <squeal/studies/mode_tables.h>
#include <squeal/studies/paper_scene.h>
#include <squeal/studies/paper_statements.h>
#include <squeal/studies/paper_table.h>
#include <squeal/studies/sliding_results.h>

#include <ostream>

namespace Squeal
{
  namespace
  {
    /// Refuses what the paper's Table 1 does not show, naming it.
    void check_is_of_paper(const Parameters &parameters)
    {
      std::vector<std::string> differences = differences_from_paper_scene(parameters);
      for (const std::string &path : differences_from_paper_operation(parameters))
        differences.push_back(path);
      if (differences.empty())
        return;
      std::string names;
      for (const std::string &path : differences)
        names += (names.empty() ? "" : ", ") + path;
      throw ParameterError("the study sets modes beside the paper's Table 1, but the scene or its operation is another",
                           "parameter " + names,
                           "leave at their defaults all but mesh, band, solvers and reading of the radial dissipation; or set "
                           "Study = stability");
    }

    /// The operation with radial dissipation: where the parameters name no reading of it, that of linearised Coulomb friction.
    OperationParameters with_dissipation(OperationParameters operation)
    {
      if (operation.radial_dissipation == RadialDissipation::none)
        operation.radial_dissipation = RadialDissipation::consistent;
      return operation;
    }

    OperationParameters without_dissipation(OperationParameters operation)
    {
      operation.radial_dissipation = RadialDissipation::none;
      return operation;
    }

    /// Frequency up to which section 4 of the paper counts modes [Hz].
    constexpr double paper_band = 5000.;

    void write_statements(const SectionFour &results, Run &run)
    {
      run.screen << "\n  statements.csv\n\n";
      statements(results, false).print(run.screen);
      run.store_table("statements", statements(results));
    }

    void write_table_one(const TableOneResults &results, Run &run)
    {
      const TableOne one = table_one(results);
      run.store_table("table1", one.table);
      run.progress.note("  beside the paper's Table 1: frequencies of component modes " + to_string(one.component) + ", coupled " +
                        to_string(one.coupled) + ", complex without C_b " + to_string(one.undamped) + ", with C_b " +
                        to_string(one.damped));
    }
  } // namespace

  /**
   * `Study = paper`: all columns of the paper's Table 1 in one run, component modes, real coupled modes, and complex modes at
   * μ = 0.4 without and with radial dissipation, the latter with the reading of C_b and the state of contact that the
   * parameters name.
   */
  static void run_paper_study(Scene &scene, Run &run)
  {
    const Parameters         &parameters = run.parameters;
    const double              mu = parameters.operation.friction_coefficient, band = parameters.discretization.maximum_frequency;
    const OperationParameters with = with_dissipation(parameters.operation);
    assemble_scene(scene, run);
    std::optional<SlidingState> sliding;
    if (parameters.needs_steady_sliding())
      sliding = solve_sliding(scene, parameters.operation, parameters.sliding, run);

    // Both have the same closed nodes, and thus the same modes without friction
    FrictionlessModes   frictionless = frictionless_modes(linearise(scene, sliding, without_dissipation(with)), run);
    const FrictionModes undamped     = friction_modes(frictionless, mu, run, "Modes without C_b");
    frictionless.linearisation       = linearise(scene, sliding, with);
    const FrictionModes damped       = friction_modes(frictionless, mu, run, "Modes with C_b");
    run.count("unstable modes without C_b", undamped.n_unstable());
    run.count("unstable modes with C_b", damped.n_unstable());

    run.screen << '\n';
    run.progress.note("  C_b: " + to_string(with.radial_dissipation) + ", R_n0 of " + to_string(parameters.sliding.state));
    for (const FrictionModes *friction : {&undamped, &damped})
      for (const std::string &line : verdict(*friction, mu, band))
        run.progress.note((friction == &undamped ? "  without C_b:" : "  with C_b:   ") + line.substr(1));
    run.screen << '\n';
    if (sliding)
      write_sliding_tables(scene, *sliding, parameters.operation, run);

    const auto waves        = waves_with_rotation(frictionless, undamped, with.rotation),
               waves_damped = waves_with_rotation(frictionless, damped, with.rotation);
    run.store_table("complex_modes", complex_table(undamped, waves));
    run.store_table("complex_modes_damped", complex_table(damped, waves_damped));
    run.store_table("real_modes", real_table(frictionless));
    const double omega_max = circular_frequency(band);
    run.store_table("component_modes", component_table(frictionless, omega_max * omega_max));
    const auto component = component_modes_to_compare(frictionless), coupled = coupled_modes_to_compare(frictionless);
    if (band == paper_band)
      {
        const auto before = stated_modes(undamped, waves), after = stated_modes(damped, waves_damped);
        write_statements({component, coupled, before, after, growth_kept(frictionless, undamped, before, damped, after), scene.n_pins()},
                         run);
      }
    write_table_one({component, coupled, complex_modes_to_compare(undamped), complex_modes_to_compare(damped)}, run);
    run.finish();
  }

  extern const Study paper_study = [] {
    Study study{"paper", run_paper_study};
    study.no_mode_shapes   = [](const Parameters &) { return "the study writes no mode shapes"; };
    study.adds_dissipation = true;
    study.check            = check_is_of_paper;
    return study;
  }();
} // namespace Squeal
