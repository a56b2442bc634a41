#pragma once

#include <squeal/estimates/discretisation_error.h>
#include <squeal/studies/steps/friction_modes.h>

#include <optional>
#include <vector>

namespace Squeal
{
  /// Modes with friction at common points, see at_points(); the points must be in the bodies of the scene.
  ModesAtPoints modes_at(const CommonPoints &points, const FrictionlessModes &frictionless, const FrictionModes &friction);

  /// Modes on the coarser mesh with which the error of the mesh is estimated.
  struct CoarserSolution
  {
    CommonPoints  points; ///< of the coarser mesh
    ModesAtPoints modes;
  };

  /// Solves the scene on the coarser mesh that goes with the accuracy asked for, as a step of the run; nothing where none is asked for.
  std::optional<CoarserSolution> solve_on_coarser_mesh(Run &run);

  /// Errors of all modes, see discretisation_errors().
  std::vector<DiscretisationError> mesh_errors(const CoarserSolution   &coarser,
                                               const FrictionlessModes &frictionless,
                                               const FrictionModes     &friction,
                                               AccuracyGoal             goal);

  /**
   * Says what accuracy is reached, counts the verdicts that include the error of the mesh, and warns of unstable modes that are not
   * converged.
   */
  void report_mesh_errors(const std::vector<DiscretisationError> &errors, const FrictionModes &friction, Run &run);
} // namespace Squeal
