// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/parameters/csv_file.h>
#include <squeal/parameters/design_plan.h>
#include <squeal/studies/designs/design_work.h>
#include <squeal/studies/robustness/robustness.h>
#include <squeal/studies/updating/least_squares.h>
#include <squeal/studies/updating/updating.h>

#include <boost/algorithm/string/join.hpp>

#include <cmath>
#include <filesystem>
#include <map>

namespace Squeal
{
  namespace
  {
    /// A measured number and its computed values before and after the fit.
    struct FittedNumber
    {
      const MeasuredMode *mode;
      bool                is_damping; ///< true: a damping ratio; false: a frequency
      double              start = 0., updated = 0.;
      Counterpart         partner = {}; ///< counterpart after the fit

      const Measured &measured() const
      {
        return is_damping ? *mode->damping_ratio : mode->frequency;
      }

      double of(const Counterpart &computed) const
      {
        return is_damping ? computed.damping_ratio : computed.frequency;
      }

      double residual(const double computed) const
      {
        return (computed - measured().value) / measured().deviation;
      }

      /// Value in Hz or %.
      double shown(const double value) const
      {
        return is_damping ? 100. * value : value;
      }
    };

    std::vector<FittedNumber> numbers_of_modes(const MeasuredModes &measured)
    {
      std::vector<FittedNumber> result;
      for (const MeasuredMode &mode : measured.modes)
        {
          result.push_back({&mode, false});
          if (mode.damping_ratio)
            result.push_back({&mode, true});
        }
      return result;
    }

    /// Residuals of all measured numbers over the unit cube of the parameters.
    class UpdatingProblem
    {
    public:
      UpdatingProblem(const std::vector<FittedParameter> &parameters, const MeasuredModes &measured, ModesAtValues modes_at, Run &run)
        : parameters(parameters)
        , measured(measured)
        , numbers(numbers_of_modes(measured))
        , modes_at(std::move(modes_at))
        , run(run)
      {}

      std::vector<double> values_at(const std::vector<double> &x) const
      {
        std::vector<double> result;
        for (std::size_t p = 0; p < parameters.size(); ++p)
          result.push_back(parameters[p].at(x[p]));
        return result;
      }

      /// Residuals and computed numbers.
      std::pair<Residuals, std::vector<Counterpart>> evaluate(const std::vector<double> &x)
      {
        const std::vector<ComputedMode> modes = modes_at(values_at(x));
        const auto                      m = static_cast<Eigen::Index>(numbers.size()), n = static_cast<Eigen::Index>(parameters.size());
        Residuals                       result{Eigen::VectorXd(m), DenseMatrix(m, n)};
        std::vector<Counterpart>        computed;
        for (Eigen::Index i = 0; i < m; ++i)
          {
            const FittedNumber       &number = numbers[i];
            const Counterpart         found  = counterpart_of(*number.mode, measured, modes);
            const std::vector<double> rates  = number.is_damping ? found.damping_ratio_rates : found.frequency_rates;
            computed.push_back(found);
            result.r[i] = number.residual(number.of(found));
            for (Eigen::Index p = 0; p < n; ++p)
              result.J(i, p) = rates[p] * (parameters[p].upper - parameters[p].lower) / number.measured().deviation;
          }
        computed_at[x] = computed;
        ++n_evaluations;
        run.progress.update(text("evaluation ", n_evaluations, ", residuals ", root_mean_square(result.r), " rms"));
        return {result, computed};
      }

      /// Residuals; empty if the modes cannot be computed or paired.
      std::optional<Residuals> try_to_evaluate(const std::vector<double> &x)
      {
        try
          {
            return evaluate(x).first;
          }
        catch (const Error &error)
          {
            why_failed = error.reason;
            return {};
          }
      }

      static double root_mean_square(const Eigen::VectorXd &r)
      {
        return r.norm() / std::sqrt(static_cast<double>(r.size()));
      }

      const std::vector<FittedParameter>                     &parameters;
      const MeasuredModes                                    &measured;
      std::vector<FittedNumber>                               numbers;
      const ModesAtValues                                     modes_at;
      Run                                                    &run;
      int                                                     n_evaluations = 0;
      std::map<std::vector<double>, std::vector<Counterpart>> computed_at; ///< computed counterparts at each point
      std::string why_failed; ///< error of the last failed evaluation; empty if no evaluation has failed
    };

