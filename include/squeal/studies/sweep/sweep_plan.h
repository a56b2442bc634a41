#pragma once

#include <squeal/studies/steps/scene.h>
#include <squeal/tracking/chart_model.h>

#include <memory>
#include <optional>
#include <vector>

namespace Squeal
{
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
    const Scene                  &scene;
    SlidingParameters             sliding_parameters;
    std::unique_ptr<SlidingModel> sliding; ///< serves all states; null: equal shares of the load
    std::vector<SweepLine>        lines;
    std::vector<ContactRegime>    regimes;

    /// The steady sliding state, or nothing if the load is shared equally. Throws SolverError if there is no such state.
    std::optional<SlidingState> sliding_state(const OperationParameters &operation) const;

    StateOfContact state_at(int line, double friction_coefficient) const;

    /// Numbers of the closed pairs on the main line.
    std::vector<unsigned int> closed_at(const double friction_coefficient) const
    {
      return state_at(0, friction_coefficient).closed;
    }

    /// A point of a line with the damping of those contact nodes that are closed in a regime.
    OperatingPoint point(int line, double friction_coefficient, const std::vector<unsigned int> &closed) const;
  };

  /// Finds the states of contact at all operating points that the parameters ask for, as steps of the run. @p scene must outlive the plan.
  SweepPlan sweep_plan(const Scene &scene, Run &run);

  /// The same for some lines of operating points.
  SweepPlan sweep_plan(const Scene &scene, const std::vector<SweepLine> &lines, Run &run);
} // namespace Squeal
