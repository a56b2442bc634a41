// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/studies/robustness/robustness.h>
#include <squeal/studies/steps/written_system.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    constexpr const char *where_requested = "parameter Output/Write system";

    /// Relative rounding error of values in tables, which have twelve digits [-].
    constexpr double rounding = 1e-11;

    /// Extends the range of each parameter to include its value in a sample.
    void cover(std::vector<FileParameter> &ranges, const std::vector<FileParameter> &of_sample)
    {
      for (const FileParameter &parameter : of_sample)
        for (FileParameter &range : ranges)
          if (range.name == parameter.name && range.value != parameter.value)
            {
              const auto [lower, upper] = std::minmax({range.value, parameter.value});
              range.lower               = std::min(range.lower, lower - rounding * std::abs(lower));
              range.upper               = std::max(range.upper, upper + rounding * std::abs(upper));
            }
    }
  } // namespace

  void check_reduced_system(const SampledSystems &systems)
  {
    for (std::size_t i = 0; i < systems.plan.regimes.size(); ++i)
      {
        if (!systems.middles[i].linearisation.coupled.stiffness)
          throw ParameterError("samples of a system without a definite part are solved at full order, without a reduced model",
                               where_requested, "set this parameter to full or none, or set Study = sweep");
        const std::vector<OperatingPoint> &points = systems.plan.regimes[i].points;
        for (std::size_t k = 1; systems.plan.scene != nullptr && k < systems.n_samples[i]; ++k)
          for (const auto &[name, value] : points[k].values)
            if (systems.scales[i].count(name) == 0 && value != points.front().values.at(name))
              throw ParameterError(
                "contact damping varies between samples, but must be constant in a system file", where_requested,
                "set Operation/Radial dissipation = none and Operation/Friction slope = 0, or keep load, speed, friction "
                "slope and friction coefficient constant");
      }
  }

  void write_reduced_system(const SampledSystems                     &systems,
                            const std::size_t                         contact_set,
                            const SamplePlan                         &plan,
                            const std::vector<std::optional<Sample>> &samples,
                            const SweepModel                         &model)
  {
    Run                                            &run    = model.run;
    const std::vector<OperatingPoint>              &points = model.regime.points;
    const std::size_t                               n      = systems.n_samples[contact_set];
    std::function<Coefficient(const Coefficient &)> rename;
    std::vector<FileParameter>                      parameters;
    if (systems.plan.scene == nullptr)
      for (std::size_t k = 0; k < n; ++k)
        {
          const std::vector<FileParameter> here = fixed(systems.plan.file->parameters, points[k].values);
          if (k == 0)
            parameters = here;
          cover(parameters, here);
        }
    else
      {
        const auto named = [&](const std::size_t k) {
          const Parameters sample = with_sample(run.parameters, plan, points[k].line);
          return named_parameters(model.frictionless.linearisation, friction_parameter(sample), sample);
        };
        const NamedParameters first = named(0);
        parameters                  = first.parameters;
        for (FileParameter &parameter : parameters)
          parameter.lower = parameter.upper = parameter.value;
        for (std::size_t k = 1; k < n; ++k)
          cover(parameters, named(k).parameters);
        auto without_scales = first.names;
        for (const auto &[name, scale] : systems.scales[contact_set])
          without_scales[name] = "";
        rename = [&scales = systems.scales[contact_set], names = first.names, without_scales](const Coefficient &coefficient) {
          Coefficient result = in_names(coefficient, without_scales);
          for (const auto &[name, scale] : scales)
            if (coefficient.contains(name)) // scales have the exponent one
              result = result * Coefficient(scale.first) * in_names(scale.second, names);
          return result;
        };
        // Remove parameters that no term contains, because their constant values are included in the matrices
        const std::vector<Term> &terms = model.reduced->reduced().full_order().terms;
        parameters.erase(std::remove_if(parameters.begin(), parameters.end(),
                                        [&](const FileParameter &parameter) {
                                          return std::none_of(terms.begin(), terms.end(), [&](const Term &term) {
                                            return rename(term.coefficient).contains(parameter.name);
                                          });
                                        }),
                         parameters.end());
      }
    std::vector<int> solved;
    for (std::size_t k = 0; k < n; ++k)
      if (samples[points[k].line])
        solved.push_back(points[k].line);
    Columns<int> columns = sample_columns(plan);
    columns.push_back({"largest estimated error of lambda", "-", [&](const int s) { return largest_error(*samples[s]); }, 1, true});
    write_reduced_system(model.reduced->reduced(),
                         {parameters, "reduced model of samples", run.parameters.robustness.tolerance, Table(columns, solved)}, rename,
                         systems.plan.regimes.size() > 1 ? text("system_", model.regime.number, "/") : "system/", run);
  }
} // namespace Squeal