    // --------------------------------------------------------------------- results

    /// Fitted value, standard deviation and status of a parameter.
    struct UpdatedParameter
    {
      const FittedParameter *parameter;
      double                 value;
      std::optional<double>  deviation;
      std::string            status;
    };

    std::vector<UpdatedParameter> updated_parameters(const UpdatingProblem &problem, const Fit &fit, const FitStatistics &statistics)
    {
      const std::vector<double>     values = problem.values_at(fit.x);
      std::vector<UpdatedParameter> result;
      for (std::size_t p = 0; p < values.size(); ++p)
        {
          const FittedParameter &parameter = problem.parameters[p];
          UpdatedParameter       row{&parameter, values[p], {}, "determined"};
          const bool             is_undetermined =
            std::any_of(statistics.undetermined.begin(), statistics.undetermined.end(),
                        [p](const std::vector<std::size_t> &group) { return std::find(group.begin(), group.end(), p) != group.end(); });
          if (statistics.is_at_limit[p])
            row.status = fit.x[p] < 0.5 ? "at lower limit" : "at upper limit";
          else if (is_undetermined)
            row.status = "not determined";
          if (const auto &deviation = statistics.deviations[p])
            row.deviation = *deviation * (parameter.upper - parameter.lower);
          result.push_back(row);
        }
      return result;
    }

    Table updated_table(const std::vector<UpdatedParameter> &rows)
    {
      using Row = UpdatedParameter;
      return Table(Columns<Row>{{"parameter", "", [](const Row &row) { return row.parameter->name; }},
                                {"start", "", [](const Row &row) { return row.parameter->start; }, 6, true},
                                {"value", "", &Row::value, 6, true},
                                {"change", "%",
                                 [](const Row &row) {
                                   const double start = row.parameter->start;
                                   return start == 0. ? Entry() : Entry(100. * (row.value - start) / std::abs(start));
                                 },
                                 2},
                                {"standard deviation", "", [](const Row &row) { return Entry(row.deviation); }, 3, true},
                                {"lower limit", "", [](const Row &row) { return row.parameter->lower; }, 4, true},
                                {"upper limit", "", [](const Row &row) { return row.parameter->upper; }, 4, true},
                                {"status", "", &Row::status}},
                   rows);
    }

