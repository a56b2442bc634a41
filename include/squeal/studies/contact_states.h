#pragma once

#include <squeal/studies/scene.h>

#include <memory>
#include <optional>
#include <vector>

namespace Squeal
{
  /// Contact at one friction coefficient, load and speed.
  struct ContactStateAt
  {
    std::vector<unsigned int> closed;  ///< numbers of the closed pairs
    ContactDamping            damping; ///< of all pairs; zeros at open ones
  };

  /**
   * States of contact over friction coefficient, load and speed: equal shares of
   * the load or steady sliding, whichever the parameters ask for. What serves
   * all states is computed once, as a step of the run.
   */
  class ContactStates
  {
  public:
    /// @p scene must outlive it.
    ContactStates(const Scene &scene, Run &run);

    /// Throws SolverError if there is no steady sliding state.
    ContactStateAt at(const OperationParameters &operation) const;

    /// The steady sliding state, or nothing if the load is shared equally.
    std::optional<SlidingState> sliding(const OperationParameters &operation) const;

  private:
    const Scene                      &scene;
    SlidingParameters                 parameters;
    std::unique_ptr<StaticResponse>   response; ///< null: equal shares
    std::unique_ptr<SlidingResponses> responses;
  };

  /// Coefficients of all pairs @p chosen among them.
  ContactDamping selected(const ContactDamping &damping, const std::vector<unsigned int> &chosen);
} // namespace Squeal
