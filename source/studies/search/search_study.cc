#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/file_writing.h>
#include <squeal/studies/designs/design_work.h>

#include <nlopt.hpp>

#include <numeric>
#include <ostream>

namespace Squeal
{
  extern const Study stability_study;

  namespace
  {
    namespace fs = std::filesystem;

    using Point = std::vector<double>; ///< parts of the ranges, in the unit cube

    /// Value of a design that was refused or failed: methods turn back from it as from a wall.
    constexpr double refused_value = 1.;

    /// Searches that go on side by side, each from another start.
    constexpr std::size_t most_searches = 2;

    nlopt::algorithm algorithm(const SearchMethod method)
    {
      return method == SearchMethod::subplex ? nlopt::LN_SBPLX : method == SearchMethod::cobyla ? nlopt::LN_COBYLA : nlopt::LN_BOBYQA;
    }

    /// What a search makes small, of the order of one: −μ of the onset, or the largest divergence rate in per cent.
    double objective(const DesignResult &result, const Parameters &parameters)
    {
      if (result.outcome != DesignOutcome::solved)
        return parameters.search.goal == SearchGoal::onset ? 0. : 100. * refused_value;
      if (parameters.search.goal == SearchGoal::onset)
        return -(result.weak_onset ? result.weak_onset->friction_coefficient : parameters.sweep.friction_coefficients.last);
      return result.worst ? 100. * result.worst->divergence_rate : 0.;
    }

    /// Solves designs as they are asked for, and remembers them.
    class Evaluations
    {
    public:
      Evaluations(Scene &scene, Run &run)
        : scene(scene)
        , run(run)
        , variables(design_variables(run.parameters.designs))
        , store(checkpoint_folder(run.folder().name()), design_key(run, scene, {}), run.communicator)
      {
        for (const DesignVariable &variable : variables)
          plan.names.push_back(variable.name);
        // All at once: the rounds of the interrupted search come again one by one
        std::vector<int> designs(run.parameters.search.n_evaluations);
        std::iota(designs.begin(), designs.end(), 1);
        if (const std::size_t n_known = store.n_known(designs); n_known > 0)
          run.progress.note(text("  an interrupted search goes on: ", n_known, " designs are known"));
      }

      /// The objective at a point that is known.
      std::optional<double> value(const Point &point) const
      {
        const auto place = std::find(plan.designs.begin(), plan.designs.end(), values_at(point));
        return place == plan.designs.end() ? std::nullopt : std::optional(objective(results[place - plan.designs.begin()], run.parameters));
      }

