// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/file_writing.h>
#include <squeal/studies/designs/design_work.h>
#include <squeal/studies/search/search_steps.h>

#include <numeric>
#include <ostream>

namespace Squeal
{
  namespace
  {
    namespace fs = std::filesystem;

    /// Objective to be minimised, of the order of one: −μ of the onset, or the largest divergence rate in per cent.
    double objective(const DesignResult &result, const Parameters &parameters)
    {
      if (result.outcome != DesignOutcome::solved)
        return parameters.search.goal == SearchGoal::onset ? 0. : 100. * penalty_rate;
      if (parameters.search.goal == SearchGoal::onset)
        return -(result.weak_onset ? result.weak_onset->friction_coefficient : parameters.sweep.friction_coefficients.last);
      return result.worst ? 100. * result.worst->divergence_rate : 0.;
    }

    /// Solves designs on demand and stores them.
    class Evaluations
    {
    public:
      Evaluations(Scene &scene, Run &run)
        : scene(scene)
        , run(run)
        , variables(design_variables(run.parameters.designs))
        , store(checkpoint_folder(run.folder().name()), design_key(run, scene, {}), run.communicator)
      {
        plan.where_names = where_variables;
        for (const DesignVariable &variable : variables)
          plan.names.push_back(variable.name);
        // Count the results of all designs now, because the search requests its designs step by step
        std::vector<int> designs(run.parameters.search.n_evaluations);
        std::iota(designs.begin(), designs.end(), 1);
        if (const std::size_t n_known = store.n_known(designs); n_known > 0)
          run.progress.note(text("  continuing an interrupted search: ", counted(n_known, "design is", "designs are"), " finished"));
      }

      /// Objective at an evaluated point; empty for other points.
      std::optional<double> value(const SearchPoint &point) const
      {
        const auto place = std::find(plan.designs.begin(), plan.designs.end(), values_at(point));
        return place == plan.designs.end() ? std::nullopt : std::optional(objective(results[place - plan.designs.begin()], run.parameters));
      }

      /// Solves new points concurrently; false, without solving, if this would exceed Search/Evaluations.
      bool solve(const std::vector<SearchPoint> &points)
      {
        DesignWork work{plan, {}};
        for (const SearchPoint &point : points)
          if (const auto values = values_at(point);
              std::find(work.plan.designs.begin(), work.plan.designs.end(), values) == work.plan.designs.end())
            {
              work.plan.designs.push_back(values);
              work.designs.push_back(static_cast<int>(work.plan.designs.size()));
            }
        if (work.plan.designs.size() > run.parameters.search.n_evaluations)
          return false;
        plan = work.plan;
        if (!work.designs.empty())
          solve(work);
        return true;
      }

      Scene                            &scene;
      Run                              &run;
      const std::vector<DesignVariable> variables;
      const DesignStore                 store;
      DesignPlan                        plan;
      std::vector<DesignResult>         results; ///< results in the order of the design numbers

    private:
      std::vector<std::string> values_at(const SearchPoint &point) const
      {
        std::vector<std::string> result;
        for (std::size_t v = 0; v < variables.size(); ++v)
          result.push_back(variables[v].at(std::clamp(point[v], 0., 1.)));
        return result;
      }

      void solve(const DesignWork &work)
      {
        // Worker processes read the designs from a file, in which rejected designs have no values
        const fs::path file   = store.folder / "designs.csv";
        DesignPlan     listed = plan;
        for (std::size_t i = 0; i < plan.designs.size(); ++i)
          if (!parameters_of(run, plan, static_cast<int>(i + 1)))
            listed.designs[i].assign(plan.names.size(), "");
        if (run.is_root)
          replace_file(file, as_csv(listed));
        std::vector<std::string> arguments = run.options.again;
        for (const std::string &text :
             {std::string("Study=geometry"), std::string("Designs/Plan=file"), "Designs/File=" + fs::absolute(file).string()})
          arguments.push_back("--set=" + text);
        for (DesignResult &result : solve_all(scene, run, work, store, arguments))
          results.push_back(std::move(result));
      }
    };