    Table correlation_table(const std::vector<FittedParameter> &parameters, const FitStatistics &statistics)
    {
      struct Row
      {
        std::size_t first, second;
      };
      std::vector<Row> rows;
      for (std::size_t i = 0; i < parameters.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
          if (statistics.deviations[i] && statistics.deviations[j])
            rows.push_back({j, i});
      return Table(Columns<Row>{{"parameter", "", [&](const Row &row) { return parameters[row.first].name; }},
                                {"other parameter", "", [&](const Row &row) { return parameters[row.second].name; }},
                                {"correlation", "-",
                                 [&](const Row &row) {
                                   return statistics.correlations(static_cast<Eigen::Index>(row.first),
                                                                  static_cast<Eigen::Index>(row.second));
                                 }}},
                   rows);
    }

    Table fit_table(const std::vector<FittedNumber> &numbers)
    {
      using Row             = FittedNumber;
      const auto difference = [](double Row::*value) {
        return [value](const Row &row) { return row.is_damping ? Entry() : Entry(100. * (row.*value / row.measured().value - 1.)); };
      };
      return Table(Columns<Row>{{"state", "", [](const Row &row) { return row.mode->state; }},
                                {"label", "", [](const Row &row) { return row.mode->label; }},
                                {"member", "", [](const Row &row) { return row.mode->member; }},
                                {"quantity", "", [](const Row &row) { return row.is_damping ? "damping ratio" : "frequency"; }},
                                {"unit", "", [](const Row &row) { return row.is_damping ? "%" : "Hz"; }},
                                {"measured", "", [](const Row &row) { return row.shown(row.measured().value); }, 3},
                                {"standard deviation", "", [](const Row &row) { return row.shown(row.measured().deviation); }, 3},
                                {"start", "", [](const Row &row) { return row.shown(row.start); }, 3},
                                {"updated", "", [](const Row &row) { return row.shown(row.updated); }, 3},
                                {"difference of the start", "%", difference(&Row::start), 3},
                                {"difference after the fit", "%", difference(&Row::updated), 3},
                                {"residual at start", "-", [](const Row &row) { return row.residual(row.start); }, 3},
                                {"residual after the fit", "-", [](const Row &row) { return row.residual(row.updated); }, 3},
                                {"computed label", "", [](const Row &row) { return row.partner.label; }},
                                {"MAC", "-", [](const Row &row) { return Entry(row.partner.mac); }, 3}},
                   numbers);
    }

    /// RMS and largest relative frequency differences.
    struct Agreement
    {
      double              rms = 0., largest = 0.; ///< [%]
      const MeasuredMode *worst = nullptr;
    };

    Agreement frequency_agreement(const std::vector<FittedNumber> &numbers, double FittedNumber::*value)
    {
      Agreement result;
      int       n = 0;
      for (const FittedNumber &number : numbers)
        if (!number.is_damping)
          {
            const double difference = 100. * (number.*value / number.measured().value - 1.);
            result.rms += difference * difference;
            ++n;
            if (result.worst == nullptr || std::abs(difference) > std::abs(result.largest))
              {
                result.largest = difference;
                result.worst   = number.mode;
              }
          }
      result.rms = std::sqrt(result.rms / n);
      return result;
    }

    void warn_of_limits_and_undetermined(const UpdatingProblem               &problem,
                                         const std::vector<UpdatedParameter> &updated,
                                         const FitStatistics                 &statistics,
                                         Run                                 &run)
    {
      for (const UpdatedParameter &row : updated)
        if (row.status.rfind("at ", 0) == 0)
          run.warn(text("status of the fitted ", row.parameter->name, ": ", row.status, " ", exact_text(row.value),
                        "; widen its range, or correct other properties of the model"));
      for (const std::vector<std::size_t> &group : statistics.undetermined)
        {
          std::vector<std::string> names;
          for (const std::size_t p : group)
            names.push_back(problem.parameters[p].name);
          run.warn(names.size() == 1 ? "the measured modes do not determine " + names.front() +
                                         ": remove it from Designs/Variables, or add measured modes that depend on it" :
                                       "the measured modes do not determine " + boost::algorithm::join(names, ", ") +
                                         " individually: fix one of these parameters, or add measured modes that they affect differently");
        }
    }

    void say_what_was_fitted(const UpdatingProblem &problem, const Residuals &before, const Residuals &after, Run &run)
    {
      const Agreement start   = frequency_agreement(problem.numbers, &FittedNumber::start),
                      updated = frequency_agreement(problem.numbers, &FittedNumber::updated);
      run.measure("rms difference of frequencies at the start [%]", start.rms);
      run.measure("rms difference of frequencies after the fit [%]", updated.rms);
      run.measure("largest difference of frequencies after the fit [%]", std::abs(updated.largest));
      run.measure("sum of squared residuals at the start [-]", before.r.squaredNorm());
      run.measure("sum of squared residuals after the fit [-]", after.r.squaredNorm());
      run.progress.note(text("  ", counted(problem.parameters.size(), "parameter"), " fitted to ",
                             counted(problem.numbers.size(), "measured number"), ": frequency differences ", updated.rms, " % rms (",
                             start.rms, " % before), largest ", updated.largest, " % (", to_string(updated.worst->state), " ",
                             updated.worst->label, ")"));
    }

    // --------------------------------------------------------------------- study

    /// Fits the parameters and writes tables; @p write writes the parameter file with their values.
    void fit_and_write(const std::vector<FittedParameter>                           &parameters,
                       const MeasuredModes                                          &measured,
                       ModesAtValues                                                 modes_at,
                       const std::function<void(const std::vector<double> &values)> &write,
                       Run                                                          &run)
    {
      const UpdatingParameters &options = run.parameters.updating;
      UpdatingProblem           problem(parameters, measured, std::move(modes_at), run);
      run.count("fitted parameters", parameters.size());
      run.count("measured numbers", problem.numbers.size());

      run.progress.begin("Fit");
      std::vector<double> start;
      for (const FittedParameter &parameter : parameters)
        start.push_back((parameter.start - parameter.lower) / (parameter.upper - parameter.lower));
      const auto [before, computed] = problem.evaluate(start);
      for (std::size_t i = 0; i < computed.size(); ++i)
        problem.numbers[i].start = problem.numbers[i].of(computed[i]);
      const Fit fit = least_squares(
        [&, &before = before](const std::vector<double> &x) { return x == start ? std::optional(before) : problem.try_to_evaluate(x); },
        start, options.tolerance, static_cast<int>(options.n_iterations));
      if (!fit.has_converged)
        throw SolverError(text("the fit has not converged after ", counted(fit.n_iterations, "iteration"), ": residual ",
                               UpdatingProblem::root_mean_square(fit.residuals.r), " rms (", UpdatingProblem::root_mean_square(before.r),
                               " at the start)", problem.why_failed.empty() ? "" : "; an evaluation failed: " + problem.why_failed),
                          "Study = updating", "raise Updating/Iterations or Updating/Tolerance, or narrow the ranges of Designs/Variables");
      for (std::size_t i = 0; i < problem.numbers.size(); ++i)
        {
          FittedNumber &number = problem.numbers[i];
          number.partner       = problem.computed_at.at(fit.x)[i];
          number.updated       = number.of(number.partner);
        }
      run.count("evaluations", problem.n_evaluations);
      run.progress.finish(text(counted(fit.n_iterations, "iteration"), ", ", counted(problem.n_evaluations, "evaluation"), ", residuals ",
                               UpdatingProblem::root_mean_square(before.r), " to ", UpdatingProblem::root_mean_square(fit.residuals.r),
                               " rms"));

      const FitStatistics                 statistics = fit_statistics(fit.residuals, fit.x, measured.are_relative);
      const std::vector<UpdatedParameter> updated    = updated_parameters(problem, fit, statistics);
      run.write_table("updated_parameters", updated_table(updated));
      run.store_table("parameter_correlations", correlation_table(parameters, statistics));
      run.store_table("fit", fit_table(problem.numbers));
      write(problem.values_at(fit.x));
      say_what_was_fitted(problem, before, fit.residuals, run);
      warn_of_limits_and_undetermined(problem, updated, statistics, run);
      run.finish();
    }

    /// Modes of the file Updating/Measured modes or, if this parameter is empty, of the file that the system file names.
    MeasuredModes given_modes(const Parameters &parameters, const std::string &of_system = "")
    {
      const std::string &name      = parameters.updating.measured_modes;
      const std::string  directory = parameters.geometry.directory;
      MeasuredModes      result    = read_measured_modes(name.empty() ? of_system : input_path(name, directory));
      if (!parameters.updating.sensors.empty())
        result.sensors = read_sensors(input_path(parameters.updating.sensors, directory));
      result.least_mac = parameters.updating.least_overlap;
      const double end = parameters.discretization.maximum_frequency;
      for (const MeasuredMode &mode : result.modes)
        if (result.sensors.has(mode.label) && !mode.member.empty())
          throw ParameterError("a mode with a measured shape cannot have a member", mode.where, "leave the column `member` empty");
        else if (mode.frequency.value > end)
          throw ParameterError(
            text("the frequency of ", exact_text(mode.frequency.value), " Hz is above Band/Maximum frequency, ", exact_text(end), " Hz"),
            mode.where, "raise Band/Maximum frequency, or remove the mode");
      return result;
    }

    std::vector<FittedParameter> parameters_of_scene(const Parameters &parameters)
    {
      return fitted_parameters(parameters.designs,
                               [&](const std::string &name) { return nominal_value(parameters, name, where_variables); });
    }

    /// Parameters of a stability run.
    Parameters without_fit(Parameters parameters)
    {
      parameters.study    = studies().front();
      parameters.updating = {};
      return parameters;
    }
  } // namespace

