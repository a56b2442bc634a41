// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/studies/sweep/sweep_charts.h>

namespace Squeal
{
  namespace
  {
    std::vector<SweepLine> lines_of(const Parameters &parameters)
    {
      using Kind                          = SweepLine::Kind;
      const SweepParameters    &sweep     = parameters.sweep;
      const OperationParameters operation = parameters.operation;
      const std::vector<double> grid      = sweep.friction_coefficients.linear();
      std::vector<SweepLine>    lines     = {{Kind::main, operation, 0., grid}};
      if (sweep.compare_dissipation && operation.radial_dissipation != RadialDissipation::none)
        {
          lines.push_back({Kind::without_dissipation, operation, 0., grid});
          lines.back().operation.radial_dissipation = RadialDissipation::none;
        }
      if (sweep.map_parameter != MapParameter::none)
        for (const double value : sweep.map_values.geometric())
          {
            lines.push_back({Kind::map, operation, value, sweep.map_grid()});
            OperationParameters &varied                                                                = lines.back().operation;
            (sweep.map_parameter == MapParameter::load ? varied.load_per_side : varied.rotation_speed) = value;
            if (parameters.maps_rotation())
              lines.back().values[BodyParameter::angular_velocity] = {value};
          }
      return lines;
    }
  } // namespace

  OperationParameters SweepLine::at(const double friction_coefficient) const
  {
    OperationParameters result  = operation;
    result.friction_coefficient = friction_coefficient;
    return result;
  }

  std::vector<int> ContactRegime::on_line(const int line) const
  {
    std::vector<int> result;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (points[i].line == line)
        result.push_back(static_cast<int>(i));
    return result;
  }

  std::optional<SlidingState> SweepPlan::sliding_state(const OperationParameters &operation) const
  {
    if (!sliding)
      return {};
    return steady_sliding(*sliding, operation, sliding_parameters);
  }

  StateOfContact SweepPlan::state_at(const int line, const double friction_coefficient) const
  {
    const OperationParameters operation = lines[line].at(friction_coefficient);
    return scene != nullptr ? state_of_contact(*scene->model, scene->interface, sliding_state(operation), operation) : StateOfContact();
  }

  ContactRegime &regime_of(const std::vector<unsigned int> &closed, std::vector<ContactRegime> &regimes)
  {
    const auto known = std::find_if(regimes.begin(), regimes.end(), [&](const ContactRegime &regime) { return regime.closed == closed; });
    return known != regimes.end() ? *known : regimes.emplace_back(ContactRegime{regimes.size() + 1, closed, {}});
  }

  OperatingPoint SweepPlan::point(const int line, const double friction_coefficient, const std::vector<unsigned int> &closed) const
  {
    OperatingPoint result{friction_coefficient, lines[line].values, line};
    if (scene != nullptr)
      result.values.merge(selected(state_at(line, friction_coefficient).damping, closed).values());
    return result;
  }

  SweepPlan sweep_plan(const Scene &scene, Run &run)
  {
    return sweep_plan(scene, lines_of(run.parameters), run);
  }

  SweepPlan sweep_plan(const Scene &scene, const std::vector<SweepLine> &lines, Run &run)
  {
    const bool                  is_load = run.parameters.sweep.map_parameter == MapParameter::load;
    SweepPlan                   plan{&scene,
                   {},
                   {},
                   {SystemParameter::friction, "-"},
                   {is_load ? "load per side" : "rotation speed", is_load ? "N" : "rad/s"},
                   run.parameters.sliding,
                   nullptr,
                   lines,
                   {}};
    std::vector<ContactRegime> &regimes  = plan.regimes;
    std::size_t                 n_points = 0;
    if (plan.sliding_parameters.state == ContactState::steady_sliding)
      {
        run.progress.begin("Contact flexibility");
        plan.sliding = std::make_unique<SlidingModel>(sliding_model(scene, run.parameters));
        run.progress.finish(text(2 * scene.interface.size(), " attachment modes"));
      }
    if (lines.empty())
      return plan;
    run.progress.begin("Contact states");
    for (std::size_t l = 0; l < plan.lines.size(); ++l)
      for (const double mu : plan.lines[l].friction_coefficients)
        {
          run.progress.update(text("state ", ++n_points));
          const StateOfContact state = plan.state_at(static_cast<int>(l), mu);
          OperatingPoint       point{mu, plan.lines[l].values, static_cast<int>(l)};
          point.values.merge(selected(state.damping, state.closed).values());
          regime_of(state.closed, regimes).points.push_back(std::move(point));
        }
    run.progress.finish(text(counted(n_points, "operating point"), ", ", counted(regimes.size(), "contact set")));
    return plan;
  }

  NamedRange swept_parameter(const SystemFile &file, const Run &run)
  {
    const SweepParameters &sweep  = run.parameters.sweep;
    NamedRange             result = sweep.varied_parameter();
    if (sweep.parameter.empty() && file.find(result.name) == nullptr)
      throw ParameterError(
        "no parameter is given for the sweep, and the system has no parameter mu", "parameter Sweep/Parameter",
        "give the varied parameter, its first and last value and the number of values, for example omega, 6.28, 25.1, 31");
    std::map<std::string, double> given = run.parameters.system.values;
    for (const double value : {result.values.first, result.values.last})
      {
        given[result.name] = value;
        file.values(given);
      }
    return result;
  }

  SweepPlan sweep_plan_of_system(Run &run)
  {
    const auto       second = run.parameters.sweep.second_varied_parameter();
    SystemFile       file   = read_system(run);
    const NamedRange varied = swept_parameter(file, run);
    // Check the ends of the second range before the computation
    std::map<std::string, double> given = run.parameters.system.values;
    if (second)
      for (const double value : {second->values.last, second->values.first})
        {
          given[second->name] = value;
          file.values(given);
        }
    given                         = run.parameters.system.values;
    given[varied.name]            = varied.values.last;
    const ParameterValues  values = file.values(given);
    const auto             axis   = [&file](const std::string &name) { return SweepAxis{name, file.find(name)->unit}; };
    const SweepAxis        main = axis(varied.name), other = second ? axis(second->name) : SweepAxis();
    std::vector<SweepLine> lines = {{SweepLine::Kind::main, {}, 0., varied.values.linear()}};
    if (second)
      for (const double value : second->values.linear())
        lines.push_back({SweepLine::Kind::map, {}, value, varied.values.linear(), {{second->name, {value}}}});
    SweepPlan     plan{nullptr, std::move(file), values, main, other, {}, nullptr, lines, {}};
    ContactRegime all{1, {}, {}};
    for (std::size_t l = 0; l < lines.size(); ++l)
      for (const double value : lines[l].friction_coefficients)
        all.points.push_back(plan.point(static_cast<int>(l), value, {}));
    plan.regimes.push_back(all);
    return plan;
  }
} // namespace Squeal
