// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/discretisation_error.h>
#include <squeal/modes/power_balance.h>
#include <squeal/studies/steps/friction_modes.h>
#include <squeal/system/system_file.h>

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

  /// Solves the scene on the coarser mesh of the accuracy asked for, or on the given one, as a step of the run; nothing without either.
  std::optional<CoarserSolution> solve_on_coarser_mesh(Run &run);

  /// Errors of all modes, see discretisation_errors().
  std::vector<DiscretisationError> mesh_errors(const CoarserSolution   &coarser,
                                               const FrictionlessModes &frictionless,
                                               const FrictionModes     &friction,
                                               AccuracyGoal             goal);

  /// Prints the accuracy that is reached, counts the verdicts that include the error of the mesh, and warns of unstable modes that are not
  /// converged to the accuracy asked for, if any.
  void report_mesh_errors(const std::vector<DiscretisationError> &errors, const FrictionModes &friction, Run &run);

  /// Where the energy of every growing mode comes from, by numbers of the modes.
  using PowerBalances = std::map<int, PowerBalance>;

  /// What a mode file says of a complex mode: "A0-4 +, 2353 Hz, divergence rate 0.6798 %, unstable".
  std::string mode_title(const ModeLabel &label, const std::complex<double> &lambda);

  /// How the parameters want modes to be animated.
  AnimationOptions animation_options(const OutputParameters &output);

  /// The fields that the parameters choose, in their format, as steps of the run: complex modes with animations of unstable ones, real
  /// coupled modes, component modes; where the energy of growing ones enters; and of each kind a list through which ParaView steps. Files
  /// bear the numbers of the rows of `complex_modes.csv`, `real_modes.csv` and `component_modes.csv`.
  void write_mode_shapes(const FrictionlessModes &frictionless, const FrictionModes &friction, const PowerBalances &balances, Run &run);

  /// The same of a system file at its points, with files of the same names and fields: one vertex for each point; `component` is the number
  /// of its group of dofs from 0. Writes nothing without points.
  void write_mode_shapes(const SystemFile &file, const FrictionlessModes &frictionless, const FrictionModes &friction, Run &run);

  /// `sliding_pins.csv` and `sliding_certificate.csv`, and a note on open pins and uniqueness.
  void write_sliding_tables(const Scene &scene, const SlidingState &state, const OperationParameters &operation, Run &run);

  /// `sliding_state.vtu` and `sliding_state_contact.vtu`, of a linearisation about steady sliding.
  void write_sliding_fields(const Linearisation &linearisation, Run &run);
} // namespace Squeal
