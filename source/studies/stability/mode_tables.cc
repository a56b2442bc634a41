// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/studies/stability/mode_tables.h>

#include <boost/range/irange.hpp>

#include <ostream>

namespace Squeal
{
  namespace
  {
    /// Maximum number of unstable modes on the screen.
    constexpr std::size_t n_shown_modes = 20;

    Table real_table(const FrictionlessModes &modes)
    {
      return Table(Columns<int>{{"label", "", [&](const int j) { return modes.labels[j]; }},
                                {"share", "-", [&](const int j) { return modes.labels[j].participation; }, 3},
                                {"frequency", "Hz", [&](const int j) { return hertz(std::sqrt(modes.real.eigenvalues[j])); }, 3},
                                {"residual", "-", [&](const int j) { return modes.real.residuals[j]; }, 1, true}},
                   boost::irange<int>(0, modes.labels.size()));
    }

    /// A column with one of the modal_quantities() of modes with friction, by mode index.
    Column<int> column_of(const FrictionModes &friction,
                          const std::string   &name,
                          const std::string   &unit,
                          double ModalQuantities::*quantity,
                          const int                digits)
    {
      const double factor = unit == "%" ? 100. : 1.;
      return {name, unit,
              [&friction, quantity, factor](const int j) { return factor * (modal_quantities(friction.modes.lambda[j]).*quantity); },
              digits};
    }

    /// Table of the complex modes, with columns @p energies and @p more by mode index.
    Table complex_table(const FrictionModes &friction, const Columns<int> &energies, const Columns<int> &more)
    {
      const ComplexModes &modes   = friction.modes;
      Columns<int>        columns = {{"label", "", [&](const int j) { return friction.labels[j]; }},
                                     {"share", "-", [&](const int j) { return friction.labels[j].participation; }, 3},
                                     column_of(friction, "frequency", "Hz", &ModalQuantities::frequency, 3),
                                     column_of(friction, "growth rate", "1/s", &ModalQuantities::growth_rate, 4),
                                     column_of(friction, "divergence rate", "%", &ModalQuantities::divergence_rate, 4),
                                     column_of(friction, "effective damping ratio -2R/omega", "%", &ModalQuantities::damping_ratio, 4),
                                     {"residual", "-", [&](const int j) { return modes.residuals[j]; }, 1, true}};
      if (!modes.energy_residuals.empty())
        columns.push_back({"eps_res", "-", [&](const int j) { return modes.energy_residuals[j]; }, 1, true});
      columns.push_back({"unstable", "-", [&](const int j) { return bool(friction.unstable[j]); }});
      columns.insert(columns.end(), energies.begin(), energies.end());
      if (!modes.estimated_errors.empty())
        columns.push_back({"estimated error of lambda", "-", [&](const int j) { return modes.estimated_errors[j]; }, 1, true});
      if (more.empty()) // additional columns contain a verdict that includes the discretisation error
        columns.push_back({"verdict", "", [&](const int j) { return to_string(friction.verdicts[j]); }});
      columns.insert(columns.end(), more.begin(), more.end());
      return Table(columns, boost::irange<int>(0, friction.labels.size()));
    }

    /// Growing modes, largest divergence rate first; at most @p n_largest rows.
    Table unstable_table(const FrictionModes &friction, const std::size_t n_largest)
    {
      std::vector<int> growing;
      for (std::size_t j = 0; j < friction.unstable.size(); ++j)
        if (friction.unstable[j])
          growing.push_back(static_cast<int>(j));
      const auto rate = [&](const int j) { return modal_quantities(friction.modes.lambda[j]).divergence_rate; };
      std::stable_sort(growing.begin(), growing.end(), [&](const int a, const int b) { return rate(a) > rate(b); });
      growing.resize(std::min(growing.size(), n_largest));
      return Table(Columns<int>{{"unstable mode", "", [&](const int j) { return friction.labels[j]; }},
                                column_of(friction, "frequency", "Hz", &ModalQuantities::frequency, 1),
                                column_of(friction, "growth rate", "1/s", &ModalQuantities::growth_rate, 2),
                                column_of(friction, "divergence rate", "%", &ModalQuantities::divergence_rate, 4),
                                {"share", "-", [&](const int j) { return friction.labels[j].participation; }, 3}},
                   growing);
    }

    /// Real eigenvalues, fastest growth first.
    Table real_eigenvalue_table(std::vector<double> values)
    {
      std::reverse(values.begin(), values.end());
      return Table(Columns<double>{{"growth rate", "1/s", [](const double value) { return value; }, 4},
                                   {"kind", "", [](const double value) { return value > 0. ? "static divergence" : "decay"; }}},
                   values);
    }
  } // namespace

  void record_modes(const FrictionlessModes &frictionless, const FrictionModes &friction, Run &run)
  {
    const SolverParameters &solvers = run.parameters.solvers;
    if (!frictionless.labels.empty())
      record_conditioning(frictionless.linearisation.coupled, friction.modes, friction.conditioning,
                          solvers.complex_solver == ComplexSolver::krylov ? solvers.complex_tolerance : solvers.iteration_tolerance, run);
    run.count("complex modes", friction.modes.lambda.size());
    run.count("unstable modes", friction.n_unstable());
    run.count("undecided modes", friction.n_of(Verdict::undecided));
    run.count("real eigenvalues", friction.modes.real_values.size());
    run.count("growing real eigenvalues", friction.n_growing_real());
    if (friction.n_growing_real() > 0)
      run.measure("largest growth rate of a real eigenvalue [1/s]", friction.modes.real_values.back());
  }

  void report_modes(const FrictionlessModes                &frictionless,
                    const FrictionModes                    &friction,
                    const std::vector<DiscretisationError> &mesh_errors,
                    Run                                    &run)
  {
    const Parameters &parameters = run.parameters;
    run.screen << '\n';
    for (const std::string &line : verdict(friction, parameters.discretization.maximum_frequency))
      run.progress.note(line);
    if (!mesh_errors.empty())
      report_mesh_errors(mesh_errors, friction, run);
    if (friction.n_unstable() > 0)
      {
        run.screen << '\n';
        unstable_table(friction, n_shown_modes).print(run.screen);
        if (friction.n_unstable() > n_shown_modes)
          run.progress.note(text("    and ", friction.n_unstable() - n_shown_modes, " more (complex_modes.csv)"));
      }
    run.screen << '\n';
    if (const std::string note = note_on_count(friction, frictionless.real.eigenvalues.size(), parameters.discretization.maximum_rate);
        !note.empty() && !frictionless.labels.empty())
      run.progress.note(note);
    if (const std::string note = note_on_weak_damping(frictionless.linearisation.coupled, friction); !note.empty())
      run.progress.note(note);
  }

  void store_mode_tables(const FrictionlessModes &frictionless,
                         const FrictionModes     &friction,
                         const Columns<int>      &energies,
                         const Columns<int>      &more,
                         Run                     &run)
  {
    run.store_table("complex_modes", complex_table(friction, energies, more));
    if (!frictionless.labels.empty())
      run.store_table("real_modes", real_table(frictionless));
    if (!friction.modes.real_values.empty())
      run.store_table("real_eigenvalues", real_eigenvalue_table(friction.modes.real_values));
  }
} // namespace Squeal
