// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/studies/search/search_steps.h>
#include <squeal/studies/steps/imported_modes.h>

#include <nlopt.hpp>

#include <exception>
#include <numeric>

namespace Squeal
{
  extern const Study stability_study;

  namespace
  {
    /// Maximum number of searches, each from a different starting point.
    constexpr std::size_t most_searches = 2;

    nlopt::algorithm algorithm(const SearchMethod method)
    {
      return method == SearchMethod::subplex ? nlopt::LN_SBPLX : method == SearchMethod::cobyla ? nlopt::LN_COBYLA : nlopt::LN_BOBYQA;
    }

    FrictionModes modes_of_system(const GivenSystem &given, Run &run)
    {
      if (!given.coupled.stiffness)
        return direct_solution(given, run);
      return friction_modes(imported_modes(given.coupled, given.coupled, run), given.value, run);
    }

    FrictionModes modes_of_mesh(const double mu, Run &run)
    {
      Scene scene = mesh_scene(run);
      return friction_modes(damped_modes(scene, run), mu, run);
    }
  } // namespace

  std::vector<DesignVariable> search_variables(const DesignParameters &designs)
  {
    std::vector<DesignVariable> result = design_variables(designs);
    for (const DesignVariable &variable : result)
      if (!variable.is_range)
        throw ParameterError("a search requires ranges, but " + in_quotes(variable.name) + " has a list of values", where_variables,
                             "write Section/Name = a to b");
    return result;
  }

  std::vector<std::size_t> starts_of_search(const std::vector<double> &values)
  {
    std::vector<std::size_t> result(values.size());
    std::iota(result.begin(), result.end(), 0);
    std::stable_sort(result.begin(), result.end(), [&](const std::size_t a, const std::size_t b) { return values[a] < values[b]; });
    result.resize(std::min(most_searches, result.size()));
    return result;
  }

  std::string minimise(const SearchParameters                                          &parameters,
                       const SearchPoint                                               &start,
                       const std::function<std::optional<double>(const SearchPoint &)> &value)
  {
    std::exception_ptr                               error; // rethrown later, because NLopt would replace it by its own exception
    const std::function<double(const SearchPoint &)> guarded = [&](const SearchPoint &x) {
      try
        {
          if (const auto found = value(x))
            return *found;
        }
      catch (...)
        {
          error = std::current_exception();
        }
      throw nlopt::forced_stop();
    };
    nlopt::opt method(algorithm(parameters.method), static_cast<unsigned int>(start.size()));
    method.set_lower_bounds(0.);
    method.set_upper_bounds(1.);
    method.set_xtol_abs(parameters.smallest_step);
    method.set_initial_step(parameters.first_step);
    method.set_min_objective(
      [](const SearchPoint &x, SearchPoint &, void *f) { return (*static_cast<const std::function<double(const SearchPoint &)> *>(f))(x); },
      const_cast<std::function<double(const SearchPoint &)> *>(&guarded));
    SearchPoint x = start;
    double      smallest;
    try
      {
        method.optimize(x, smallest);
        return "the step is smaller than Search/Smallest step";
      }
    catch (const nlopt::forced_stop &)
      {
        if (error)
          std::rethrow_exception(error);
        return "";
      }
    catch (const nlopt::roundoff_limited &)
      {
        return "rounding errors exceed the change in the objective";
      }
    catch (const std::exception &failure)
      {
        return std::string("NLopt reports: ") + failure.what();
      }
  }

  FullOrder at_full_order(const Parameters &design, const double mu, Run &run)
  {
    run.progress.begin("Full order");
    Parameters parameters                     = design;
    parameters.study                          = &stability_study;
    parameters.solvers.complex_solver         = design.system ? design.solvers.complex_solver : ComplexSolver::krylov;
    parameters.operation.friction_coefficient = mu;
    Progress            silent;
    Run                 part(parameters, run, silent);
    const auto          given     = design.system ? std::optional(given_system(part)) : std::nullopt;
    const FrictionModes friction  = given ? modes_of_system(*given, part) : modes_of_mesh(mu, part);
    const auto         &lambda    = friction.modes.lambda;
    const auto         &residuals = friction.modes.residuals;
    const auto          leading   = std::max_element(lambda.begin(), lambda.end(), [](const auto &a, const auto &b) {
      return modal_quantities(a).divergence_rate < modal_quantities(b).divergence_rate;
    });
    const bool          has_mu    = !given || given->file.default_varied() == SystemParameter::friction;
    const FullOrder     result{has_mu ? std::optional(given ? given->value : mu) : std::nullopt,
                           lambda.size(),
                           friction.n_unstable(),
                           modal_quantities(*leading),
                           to_string(friction.labels[leading - lambda.begin()]),
                           *std::max_element(residuals.begin(), residuals.end())};

    run.progress.finish(text(counted(result.n_modes, "mode"), ", ", result.n_unstable, " unstable, largest divergence rate ",
                             decimal_text(100. * result.leading.divergence_rate), " % (", result.label, ")"));
    return result;
  }

  Table full_order_table(const std::vector<FullOrder> &rows)
  {
    using Row = FullOrder;
    return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 4},
                              {"modes", "-", &Row::n_modes},
                              {"unstable modes", "-", &Row::n_unstable},
                              {"label", "", &Row::label},
                              {"frequency", "Hz", [](const Row &row) { return row.leading.frequency; }, 3},
                              {"divergence rate", "%", [](const Row &row) { return 100. * row.leading.divergence_rate; }, 4},
                              {"residual", "-", &Row::residual, 1, true}},
                 rows);
  }

  bool is_robust(const SearchParameters &parameters)
  {
    switch (parameters.goal)
      {
        case SearchGoal::onset:
        case SearchGoal::divergence_rate:
          return false;
        case SearchGoal::probability:
        case SearchGoal::quantile:
          return true;
      }
    return false;
  }
} // namespace Squeal
