#pragma once

#include <squeal/studies/scene.h>
#include <squeal/tracking/chart_model.h>

#include <memory>
#include <optional>
#include <vector>

namespace Squeal
{
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
    StateOfContact at(const OperationParameters &operation) const;

    /// The steady sliding state, or nothing if the load is shared equally.
    std::optional<SlidingState> sliding(const OperationParameters &operation) const;

  private:
    const Scene                      &scene;
    SlidingParameters                 parameters;
    std::unique_ptr<StaticResponse>   response; ///< null: equal shares
    std::unique_ptr<SlidingResponses> responses;
  };

  /// Friction coefficients at one load and speed.
  struct SweepLine
  {
    enum class Kind
    {
      main,                ///< as the operation says
      without_dissipation, ///< the same without radial dissipation
      map                  ///< at another load or speed
    };

    Kind                kind;
    OperationParameters operation; ///< but for the friction coefficient
    double              value;     ///< load [N] or speed [rad/s] of a line of the map
    std::vector<double> friction_coefficients;

    OperationParameters at(double friction_coefficient) const;
  };

  /// Operating points with the same closed contact nodes: one coupled system, one basis.
  struct ContactRegime
  {
    std::size_t                 number; ///< from one on
    std::vector<unsigned int>   closed; ///< numbers of the closed pairs
    std::vector<OperatingPoint> points;

    /// Numbers of the points of a line.
    std::vector<int> on_line(int line) const;
  };

  /// What a sweep asks for, with the states of contact there. The main line is the first.
  struct SweepPlan
  {
    std::vector<SweepLine>     lines;
    ContactStates              states;
    std::vector<ContactRegime> regimes;

    /// Numbers of the closed pairs on the main line.
    std::vector<unsigned int> closed_at(double friction_coefficient) const;

    /// A point of a line with the damping of those contact nodes that are closed in a regime.
    OperatingPoint point(int line, double friction_coefficient, const std::vector<unsigned int> &closed) const;
  };

  /// Finds the states of contact at all operating points that the parameters ask for, as steps of the run. @p scene must outlive the plan.
  SweepPlan sweep_plan(const Scene &scene, Run &run);
} // namespace Squeal