    /// Next point at which a method needs the objective, or the reason why the method has ended.
    struct NextStep
    {
      std::optional<SearchPoint> asked;
      std::string                end;
    };

    /// Runs a method from a starting point until it needs the objective at a new point. Because methods are deterministic, the search can be
    /// repeated after the point has been solved, and points of several searches are solved concurrently.
    NextStep next_step(const SearchPoint &start, const Evaluations &evaluations)
    {
      NextStep result;
      result.end = minimise(evaluations.run.parameters.search, start, [&](const SearchPoint &x) {
        const std::optional<double> known = evaluations.value(x);
        if (!known)
          result.asked = x;
        return known;
      });
      return result;
    }

    /// Runs searches from several starting points concurrently; returns the reasons for termination.
    std::vector<std::string> search(const std::vector<SearchPoint> &starts, Evaluations &evaluations)
    {
      std::vector<std::string> ends(starts.size());
      for (;;)
        {
          std::vector<SearchPoint> asked;
          for (std::size_t i = 0; i < starts.size(); ++i)
            if (ends[i].empty())
              {
                const NextStep next = next_step(starts[i], evaluations);
                ends[i]             = next.end;
                if (next.asked)
                  asked.push_back(*next.asked);
              }
          if (asked.empty())
            return ends;
          if (!evaluations.solve(asked))
            {
              std::replace(ends.begin(), ends.end(), std::string(), std::string("the limit Search/Evaluations is reached"));
              return ends;
            }
        }
    }

    /// Table of all evaluations, each with the best value so far.
    Table search_table(const Evaluations &evaluations, const std::size_t n_samples)
    {
      struct Row
      {
        const DesignResult *design;
        std::string         phase;
        double              value, best;
      };
      const Parameters &parameters = evaluations.run.parameters;
      const double      sign       = parameters.search.goal == SearchGoal::onset ? -1. : 1.;
      std::vector<Row>  rows;
      for (std::size_t i = 0; i < evaluations.results.size(); ++i)
        {
          const double value = objective(evaluations.results[i], parameters);
          rows.push_back({&evaluations.results[i], i < n_samples ? "sample" : "search", sign * value,
                          sign * (rows.empty() ? value : std::min(value, sign * rows.back().best))});
        }
      const bool   is_onset = parameters.search.goal == SearchGoal::onset;
      const char  *name = is_onset ? "mu of 0.01 %" : "largest divergence rate", *unit = is_onset ? "-" : "%";
      Columns<Row> columns = {{"design", "-", [](const Row &row) { return row.design->number; }}, {"phase", "", &Row::phase}};
      for (std::size_t v = 0; v < evaluations.variables.size(); ++v)
        columns.push_back({evaluations.variables[v].name, "", [v](const Row &row) { return row.design->values[v]; }});
      columns.push_back(
        {name, unit, [](const Row &row) { return row.design->outcome == DesignOutcome::solved ? Entry(row.value) : Entry(); }, 5});
      columns.push_back({std::string("best ") + name, unit, &Row::best, 5});
      return Table(columns, rows);
    }
  } // namespace

