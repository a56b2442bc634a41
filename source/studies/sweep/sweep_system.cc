// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/studies/steps/written_system.h>
#include <squeal/studies/sweep/sweep_charts.h>

namespace Squeal
{
  namespace
  {
    /// Parameters of the system with the ranges that the plan covers.
    std::vector<FileParameter> covered_parameters(const SweepModel &model)
    {
      const SweepPlan &plan  = model.plan;
      double           first = plan.lines.front().friction_coefficients.front(), last = plan.lines.front().friction_coefficients.back();
      if (plan.scene != nullptr)
        {
          FileParameter mu = friction_parameter(model.run.parameters);
          if (mu.lower == mu.upper) // fixed, because the contact state or damping depends on μ
            first = last = most_damped(model.regime).friction_coefficient;
          mu.value = mu.upper = last;
          mu.lower            = first;
          return {mu};
        }
      std::vector<FileParameter> result = fixed(plan.file->parameters, plan.values);
      for (FileParameter &parameter : result)
        {
          if (parameter.name == plan.axis.name)
            parameter.lower = first;
          for (const SweepLine &line : plan.lines)
            if (line.kind == SweepLine::Kind::map && parameter.name == plan.second_axis.name)
              {
                parameter.lower = std::min(parameter.lower, line.value);
                parameter.upper = std::max(parameter.upper, line.value);
              }
        }
      return result;
    }

    /// Largest error of λ at every point.
    Table point_table(const SweepModel &model, const std::map<SweepModel::Place, double> &errors, const std::string &name)
    {
      using Row             = const std::pair<const SweepModel::Place, double>;
      const SweepPlan &plan = model.plan;
      Columns<Row>     columns{{plan.axis.name, plan.axis.unit, [](const Row &row) { return row.first.second; }}};
      if (!plan.second_axis.name.empty())
        columns.push_back({plan.second_axis.name, plan.second_axis.unit, [&](const Row &row) {
                             const SweepLine &line = plan.lines[row.first.first];
                             return line.kind == SweepLine::Kind::map ? Entry(line.value) : Entry();
                           }});
      columns.push_back({name, "-", [](const Row &row) { return row.second; }, 1, true});
      return Table(columns, errors);
    }
  } // namespace

  void write_system_of(SweepModel &model)
  {
    Run                             &run           = model.run;
    const std::string                folder        = model.plan.regimes.size() > 1 ? text("system_", model.regime.number, "/") : "system/";
    const Linearisation             &linearisation = model.frictionless.linearisation;
    const std::vector<FileParameter> parameters    = covered_parameters(model);
    switch (run.parameters.output.write_system)
      {
        case SystemOutput::none:
          return;
        case SystemOutput::full:
          if (model.plan.file)
            write_system_again(*model.plan.file, folder, run);
          else
            write_scene_system(linearisation, parameters.front(), folder, run);
          return;
        case SystemOutput::reduced:
          std::map<SweepModel::Place, double> errors;
          std::optional<ReducedModel>         of_snapshots;
          if (!model.reduced)
            of_snapshots = snapshot_model(model, errors);
          else
            for (const auto &[place, point] : model.known)
              errors[place] = model.largest_error(point);
          write_reduced_system(of_snapshots ? *of_snapshots : model.reduced->reduced(),
                               {parameters, "reduced model", run.parameters.sweep.tolerance,
                                point_table(model, errors, of_snapshots ? "largest error of lambda" : "largest estimated error of lambda")},
                               nullptr, folder, run);
      }
  }
} // namespace Squeal
