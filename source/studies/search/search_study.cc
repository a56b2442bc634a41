#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/file_writing.h>
#include <squeal/output/chart_checkpoint.h>
#include <squeal/studies/designs/design_check.h>
#include <squeal/studies/designs/design_work.h>
#include <squeal/studies/steps/friction_modes.h>

#include <nlopt.hpp>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <numeric>
#include <ostream>
#include <thread>

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

      /// Values of the objective at some points, new ones solved side by side; none where the budget does not suffice.
      std::vector<double> solve(const std::vector<Point> &points)
      {
        std::vector<std::vector<std::string>> wanted;
        for (const Point &point : points)
          {
            wanted.emplace_back();
            for (std::size_t v = 0; v < variables.size(); ++v)
              wanted.back().push_back(variables[v].at(std::clamp(point[v], 0., 1.)));
          }
        DesignWork work{plan, {}};
        for (const auto &values : wanted)
          if (std::find(work.plan.designs.begin(), work.plan.designs.end(), values) == work.plan.designs.end())
            {
              work.plan.designs.push_back(values);
              work.designs.push_back(static_cast<int>(work.plan.designs.size()));
            }
        if (work.designs.size() > left())
          return {};
        plan = work.plan;
        if (!work.designs.empty())
          solve(work);
        std::vector<double> result;
        for (const auto &values : wanted)
          result.push_back(
            objective(results[std::find(plan.designs.begin(), plan.designs.end(), values) - plan.designs.begin()], run.parameters));
        return result;
      }

      /// Evaluations that the budget still has.
      std::size_t left() const
      {
        return run.parameters.search.n_evaluations - std::min<std::size_t>(run.parameters.search.n_evaluations, plan.designs.size());
      }

      void forget() const
      {
        if (run.is_root)
          store.remove();
      }

      Scene                            &scene;
      Run                              &run;
      const std::vector<DesignVariable> variables;
      const DesignStore                 store;
      DesignPlan                        plan;
      std::vector<DesignResult>         results; ///< in the order of their numbers

    private:
      void solve(const DesignWork &work)
      {
        // Other processes read the designs from a file: a study of these, without the values that it would refuse and nobody solves
        const fs::path file   = store.folder / "designs.csv";
        DesignPlan     listed = plan;
        std::string    reason;
        for (std::size_t i = 0; i < plan.designs.size(); ++i)
          if (!parameters_of(run, plan, static_cast<int>(i + 1), reason))
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

    /**
     * Methods of NLopt that ask for one point at a time, several of them side by side: each runs in a thread of its own, and waits
     * until all have asked, so that the points of a round are solved together. The rounds are the same in every run.
     */
    class Rounds
    {
    public:
      explicit Rounds(const std::size_t n)
        : asked(n)
        , answers(n)
        , is_active(n, true)
      {}

      /// Of a method: the value at a point.
      double ask(const std::size_t who, const Point &point)
      {
        std::unique_lock<std::mutex> lock(mutex);
        asked[who] = point;
        changed.notify_all();
        changed.wait(lock, [&] { return answers[who].has_value() || is_over; });
        if (!answers[who])
          throw nlopt::forced_stop();
        const double value = *answers[who];
        answers[who].reset();
        return value;
      }

      /// Of a method that has ended.
      void leave(const std::size_t who)
      {
        const std::lock_guard<std::mutex> lock(mutex);
        is_active[who] = false;
        changed.notify_all();
      }

      /// Answers until all methods have ended or the budget has.
      void answer(Evaluations &evaluations)
      {
        for (;;)
          {
            std::vector<std::size_t> who;
            std::vector<Point>       points;
            {
              std::unique_lock<std::mutex> lock(mutex);
              changed.wait(lock, [&] {
                for (std::size_t i = 0; i < asked.size(); ++i)
                  if (is_active[i] && !asked[i])
                    return false;
                return true;
              });
              for (std::size_t i = 0; i < asked.size(); ++i)
                if (is_active[i])
                  {
                    who.push_back(i);
                    points.push_back(*asked[i]);
                    asked[i].reset();
                  }
            }
            if (who.empty())
              return;
            std::vector<double> values;
            try
              {
                values = evaluations.solve(points);
              }
            catch (...)
              {
                end();
                throw;
              }
            if (values.empty())
              {
                end();
                return;
              }
            const std::lock_guard<std::mutex> lock(mutex);
            for (std::size_t i = 0; i < who.size(); ++i)
              answers[who[i]] = values[i];
            changed.notify_all();
          }
      }

    private:
      void end()
      {
        const std::lock_guard<std::mutex> lock(mutex);
        is_over = true;
        changed.notify_all();
      }

      std::mutex                         mutex;
      std::condition_variable            changed;
      std::vector<std::optional<Point>>  asked;
      std::vector<std::optional<double>> answers;
      std::vector<bool>                  is_active;
      bool                               is_over = false;
    };

    /// Why a search ended, for its table and a sentence.
    std::string search_from(const Point &start, const SearchParameters &parameters, const std::function<double(const Point &)> &value)
    {
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
        }
      catch (const nlopt::forced_stop &)
        {
          return "Search/Evaluations is used up";
        }
      catch (const nlopt::roundoff_limited &)
        {
          return "rounding errors are larger than what steps change";
        }
      catch (const std::exception &error)
        {
          return std::string("NLopt says: ") + error.what();
        }
      return "steps are smaller than Search/Smallest step";
    }

    /// Searches side by side from some starts; returns why each ended.
    std::vector<std::string> search(const std::vector<Point> &starts, Evaluations &evaluations)
    {
      Rounds                   rounds(starts.size());
      std::vector<std::string> ends(starts.size(), "");
      std::vector<std::thread> methods;
      for (std::size_t i = 0; i < starts.size(); ++i)
        methods.emplace_back([&, i] {
          ends[i] = search_from(starts[i], evaluations.run.parameters.search, [&, i](const Point &x) { return rounds.ask(i, x); });
          rounds.leave(i);
        });
      const auto join_all = [&] {
        for (std::thread &method : methods)
          method.join();
      };
      try
        {
          rounds.answer(evaluations);
        }
      catch (...)
        {
          join_all();
          throw;
        }
      join_all();
      return ends;
    }

    /// Number of the best design so far, from zero on.
    std::size_t best_of(const std::vector<DesignResult> &results, const Parameters &parameters)
    {
      return std::min_element(
               results.begin(), results.end(),
               [&](const DesignResult &a, const DesignResult &b) { return objective(a, parameters) < objective(b, parameters); }) -
             results.begin();
    }

    // ------------------------------------------------------------------ at full order

    /// Modes of the best design at full order beside those of its sweep, at one friction coefficient.
    struct FullOrder
    {
      double          friction_coefficient;
      std::size_t     n_modes = 0, n_unstable = 0;
      ModalQuantities leading{}; ///< the mode that grows most, or is damped least
      std::string     label;
      double          residual = 0.; ///< largest
    };

    FullOrder at_full_order(const Parameters &design, const double mu, Run &run)
    {
      run.progress.begin("Full order");
      Parameters parameters                     = design;
      parameters.study                          = &stability_study;
      parameters.solvers.complex_solver         = ComplexSolver::krylov;
      parameters.operation.friction_coefficient = mu;
      Progress          silent;
      Run               part(parameters, run, silent);
      Scene             scene        = mesh_scene(part);
      FrictionlessModes frictionless = frictionless_modes(linearised_scene(scene, part), part);
      add_modal_damping(frictionless, parameters);
      const FrictionModes friction = friction_modes(frictionless, mu, part);
      FullOrder           result{mu, friction.modes.lambda.size(), friction.n_unstable(), {}, {}, 0.};
      bool                is_first = true;
      for (std::size_t j = 0; j < friction.modes.lambda.size(); ++j)
        {
          const ModalQuantities quantities = modal_quantities(friction.modes.lambda[j]);
          if (is_first || quantities.divergence_rate > result.leading.divergence_rate)
            {
              result.leading = quantities;
              result.label   = to_string(friction.labels[j]);
            }
          is_first        = false;
          result.residual = std::max(result.residual, friction.modes.residuals[j]);
        }
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
        {name, unit, [](const Row &row) { return row.design->outcome == DesignOutcome::solved ? Cell(row.value) : Cell(); }, 5});
      columns.push_back({std::string("best ") + name, unit, &Row::best, 5});
      return Table(columns, rows);
    }
  } // namespace

  /**
   * `Study = search`: a design in the ranges of the variables that squeals as late or as little as can be found with a budget of designs:
   * samples, then a method without derivatives from the best two of them, and the best of all at full order.
   */
  static void run_search_study(Scene &scene, Run &run)
  {
    const Parameters       &parameters = run.parameters;
    const SearchParameters &options    = parameters.search;
    Evaluations             evaluations(scene, run);
    const std::size_t       dimension = evaluations.variables.size();

    std::vector<Point>        points = sobol_points(options.n_samples, dimension, parameters.designs.seed);
    const std::vector<double> values = evaluations.solve(points);
    std::vector<std::size_t>  order(values.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](const std::size_t a, const std::size_t b) { return values[a] < values[b]; });
    std::vector<Point> starts;
    for (std::size_t i = 0; i < std::min(most_searches, order.size()); ++i)
      starts.push_back(points[order[i]]);
    const std::vector<std::string> ends = search(starts, evaluations);

    const std::size_t   best   = best_of(evaluations.results, parameters);
    const DesignResult &winner = evaluations.results[best];
    std::string         reason;
    const auto          design = parameters_of(run, evaluations.plan, winner.number, reason);
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
    run.store_table("search", search_table(evaluations, values.size()));
    run.write_table("full_order", full_order_table(checked));
    write_parameter_file(*design, "best.prm", run);
    run.finish([&] { evaluations.forget(); });
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