  std::vector<FittedParameter> fitted_parameters(const DesignParameters &designs, const std::function<double(const std::string &)> &current)
  {
    std::vector<FittedParameter> result;
    for (const DesignVariable &variable : design_variables(designs))
      {
        if (!variable.is_range || variable.by_ratio || !variable.levels.empty())
          throw ParameterError("a fit requires a range of the form a to b, but " + in_quotes(variable.name) + " has another form",
                               where_variables, "write Section/Name = a to b");
        const double start = current(variable.name);
        if (start < variable.first || start > variable.last)
          throw ParameterError("the start value " + variable.name + " = " + exact_text(start) + " is outside the range " +
                                 exact_text(variable.first) + " to " + exact_text(variable.last),
                               where_variables, "set the parameter to a value in the range, or widen the range");
        result.push_back({variable.name, start, variable.first, variable.last});
      }
    return result;
  }

  /// `Study = updating`: fits parameters to measured modes by bounded weighted least squares.
  static void run_updating_study(Scene &scene, Run &run)
  {
    const Parameters                  &p          = run.parameters;
    const MeasuredModes                measured   = given_modes(p);
    const std::vector<FittedParameter> parameters = parameters_of_scene(p);
    const auto                         write      = [&](const std::vector<double> &values) {
      std::vector<std::string> names, texts;
      for (std::size_t i = 0; i < values.size(); ++i)
        {
          names.push_back(parameters[i].name);
          texts.push_back(exact_text(values[i]));
        }
      write_parameter_file(without_fit(with_design(p, names, texts)), "updated.prm", run);
    };
    fit_and_write(parameters, measured, modes_of_scene(scene, parameters, measured, run), write, run);
  }

