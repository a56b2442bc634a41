// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/studies/designs/design_work.h>

#include <deal.II/base/utilities.h>

namespace Squeal
{
  extern const Study sweep_study;

  namespace
  {
    using dealii::Utilities::split_string_list;

    /// Parameters of the study and its solution method, which cannot vary between designs.
    constexpr const char *of_the_solution[] = {"Study",
                                               "Designs/",
                                               "Search/",
                                               "Output/",
                                               "Real modes/",
                                               "Linear algebra/",
                                               "Sweep/Tolerance",
                                               "Sweep/Threshold tolerance",
                                               "Sweep/Maximum basis",
                                               "Geometry/Allow shell commands",
                                               "Geometry/Meshing time limit",
                                               "Geometry/Meshing memory limit"};

    /// Reason why a parameter has no effect on a design; empty if it has an effect. @p as_written: the design without the settings of
    /// Accuracy.
    std::string why_unused(const std::string &name, const Parameters &design, const Parameters &as_written)
    {
      const std::string path = dealii::Utilities::trim(name.substr(0, name.find('[')));
      for (const char *numerical : of_the_solution)
        if (concerns(numerical, path))
          return "it controls the study, not its designs";
      if (current_value(design, name) != current_value(as_written, name))
        return "set by Accuracy = " + to_string(design.goal);
      try
        {
          const auto unused = unused_among({path}, design);
          return unused.empty() ? "" : unused.front().why;
        }
      catch (const MeshError &)
        {
          return ""; // the error is reported when the design is solved
        }
    }

    /// Reason why no parameter of a variable has an effect; empty if at least one has an effect.
    std::string why_all_unused(const std::string &variable, const Parameters &design, const Parameters &as_written)
    {
      std::string reason;
      for (const std::string &name : split_string_list(variable, '+'))
        {
          reason = why_unused(name, design, as_written);
          if (reason.empty())
            break;
        }
      return reason;
    }

    void check_names(const Parameters &parameters, const std::vector<std::string> &names, const std::string &where)
    {
      for (const std::string &variable : names)
        for (const std::string &name : split_string_list(variable, '+'))
          current_value(parameters, name, where);
    }

    [[noreturn]] void refuse_unused(const UnusedParameter &variable, const std::string &where)
    {
      throw ParameterError(in_quotes(variable.path) + " varies, but has no effect: " + variable.why, where,
                           "vary other parameters instead, or change the setting that disables this parameter");
    }

    /// True if two designs differ only in the unused variables.
    bool are_equal_but_for(const std::vector<UnusedParameter> &unused, const DesignPlan &plan)
    {
      std::map<std::vector<std::string>, std::vector<std::string>> seen;
      for (const std::vector<std::string> &design : plan.designs)
        {
          std::vector<std::string> rest = design;
          for (const UnusedParameter &variable : unused)
            rest[std::find(plan.names.begin(), plan.names.end(), variable.path) - plan.names.begin()].clear();
          if (const auto [other, is_new] = seen.emplace(rest, design); !is_new && other->second != design)
            return true;
        }
      return false;
    }

    /// Error with which a design is rejected; empty if it is accepted.
    std::optional<ParameterError> refusal(const Parameters               &parameters,
                                          const std::vector<std::string> &names,
                                          const std::vector<std::string> &values)
    {
      try
        {
          Parameters design          = with_design(parameters, names, values);
          design.study               = &sweep_study; // avoids recursion: the check of sweeps does not check designs
          design.sweep.map_parameter = MapParameter::none;
          design.check();
          return {};
        }
      catch (const ParameterError &error)
        {
          return error;
        }
    }

    void check_values(const Parameters &parameters, const DesignPlan &plan)
    {
      const auto of_scene = refusal(parameters, {}, {});
      for (std::size_t v = 0; v < plan.names.size(); ++v)
        {
          std::set<std::string> seen;
          for (std::size_t i = 0; i < plan.designs.size(); ++i)
            {
              const std::string &value = plan.designs[i][v];
              if (value.empty() || !seen.insert(value).second)
                continue;
              const auto alone = refusal(parameters, {plan.names[v]}, {value});
              if (!alone)
                continue;
              if (std::any_of(plan.designs.begin(), plan.designs.end(), [&](const std::vector<std::string> &design) {
                    return design[v] == value && !refusal(parameters, plan.names, design);
                  }))
                continue;
              if (of_scene && of_scene->reason == alone->reason)
                throw ParameterError(*of_scene);
              throw ParameterError(alone->reason,
                                   plan.where_is(i) + ", design " + std::to_string(i + 1) + ", " + plan.names[v] + " = " + legible(value),
                                   alone->change);
            }
        }
    }
  } // namespace

  std::vector<UnusedParameter> unused_variables(const Parameters &parameters, const DesignPlan &plan)
  {
    Parameters without_goal = parameters;
    without_goal.goal       = AccuracyGoal::as_given;
    std::vector<UnusedParameter> result;
    for (const std::string &name : plan.names)
      {
        std::string reason;
        const bool  is_used =
          std::any_of(plan.designs.begin(), plan.designs.end(), [&, &name = name](const std::vector<std::string> &values) {
            try
              {
                reason = why_all_unused(name, with_design(parameters, plan.names, values), with_design(without_goal, plan.names, values));
                return reason.empty();
              }
            catch (const ParameterError &)
              {
                return false; // the error is reported in the row of the design
              }
          });
        if (!is_used && !reason.empty())
          result.push_back({name, reason});
      }
    return result;
  }

  void check_designs(const Parameters &parameters, const DesignPlan &plan)
  {
    check_names(parameters, plan.names, plan.where_names);
    check_values(parameters, plan);
    const auto unused = unused_variables(parameters, plan);
    if (!unused.empty() && (parameters.designs.choice != DesignChoice::file || are_equal_but_for(unused, plan)))
      refuse_unused(unused.front(), plan.where_names);
  }

  void check_ranges(const Parameters &parameters, const std::vector<DesignVariable> &variables)
  {
    DesignPlan plan;
    plan.where_names = where_variables;
    plan.designs.resize(2);
    for (const DesignVariable &variable : variables)
      {
        plan.names.push_back(variable.name);
        plan.designs[0].push_back(exact_text(variable.first));
        plan.designs[1].push_back(exact_text(variable.last));
      }
    check_names(parameters, plan.names, plan.where_names);
    for (const std::vector<std::string> &ends : plan.designs)
      with_design(parameters, plan.names, ends);
    if (const auto unused = unused_variables(parameters, plan); !unused.empty())
      refuse_unused(unused.front(), plan.where_names);
  }
} // namespace Squeal
