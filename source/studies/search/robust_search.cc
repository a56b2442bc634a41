// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/studies/designs/design_work.h>
#include <squeal/studies/robustness/robustness.h>
#include <squeal/studies/search/search_steps.h>
#include <squeal/studies/steps/imported_modes.h>

#include <cmath>
#include <limits>

namespace Squeal
{
  extern const Study robustness_study;

  namespace
  {
    /// Minimum number of initial designs, which are used to detect terms with proportional coefficients and to train the basis.
    constexpr std::size_t fewest_first_designs = 4;

    /// Values of the variables of a design.
    using DesignValues = std::vector<std::string>;

    /// Access to the designs and samples of a mesh or of a system file.
    struct DesignSpace
    {
      std::vector<std::string>                                           pins; ///< volumes of pins that may have individual values
      std::function<Parameters(const DesignValues &)>                    design;
      std::function<Parameters(const SamplePlan &, int sample)>          sample;  ///< throws ParameterError for invalid values
      std::function<double(const Parameters &, const std::string &name)> nominal; ///< nominal value of a parameter
      std::function<SampledSystems(const SamplePlan &)>                  systems;
    };

    /// Summary of the modes in the band of a sample.
    struct SampleRate
    {
      double rate = std::numeric_limits<double>::infinity(); ///< largest divergence rate [-]; infinite without results within the tolerance
      bool   grows     = false;                              ///< at least one mode is unstable
      bool   undecided = true;                               ///< no results within the tolerance, or undecided but no unstable modes
    };

    SampleRate sample_rate(const SweepModel &model, const ChartPoint &point)
    {
      SampleRate result{-std::numeric_limits<double>::infinity(), false, false};
      for (const int j : model.in_band(point))
        {
          const bool is_neutral = point.verdicts[j] == Verdict::neutral; // divergence rates of neutral modes are rounding errors
          result.rate           = std::max(result.rate, is_neutral ? 0. : modal_quantities(point.lambda[j]).divergence_rate);
          result.grows          = result.grows || point.verdicts[j] == Verdict::unstable;
          result.undecided      = result.undecided || point.verdicts[j] == Verdict::undecided;
        }
      result.undecided = result.undecided && !result.grows;
      if (!std::isfinite(result.rate))
        result.rate = 0.; // the band contains no modes
      return result;
    }

    /// A design and the statistics of its samples.
    struct RobustDesign
    {
      DesignValues values;
      std::string  phase;
      Estimate     squeal;      ///< probability that a mode grows
      double       doubtful;    ///< fraction of undecided samples [-]
      double       quantile;    ///< quantile of the largest divergence rates of the samples [-]
      double       worst_error; ///< largest estimated error of λ in the step that solved the design [-]
      int          n_vectors;   ///< size of the basis
      int          worst;       ///< sample with the largest rate; −1 if no sample meets the tolerance

      /// Probability of squeal with undecided samples counted as squeal, so that the search does not favour undecided designs [%].
      double probability_of_doubt() const
      {
        return 100. * (squeal.value + doubtful);
      }

      double objective(const SearchGoal goal) const ///< [%]
      {
        return goal == SearchGoal::probability ? probability_of_doubt() : 100. * std::min(quantile, penalty_rate);
      }
    };

    RobustDesign judged(const DesignValues &values, const std::string &phase, const std::vector<SampleRate> &rates, const double part)
    {
      const int  n     = static_cast<int>(rates.size());
      const auto count = [&](bool SampleRate::*is) {
        return static_cast<int>(std::count_if(rates.begin(), rates.end(), [is](const SampleRate &rate) { return rate.*is; }));
      };
      RobustDesign result{
        values, phase, probability(count(&SampleRate::grows), n), static_cast<double>(count(&SampleRate::undecided)) / n, 0., 0., 0, -1};
      std::vector<double> sorted;
      for (int s = 0; s < n; ++s)
        {
          sorted.push_back(rates[s].rate);
          if (std::isfinite(rates[s].rate) && (result.worst < 0 || rates[s].rate > rates[result.worst].rate))
            result.worst = s;
        }
      std::sort(sorted.begin(), sorted.end());
      result.quantile = quantile(sorted, part);
      return result;
    }

    /// Evaluated designs and their common model.
    class RobustDesigns
    {
    public:
      RobustDesigns(const DesignSpace &space, Run &run)
        : variables(search_variables(run.parameters.designs))
        , space(space)
        , run(run)
        , inner(sample(run.parameters.robustness.seed))
      {
        check_distributions();
        begin();
      }

      /// Objective at a point; empty if the point is new and Search/Evaluations is reached.
      std::optional<double> value(const SearchPoint &point)
      {
        const DesignValues values = values_at(point);
        for (const RobustDesign &design : designs)
          if (design.values == values)
            return design.objective(goal());
        if (designs.size() == run.parameters.search.n_evaluations)
          return {};
        designs.push_back(solve(values, inner, "search", text("Design ", designs.size() + 1)));
        return designs.back().objective(goal());
      }