  static void run_updating_of_system(Run &run)
  {
    const SystemFile                   file     = read_system(run);
    const MeasuredModes                measured = given_modes(run.parameters, file.measured_modes);
    const std::vector<FittedParameter> parameters =
      fitted_parameters(run.parameters.designs, [&](const std::string &name) { return value_in(file, name, run.parameters); });
    for (const FittedParameter &parameter : parameters)
      for (const double end : {parameter.lower, parameter.upper})
        {
          auto values            = run.parameters.system.values;
          values[parameter.name] = end;
          file.values(values); // throws ParameterError if the range exceeds the range in the file
        }
    const auto write = [&](const std::vector<double> &values) {
      Parameters updated = without_fit(run.parameters);
      for (std::size_t i = 0; i < values.size(); ++i)
        updated.system.values[parameters[i].name] = values[i];
      updated.system.file = std::filesystem::absolute(run.parameters.system.path()).string();
      write_parameter_file(updated, "updated.prm", run);
    };
    fit_and_write(parameters, measured, modes_of_file(file, parameters, measured, run), write, run);
  }

  extern const Study updating_study = [] {
    Study study{"updating", run_updating_study, {"Updating/", "Designs/Variables"}};
    study.rules = {
      {"Output/", [](const Parameters &) { return "not written by Study = updating"; }},
      {"Updating/Least MAC", [](const Parameters &p) { return unless(!p.updating.sensors.empty(), "Updating/Sensors is empty"); }},
      {"Complex modes/Solver", [](const Parameters &) { return "complex modes are computed by residual iteration"; }},
      {"Complex modes/Iteration tolerance", [](const Parameters &) { return "the tolerance for derivatives is fixed"; }},
      {"Complex modes/Maximum basis", is_used},
      {"Complex modes/Shift inverse", [](const Parameters &) { return "only for the solver Krylov"; }},
      {"Complex modes/Tolerance", [](const Parameters &) { return "only for the solver Krylov"; }}};
    study.check = [](const Parameters &p) {
      given_modes(p);
      const std::vector<FittedParameter> parameters = parameters_of_scene(p);
      check_ranges(p, design_variables(p.designs));
      for (const FittedParameter &parameter : parameters)
        for (const double end : {parameter.lower, parameter.upper})
          without_fit(with_design(p, {parameter.name}, {exact_text(end)})).check();
    };
    study.run_of_system = run_updating_of_system;
    return study;
  }();
} // namespace Squeal
