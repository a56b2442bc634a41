#include <squeal/base/conventions.h>
#include <squeal/studies/sweep_plan.h>

#include <algorithm>

namespace Squeal
{
  ContactStates::ContactStates(const Scene &scene, Run &run)
    : scene(scene)
    , parameters(run.parameters.sliding)
  {
    if (parameters.state != ContactState::steady_sliding)
      return;
    run.progress.begin("Contact flexibility");
    response = std::make_unique<StaticResponse>(
      *scene.model, scene.system, circular_frequency(run.parameters.discretization.maximum_frequency), run.parameters.solvers.library);
    responses = std::make_unique<SlidingResponses>(sliding_responses(scene.contact, *response));
    run.progress.finish(text(2 * scene.interface.size(), " attachment modes"));
  }

  std::optional<SlidingState> ContactStates::sliding(const OperationParameters &operation) const
  {
    if (!response)
      return {};
    return steady_sliding(*scene.model, scene.interface, scene.contact, scene.system, *response, *responses, operation, parameters);
  }

  StateOfContact ContactStates::at(const OperationParameters &operation) const
  {
    const auto state = sliding(operation);
    return state_of_contact(scene.interface, state ? &*state : nullptr, operation);
  }

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

  std::vector<unsigned int> SweepPlan::closed_at(const double friction_coefficient) const
  {
    return states.at(lines[0].at(friction_coefficient)).closed;
  }

  OperatingPoint SweepPlan::point(const int line, const double friction_coefficient, const std::vector<unsigned int> &closed) const
  {
    return {friction_coefficient, selected(states.at(lines[line].at(friction_coefficient)).damping, closed).values(), line};
  }

  SweepPlan sweep_plan(const Scene &scene, Run &run)
  {
    SweepPlan                   plan{lines_of(run.parameters), ContactStates(scene, run), {}};
    std::vector<ContactRegime> &regimes  = plan.regimes;
    std::size_t                 n_points = 0;
    run.progress.begin("States of contact");
    for (std::size_t l = 0; l < plan.lines.size(); ++l)
      for (const double mu : plan.lines[l].friction_coefficients)
        {
          run.progress.update(text("state ", ++n_points));
          const StateOfContact state = plan.states.at(plan.lines[l].at(mu));
          auto                 regime =
            std::find_if(regimes.begin(), regimes.end(), [&](const ContactRegime &other) { return other.closed == state.closed; });
          if (regime == regimes.end())
            regime = regimes.insert(regime, {regimes.size() + 1, state.closed, {}});
          regime->points.push_back({mu, selected(state.damping, state.closed).values(), static_cast<int>(l)});
        }
    run.progress.finish(text(n_points, " operating points, ", regimes.size(), regimes.size() == 1 ? " contact set" : " contact sets"));
    return plan;
  }
} // namespace Squeal