      std::size_t best() const
      {
        const auto smaller = [this](const RobustDesign &a, const RobustDesign &b) { return a.objective(goal()) < b.objective(goal()); };
        return std::min_element(designs.begin(), designs.end(), smaller) - designs.begin();
      }

      RobustDesign solve_again(const DesignValues &values, const SamplePlan &other)
      {
        return solve(values, other, "other samples", "Other samples");
      }

      /// Samples of the nominal model.
      SamplePlan sample(const unsigned int seed) const
      {
        RobustnessParameters options = run.parameters.robustness;
        options.seed                 = seed;
        options.has_indices          = false;
        options.n_onsets             = 0;
        return sample_plan(
          options, [this](const std::string &name) { return space.nominal(run.parameters, name); }, space.pins);
      }

      /// Samples of several designs: values of the variables, then uncertain numbers; percentages refer to the values of the design. Rows
      /// are ordered by sample, then by design.
      SamplePlan samples_of(const std::vector<DesignValues> &some, const SamplePlan &samples) const
      {
        SamplePlan result{{}, {}, 0, false};
        const auto n_variables = static_cast<Eigen::Index>(variables.size()), n_designs = static_cast<Eigen::Index>(some.size());
        const auto n_numbers = samples.values.cols();
        result.n_independent = samples.n() * static_cast<int>(n_designs);
        for (const DesignVariable &variable : variables)
          result.numbers.push_back({variable.name, variable.name, "", {}, false, where_variables});
        result.numbers.insert(result.numbers.end(), samples.numbers.begin(), samples.numbers.end());
        result.values.resize(result.n_independent, n_variables + n_numbers);
        for (Eigen::Index d = 0; d < n_designs; ++d)
          {
            Eigen::RowVectorXd values(n_variables), scales(n_numbers);
            for (Eigen::Index v = 0; v < n_variables; ++v)
              values[v] = *parse_number(some[d][v]);
            for (Eigen::Index j = 0; j < n_numbers; ++j)
              scales[j] = scale(some[d], samples.numbers[j]);
            for (Eigen::Index s = 0; s < samples.n(); ++s)
              result.values.row(s * n_designs + d) << values, samples.values.row(s).cwiseProduct(scales);
          }
        return result;
      }

      const std::vector<DesignVariable> variables;
      std::vector<SearchPoint>          starts; ///< points of the initial designs
      std::vector<RobustDesign>         designs;

    private:
      SearchGoal goal() const
      {
        return run.parameters.search.goal;
      }

      DesignValues values_at(const SearchPoint &point) const
      {
        DesignValues result;
        for (std::size_t v = 0; v < variables.size(); ++v)
          result.push_back(variables[v].at(std::clamp(point[v], 0., 1.)));
        return result;
      }

      /// Ratio of the nominal value of an uncertain number in a design to its nominal value in the parameter file; 1 for an absolute
      /// distribution.
      double scale(const DesignValues &design, const UncertainNumber &number) const
      {
        return number.is_relative ? nominal_in(design, number) / space.nominal(run.parameters, number.parameter) : 1.;
      }

      double nominal_in(const DesignValues &design, const UncertainNumber &number) const
      {
        return space.nominal(space.design(design), number.parameter);
      }

      void check_distributions() const
      {
        const DesignValues lowest = values_at(SearchPoint(variables.size(), 0.)), highest = values_at(SearchPoint(variables.size(), 1.));
        for (const UncertainNumber &number : inner.numbers)
          if (!number.is_relative && nominal_in(lowest, number) != nominal_in(highest, number))
            throw ParameterError(in_quotes(number.parameter) + " varies from design to design, but its distribution is absolute",
                                 number.where, "give the distribution in % of the nominal value");
        // Reject invalid samples at the ends of the ranges before the first solution
        for (const DesignValues &corner : {lowest, highest})
          {
            const SamplePlan samples = samples_of({corner}, inner);
            for (int s = 0; s < samples.n(); ++s)
              space.sample(samples, s);
          }
      }

