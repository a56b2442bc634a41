#include <squeal/base/conventions.h>
#include <squeal/studies/contact_states.h>

#include <numeric>

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

  ContactStateAt ContactStates::at(const OperationParameters &operation) const
  {
    ContactStateAt      result;
    std::vector<double> reactions;
    if (const auto state = sliding(operation))
      {
        reactions = state->reactions;
        for (unsigned int c = 0; c < state->closed.size(); ++c)
          if (state->closed[c])
            result.closed.push_back(c);
      }
    else
      {
        reactions = equal_load_shares(scene.interface, operation.load_per_side);
        result.closed.resize(scene.interface.size());
        std::iota(result.closed.begin(), result.closed.end(), 0u);
      }
    result.damping = {radial_dissipation(scene.interface, reactions, operation), sliding_dissipation(reactions, operation)};
    return result;
  }

  ContactDamping selected(const ContactDamping &damping, const std::vector<unsigned int> &chosen)
  {
    const auto select = [&](const std::vector<double> &values) {
      std::vector<double> result;
      for (const unsigned int c : chosen)
        if (!values.empty())
          result.push_back(values[c]);
      return result;
    };
    return {select(damping.radial), select(damping.sliding)};
  }
} // namespace Squeal
