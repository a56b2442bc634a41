// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/sensitivity/eigenvalue_derivatives.h>
#include <squeal/studies/sensitivity/sensitivity_results.h>
#include <squeal/studies/steps/imported_modes.h>
#include <squeal/studies/steps/written_system.h>

#include <boost/range/irange.hpp>

namespace Squeal
{
  namespace
  {
    /// Tolerance for the relative error of λ; errors of left and right vectors are about its square root [-].
    constexpr double tolerance_of_vectors = 1e-12;
  } // namespace

  FrictionModes left_and_right_modes(const FrictionlessModes &frictionless, const double value, Run &run)
  {
    const CoupledSystem &coupled = frictionless.linearisation.coupled;
    run.progress.begin("Left and right modes");
    SolverParameters solvers    = run.parameters.solvers;
    solvers.complex_solver      = ComplexSolver::residual_iteration;
    solvers.iteration_tolerance = tolerance_of_vectors;
    FrictionModes result        = named_modes(
             frictionless, modes_with_friction(coupled, frictionless, value, run.parameters.discretization.band(), solvers, run.progress));
    run.progress.finish(counted(result.modes.lambda.size(), "mode"));
    return result;
  }

  Eigentriples eigentriples(const ComplexModes &modes)
  {
    return {modes.lambda, join({modes.real_part.get(), modes.imaginary_part.get()}),
            join({modes.left_real_part.get(), modes.left_imaginary_part.get()})};
  }

  void run_sensitivity_of_system(Run &run)
  {
    const GivenSystem    given  = given_system(run);
    const SystemFile    &file   = given.file;
    const CoupledSystem &system = given.coupled;
    if (file.parameters.empty())
      throw ParameterError("derivatives require parameters, but the system file has none", "file " + file.path,
                           "add `parameters` and coefficients of terms, or set Study = stability");
    const double        value = given.value;
    const FrictionModes friction =
      system.stiffness ? left_and_right_modes(imported_modes(system, system, run), value, run) : direct_solution(given, run);
    const ComplexModes &modes = friction.modes;

    const TermProducts       products(system.terms, eigentriples(modes));
    const ParameterValues    at = system.at(value);
    const ComplexDenseMatrix D  = products.by_lambda(at);
    struct Row
    {
      int                  mode;
      const FileParameter *parameter;
      double               value;
      std::complex<double> derivative;
    };
    std::vector<Row> rows;
    for (const FileParameter &parameter : file.parameters)
      {
        const ComplexDenseMatrix N = products.along(at, {{parameter.name, {1.}}});
        for (std::size_t j = 0; j < modes.lambda.size(); ++j)
          rows.push_back(
            {static_cast<int>(j), &parameter, given.values.at(parameter.name).front(), eigenvalue_derivative(N, D, static_cast<int>(j))});
      }
    const auto lambda  = [&](const Row &row) { return modes.lambda[row.mode]; };
    const auto percent = [](const Row &row) { return 0.01 * row.value * row.derivative; };
    run.store_table(
      "sensitivities",
      Table(Columns<Row>{{"mode", "-", [](const Row &row) { return row.mode + 1; }},
                         {"label", "", [&](const Row &row) { return friction.labels[row.mode]; }},
                         {"frequency", "Hz", [&](const Row &row) { return modal_quantities(lambda(row)).frequency; }},
                         {"growth rate", "1/s", [&](const Row &row) { return lambda(row).real(); }},
                         {"divergence rate", "%", [&](const Row &row) { return 100. * modal_quantities(lambda(row)).divergence_rate; }},
                         {"parameter", "", [](const Row &row) { return row.parameter->name; }},
                         {"value", "", &Row::value},
                         {"unit", "", [](const Row &row) { return row.parameter->unit; }},
                         {"growth rate per 1 %", "1/s", [&](const Row &row) { return percent(row).real(); }},
                         {"frequency per 1 %", "Hz", [&](const Row &row) { return hertz(percent(row).imag()); }},
                         {"growth rate per unit", "1/s", [](const Row &row) { return row.derivative.real(); }},
                         {"frequency per unit", "Hz", [](const Row &row) { return hertz(row.derivative.imag()); }}},
            rows));
    write_system_again(file, "system/", run);
    run.finish();
  }
} // namespace Squeal