      /// Builds the model and evaluates the initial designs.
      void begin()
      {
        const SearchParameters &search = run.parameters.search;
        const std::size_t       n      = std::max<std::size_t>(search.n_samples, fewest_first_designs);
        starts                         = sobol_points(n, variables.size(), run.parameters.designs.seed);
        std::vector<DesignValues> first;
        for (const SearchPoint &point : starts)
          first.push_back(values_at(point));
        const SamplePlan plan = samples_of(first, inner);
        systems.emplace(space.systems(plan));
        model = sample_model(*systems, 0, run);

        starts.resize(search.n_samples);
        std::vector<OperatingPoint> points;
        for (const OperatingPoint &point : systems->plan.regimes.front().points)
          if (static_cast<std::size_t>(point.line) % n < search.n_samples)
            points.push_back(point);
        std::vector<std::vector<SampleRate>> rates(search.n_samples, std::vector<SampleRate>(inner.n()));
        constexpr int                        n_training = 8;
        const ErrorControlledSweep           found      = solve_points(
                         *model, points, n_training, run.parameters.robustness.tolerance,
                         [&](const int i, ChartPoint &&point) {
            const auto row          = static_cast<std::size_t>(points[i].line);
            rates[row % n][row / n] = sample_rate(*model, point);
          },
                         "First designs");
        for (std::size_t d = 0; d < search.n_samples; ++d)
          {
            designs.push_back(judged(first[d], "sample", rates[d], search.quantile));
            designs.back().n_vectors   = model->reduced ? model->reduced->size() : 0;
            designs.back().worst_error = found.worst_error;
          }
      }

      RobustDesign solve(const DesignValues &values, const SamplePlan &samples, const std::string &phase, const std::string &step)
      {
        const SamplePlan            plan = samples_of({values}, samples);
        std::vector<OperatingPoint> points;
        for (int s = 0; s < plan.n(); ++s)
          points.push_back(systems->point(plan, s));
        std::vector<SampleRate>    rates(plan.n());
        const ErrorControlledSweep found = solve_points(
          *model, points, 0, run.parameters.robustness.tolerance,
          [&](const int i, ChartPoint &&point) { rates[i] = sample_rate(*model, point); }, step);
        RobustDesign result = judged(values, phase, rates, run.parameters.search.quantile);
        result.n_vectors    = model->reduced ? model->reduced->size() : 0;
        result.worst_error  = found.worst_error;
        return result;
      }

      const DesignSpace            &space;
      Run                          &run;
      const SamplePlan              inner; ///< samples of the nominal model
      std::optional<SampledSystems> systems;
      std::unique_ptr<SweepModel>   model;
    };

    // ---------------------------------------------------------------------- results

    std::string name_of_quantile(const SearchParameters &search)
    {
      return text("divergence rate at ", 100. * search.quantile, " % of the samples");
    }

    Column<RobustDesign> goal_column(const SearchGoal goal, const SearchParameters &search)
    {
      const std::string name = goal == SearchGoal::probability ? "probability of squeal or doubt" : name_of_quantile(search);
      return {name, "%", [goal](const RobustDesign &row) { return row.objective(goal); }, 4};
    }

    Columns<RobustDesign> columns_of_samples()
    {
      using Row = RobustDesign;
      return {{"probability of squeal", "%", [](const Row &row) { return 100. * row.squeal.value; }, 2},
              {"lower confidence limit", "%", [](const Row &row) { return 100. * row.squeal.lower; }, 2},
              {"upper confidence limit", "%", [](const Row &row) { return 100. * row.squeal.upper; }, 2},
              {"undecided samples", "%", [](const Row &row) { return 100. * row.doubtful; }, 2},
              {"basis vectors", "-", &Row::n_vectors},
              {"largest estimated error of lambda", "-", &Row::worst_error, 1, true}};
    }

    /// Designs in order of evaluation, with the objective and its best value so far.
    Table robust_search_table(const RobustDesigns &found, const SearchParameters &search)
    {
      using Row            = std::size_t; // index of a design
      const auto  &designs = found.designs;
      Columns<Row> columns = {{"design", "-", [](const Row &i) { return i + 1; }},
                              {"phase", "", [&](const Row &i) { return designs[i].phase; }}};
      const auto   add     = [&](const Column<RobustDesign> &column) {
        columns.push_back({column.name, column.unit, [&designs, column](const Row &i) { return column.value(designs[i]); }, column.digits,
                           column.scientific});
      };
      for (std::size_t v = 0; v < found.variables.size(); ++v)
        columns.push_back({found.variables[v].name, "", [&designs, v](const Row &i) { return designs[i].values[v]; }});
      for (const Column<RobustDesign> &column : columns_of_samples())
        add(column);
      const bool is_probability = search.goal == SearchGoal::probability;
      add(goal_column(is_probability ? SearchGoal::quantile : SearchGoal::probability, search));
      add(goal_column(search.goal, search));
      columns.push_back({"best " + columns.back().name, "%",
                         [&](const Row &last) {
                           double result = designs.front().objective(search.goal);
                           for (Row i = 1; i <= last; ++i)
                             result = std::min(result, designs[i].objective(search.goal));
                           return result;
                         },
                         4});
      std::vector<Row> rows;
      for (Row i = 0; i < designs.size(); ++i)
        rows.push_back(i);
      return Table(columns, rows);
    }