      /// Solves those of some points that are not known side by side; false where the budget does not suffice.
      bool solve(const std::vector<Point> &points)
      {
        DesignWork work{plan, {}};
        for (const Point &point : points)
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
      std::vector<DesignResult>         results; ///< in the order of their numbers

    private:
      /// Values of the variables at a point.
      std::vector<std::string> values_at(const Point &point) const
      {
        std::vector<std::string> result;
        for (std::size_t v = 0; v < variables.size(); ++v)
          result.push_back(variables[v].at(std::clamp(point[v], 0., 1.)));
        return result;
      }

      void solve(const DesignWork &work)
      {
        // Other processes read the designs from a file: a study of these, without the values that it would refuse and nobody solves
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

    /// A point at which a method wants the objective; nothing if it has ended, and then why, for a sentence.
    struct NextStep
    {
      std::optional<Point> asked;
      std::string          end;
    };

    /// Runs a method from a start until it asks for a point that is not known. A method does the same each time, so that it goes on as soon
    /// as the point is solved, and several methods can have their points solved side by side.
    NextStep next_step(const Point &start, const Evaluations &evaluations)
    {
      const SearchParameters                    &parameters = evaluations.run.parameters.search;
      NextStep                                   result;
      const std::function<double(const Point &)> value = [&](const Point &x) {
        if (const auto known = evaluations.value(x))
          return *known;
        result.asked = x;
        throw nlopt::forced_stop();
      };
      nlopt::opt method(algorithm(parameters.method), static_cast<unsigned int>(start.size()));
      method.set_lower_bounds(0.);
      method.set_upper_bounds(1.);
      method.set_xtol_abs(parameters.smallest_step);
      method.set_initial_step(parameters.first_step);
      method.set_min_objective(
        [](const Point &x, Point &, void *f) { return (*static_cast<const std::function<double(const Point &)> *>(f))(x); },
        const_cast<std::function<double(const Point &)> *>(&value));
      Point  x = start;
      double smallest;
      try
        {
          method.optimize(x, smallest);
          result.end = "steps are smaller than Search/Smallest step";
        }
      catch (const nlopt::forced_stop &)
        {}
      catch (const nlopt::roundoff_limited &)
        {
          result.end = "rounding errors are larger than what steps change";
        }
      catch (const std::exception &error)
        {
          result.end = std::string("NLopt says: ") + error.what();
        }
      return result;
    }

    /// Searches side by side from some starts; returns why each ended.
    std::vector<std::string> search(const std::vector<Point> &starts, Evaluations &evaluations)
    {
      std::vector<std::string> ends(starts.size());
      for (;;)
        {
          std::vector<Point> asked;
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
              std::replace(ends.begin(), ends.end(), std::string(), std::string("Search/Evaluations is used up"));
              return ends;
            }
        }
    }

    // ------------------------------------------------------------------ at full order

    /// Modes of the best design at full order beside those of its sweep, at one friction coefficient.
    struct FullOrder
    {
      double          friction_coefficient;
      std::size_t     n_modes, n_unstable;
      ModalQuantities leading; ///< the mode that grows most, or is damped least
      std::string     label;
      double          residual; ///< largest
    };

    FullOrder at_full_order(const Parameters &design, const double mu, Run &run)
    {
      run.progress.begin("Full order");
      Parameters parameters                     = design;
      parameters.study                          = &stability_study;
      parameters.solvers.complex_solver         = ComplexSolver::krylov;
      parameters.operation.friction_coefficient = mu;
      Progress                silent;
      Run                     part(parameters, run, silent);
      Scene                   scene        = mesh_scene(part);
      const FrictionlessModes frictionless = damped_modes(scene, part);
      const FrictionModes     friction     = friction_modes(frictionless, mu, part);
      const auto             &lambda       = friction.modes.lambda;
      const auto             &residuals    = friction.modes.residuals;
      const auto              leading      = std::max_element(lambda.begin(), lambda.end(), [](const auto &a, const auto &b) {
        return modal_quantities(a).divergence_rate < modal_quantities(b).divergence_rate;
      });
      const FullOrder         result{mu,
                             lambda.size(),
                             friction.n_unstable(),
                             modal_quantities(*leading),
                             to_string(friction.labels[leading - lambda.begin()]),
                             *std::max_element(residuals.begin(), residuals.end())};

      run.progress.finish(text("mu = ", mu, ": ", result.n_modes, " modes, ", result.n_unstable, " unstable, ",
                               decimal_text(100. * result.leading.divergence_rate), " % at most (", result.label, ")"));
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

    /// The evaluations, and the best so far.
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

  /// `Study = search`: a design in the ranges of the variables that squeals as late or as little as can be found with a budget of designs:
  /// samples, then a method without derivatives from the best two of them, and the best of all at full order.
  static void run_search_study(Scene &scene, Run &run)
  {
    const Parameters       &parameters = run.parameters;
    const SearchParameters &options    = parameters.search;
    Evaluations             evaluations(scene, run);
    const std::size_t       dimension = evaluations.variables.size();

    std::vector<Point> points = sobol_points(options.n_samples, dimension, parameters.designs.seed);
    evaluations.solve(points);
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](const std::size_t a, const std::size_t b) { return evaluations.value(points[a]) < evaluations.value(points[b]); });
    std::vector<Point> starts;
    for (std::size_t i = 0; i < std::min(most_searches, order.size()); ++i)
      starts.push_back(points[order[i]]);
    const std::vector<std::string> ends = search(starts, evaluations);

    const DesignResult &winner =
      *std::min_element(evaluations.results.begin(), evaluations.results.end(),
                        [&](const DesignResult &a, const DesignResult &b) { return objective(a, parameters) < objective(b, parameters); });
    const auto design = parameters_of(run, evaluations.plan, winner.number);
    if (!design || winner.outcome != DesignOutcome::solved)
      throw SolverError("no design of the search could be solved: " + winner.reason, "search", "choose other ranges in Designs/Variables");
    std::vector<FullOrder> checked = {at_full_order(*design, parameters.sweep.friction_coefficients.last, run)};
    if (winner.worst && winner.worst->friction_coefficient != checked.front().friction_coefficient)
      checked.push_back(at_full_order(*design, winner.worst->friction_coefficient, run));

    // ----------------------------------------------------------------- results
    write_designs(evaluations.plan.names, evaluations.results, run);
    run.progress.note(text("  search: design ", winner.number, " of ", evaluations.results.size(), " is the best; ",
                           decimal_text(std::abs(objective(evaluations.results[order.front()], parameters))), " at the best sample, ",
                           decimal_text(std::abs(objective(winner, parameters))),
                           options.goal == SearchGoal::onset ? " there (mu of 0.01 %)" : " % there (largest divergence rate)"));
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

  extern const Study search_study = [] {
    const auto always = [](const Parameters &) { return "a search goes through the ranges of Designs/Variables"; };
    Study      study  = study_of_designs("search", run_search_study,
                                         {{"Designs/Plan", always}, {"Designs/File", always}, {"Designs/Number of designs", always}});
    study.own_parameters.push_back("Search/");
    study.check = [](const Parameters &p) {
      const std::vector<DesignVariable> variables = design_variables(p.designs);
      for (const DesignVariable &variable : variables)
        if (!variable.is_range)
          throw ParameterError("a search needs ranges, but " + in_quotes(variable.name) + " has a list of values",
                               "parameter Designs/Variables", "write Section/Name = a to b");
      check_ranges(p, variables);
    };
    return study;
  }();
} // namespace Squeal