  /// `Study = search`: finds a quiet design within the ranges of the variables with a limited number of evaluations. Evaluates samples, runs
  /// a derivative-free method from the two best samples, and solves the best design at full order.
  static void run_search_study(Scene &scene, Run &run)
  {
    if (is_robust(run.parameters.search))
      return run_robust_search(scene, run);
    const Parameters       &parameters = run.parameters;
    const SearchParameters &options    = parameters.search;
    Evaluations             evaluations(scene, run);
    const std::size_t       dimension = evaluations.variables.size();

    std::vector<SearchPoint> points = sobol_points(options.n_samples, dimension, parameters.designs.seed);
    evaluations.solve(points);
    std::vector<double> values;
    for (const SearchPoint &point : points)
      values.push_back(*evaluations.value(point));
    const std::vector<std::size_t> order = starts_of_search(values);
    std::vector<SearchPoint>       starts;
    for (const std::size_t i : order)
      starts.push_back(points[i]);
    const std::vector<std::string> ends = search(starts, evaluations);

    // Designs without a result come last, even if a solved design has a worse objective
    const auto rank = [&](const DesignResult &row) { return std::pair(row.outcome != DesignOutcome::solved, objective(row, parameters)); };
    const DesignResult &winner = *std::min_element(evaluations.results.begin(), evaluations.results.end(),
                                                   [&](const DesignResult &a, const DesignResult &b) { return rank(a) < rank(b); });
    if (winner.outcome != DesignOutcome::solved)
      throw SolverError("no design of the search could be solved; one reason: " + winner.reason, "search",
                        "remove the cause, or choose other ranges in Designs/Variables");
    const auto             design  = parameters_of(run, evaluations.plan, winner.number);
    std::vector<FullOrder> checked = {at_full_order(*design, parameters.sweep.friction_coefficients.last, run)};
    if (winner.worst && winner.worst->friction_coefficient != parameters.sweep.friction_coefficients.last)
      checked.push_back(at_full_order(*design, winner.worst->friction_coefficient, run));

    // ----------------------------------------------------------------- results
    write_designs(evaluations.plan.names, evaluations.results, run);
    run.progress.note(text("  search: design ", winner.number, " of ", evaluations.results.size(),
                           " is the best: ", decimal_text(std::abs(objective(evaluations.results[order.front()], parameters))),
                           " for the best sample, ", decimal_text(std::abs(objective(winner, parameters))),
                           options.goal == SearchGoal::onset ? " for this design (mu at a divergence rate of 0.01 %)" :
                                                               " for this design (largest divergence rate in %)"));
    for (std::size_t i = 0; i < ends.size(); ++i)
      run.progress.note(text("    from design ", order[i] + 1, ": ", ends[i]));
    run.store_table("search", search_table(evaluations, points.size()));
    run.write_table("full_order", full_order_table(checked));
    write_parameter_file(*design, "best.prm", run);
    run.finish([&] {
      if (run.is_root)
        fs::remove_all(evaluations.store.folder);
    });
  }

  /// `Study = search` for a system file, with goals that depend on uncertain parameters.
  static void run_search_of_system(Run &run)
  {
    if (!is_robust(run.parameters.search))
      throw ParameterError("the goal " + in_quotes(to_string(run.parameters.search.goal)) + " is not available for system files",
                           "parameter Search/Goal", "set it to probability or quantile, or leave System empty");
    run_robust_search_of_system(run);
  }

  extern const Study search_study = [] {
    const auto always = [](const Parameters &) { return "a search uses the ranges of Designs/Variables"; };
    const auto robust = [](const Parameters &p) { return unless(is_robust(p.search), "only for Search/Goal = probability or quantile"); };
    const auto swept  = [](const Parameters &p) {
      return is_robust(p.search) ? "each sample is solved at one friction coefficient" : as_in_general;
    };
    Study study = study_of_designs(
      "search", run_search_study,
      {{"Designs/Plan", always},
       {"Designs/File", always},
       {"Designs/Number of designs", always},
       {"Designs/Processes",
        [](const Parameters &p) { return is_robust(p.search) ? "all designs are solved with one reduced model" : as_in_general; }},
       {"Operation/Friction coefficient", [](const Parameters &p) { return is_robust(p.search) ? nullptr : as_in_general; }},
       {"Search/Quantile", robust},
       {"Robustness/", robust},
       {"Sweep/", swept}});
    study.own_parameters.push_back("Search/");
    study.own_parameters.push_back("Robustness/");
    study.check = [](const Parameters &p) {
      check_ranges(p, search_variables(p.designs));
      if (!is_robust(p.search))
        return;
      p.robustness.parsed_correlations();
      if (p.needs_steady_sliding())
        throw ParameterError("the goal " + in_quotes(to_string(p.search.goal)) + " is not available with steady sliding",
                             "parameter Steady sliding/Contact state", "set it to equal load, or set Search/Goal = divergence rate");
    };
    study.run_of_system = run_search_of_system;
    return study;
  }();
} // namespace Squeal