    /// The best design, evaluated with the samples of the search and with samples of another seed.
    Table best_design_table(const std::vector<std::pair<unsigned int, RobustDesign>> &by_seed, const SearchParameters &search)
    {
      using Row                                 = std::pair<unsigned int, RobustDesign>;
      Columns<Row>                      columns = {{"seed", "-", &Row::first}};
      std::vector<Column<RobustDesign>> all     = columns_of_samples();
      all.push_back(goal_column(SearchGoal::probability, search));
      all.push_back(goal_column(SearchGoal::quantile, search));
      for (const Column<RobustDesign> &column : all)
        columns.push_back(
          {column.name, column.unit, [column](const Row &row) { return column.value(row.second); }, column.digits, column.scientific});
      return Table(columns, by_seed);
    }

    void search_robustly(const DesignSpace &space, Run &run)
    {
      const SearchParameters &search = run.parameters.search;
      RobustDesigns           found(space, run);
      std::vector<double>     values;
      for (const RobustDesign &design : found.designs)
        values.push_back(design.objective(search.goal));
      std::vector<std::string> ends;
      for (const std::size_t start : starts_of_search(values))
        {
          const std::string end = minimise(search, found.starts[start], [&](const SearchPoint &point) { return found.value(point); });
          ends.push_back(text("    search from design ", start + 1, ": ", end.empty() ? "the limit Search/Evaluations is reached" : end));
        }

      const std::size_t  best   = found.best();
      const RobustDesign winner = found.designs[best];
      const unsigned int seed = run.parameters.robustness.seed, other_seed = seed + 1;
      const SamplePlan   other   = found.sample(other_seed);
      const RobustDesign checked = found.solve_again(winner.values, other);
      run.store_table("search", robust_search_table(found, search));
      run.write_table("best_design", best_design_table({{seed, winner}, {other_seed, checked}}, search));
      const SamplePlan of_best = found.samples_of({winner.values}, other);
      if (checked.worst >= 0)
        {
          const Parameters worst = space.sample(of_best, checked.worst);
          run.write_table("full_order", full_order_table({at_full_order(worst, worst.operation.friction_coefficient, run)}));
        }
      Parameters best_parameters = space.design(winner.values);
      best_parameters.study      = &robustness_study;
      write_parameter_file(best_parameters, "best.prm", run);
      run.count("designs", found.designs.size());
      run.count("samples of a design", other.n());
      run.count("basis vectors", checked.n_vectors);
      run.progress.note(text("  search: design ", best + 1, " of ", found.designs.size(), " is the best; ",
                             goal_column(search.goal, search).name, ": ", decimal_text(*std::min_element(values.begin(), values.end())),
                             " % for the best initial design, ", decimal_text(winner.objective(search.goal)), " % for this design, ",
                             decimal_text(checked.objective(search.goal)), " % with other samples"));
      for (const std::string &end : ends)
        run.progress.note(end);
      run.finish();
    }
  } // namespace

  void run_robust_search(Scene &scene, Run &run)
  {
    const Parameters        &parameters = run.parameters;
    const BodyTerms          bodies     = assemble_scene(scene, run);
    std::vector<std::string> names;
    for (const DesignVariable &variable : search_variables(parameters.designs))
      names.push_back(variable.name);
    search_robustly({alike_pins(scene, parameters), [&](const DesignValues &values) { return with_design(parameters, names, values); },
                     [&](const SamplePlan &plan, const int s) { return with_sample(parameters, plan, s); },
                     [](const Parameters &p, const std::string &name) { return nominal_value(p, name); },
                     [&](const SamplePlan &plan) { return sampled_scene(scene, bodies, plan, run); }},
                    run);
  }

  void run_robust_search_of_system(Run &run)
  {
    const Parameters                 &parameters = run.parameters;
    const std::vector<DesignVariable> variables  = search_variables(parameters.designs);
    const SystemFile                  file       = read_system(run);
    for (const DesignVariable &variable : variables)
      value_in(file, variable.name, parameters); // throws ParameterError if the file has no such parameter
    const auto design = [&](const DesignValues &values) {
      Parameters result  = parameters;
      result.system.file = std::filesystem::absolute(result.system.path()).string();
      for (std::size_t v = 0; v < variables.size(); ++v)
        result.system.values[variables[v].name] = *parse_number(values[v]);
      return result;
    };
    search_robustly({{},
                     design,
                     [&](const SamplePlan &plan, const int s) {
                       Parameters result = system_with_sample(parameters, plan, s);
                       file.values(result.system.values);
                       return result;
                     },
                     [&](const Parameters &p, const std::string &name) { return value_in(file, name, p); },
                     [&](const SamplePlan &plan) { return sampled_file(file, plan, run); }},
                    run);
  }
} // namespace Squeal
