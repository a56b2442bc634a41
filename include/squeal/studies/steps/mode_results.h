// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/discretisation_error.h>
#include <squeal/modes/power_balance.h>
#include <squeal/studies/steps/friction_modes.h>
#include <squeal/system/system_file.h>

namespace Squeal
{
  /// Modes with friction at common points, see at_points(); the points must be in the bodies of the model.
  ModesAtPoints modes_at(const CommonPoints &points, const FrictionlessModes &frictionless, const FrictionModes &friction);

  /// Modes on the coarser mesh, for estimates of the discretisation error.
  struct CoarserSolution
  {
    CommonPoints  points; ///< points of the coarser mesh
    ModesAtPoints modes;
  };

  /// Solves the model on the coarser mesh of the accuracy goal or of the parameters, as a step of the run; empty if there is none.
  std::optional<CoarserSolution> solve_on_coarser_mesh(Run &run);

  /// Discretisation errors of all modes, see discretisation_errors().
  std::vector<DiscretisationError> mesh_errors(const CoarserSolution   &coarser,
                                               const FrictionlessModes &frictionless,
                                               const FrictionModes     &friction,
                                               AccuracyGoal             goal);

  /// Prints the accuracy, counts the verdicts that include the discretisation error, and warns of unstable modes that are not converged to
  /// the requested accuracy.
  void report_mesh_errors(const std::vector<DiscretisationError> &errors, const FrictionModes &friction, Run &run);

  /// Power balances of the growing modes, by mode index.
  using PowerBalances = std::map<int, PowerBalance>;

  /// Title of a complex mode in its file: "A0-4 +, 2353 Hz, divergence rate 0.6798 %, unstable".
  std::string mode_title(const ModeLabel &label, const std::complex<double> &lambda);

  AnimationOptions animation_options(const OutputParameters &output);

  /// Writes the requested fields, as steps of the run: complex modes, with the energy input and animations of unstable modes; real coupled
  /// modes; component modes; and a list of each type for ParaView. Numbers in file names are row numbers in `complex_modes.csv`,
  /// `real_modes.csv` and `component_modes.csv`.
  void write_mode_shapes(const FrictionlessModes &frictionless, const FrictionModes &friction, const PowerBalances &balances, Run &run);

  /// Writes mode shapes of a system file at its points, with the same names of files and fields as for a mesh: one vertex for each point;
  /// `component` is the index of its group of dofs, from 0. Writes no files if the system has no points.
  void write_mode_shapes(const SystemFile &file, const FrictionlessModes &frictionless, const FrictionModes &friction, Run &run);

  /// Writes `sliding_pins.csv` and `sliding_checks.csv`, and prints notes on open contact nodes and uniqueness.
  void write_sliding_tables(const Scene &scene, const SlidingState &state, const OperationParameters &operation, Run &run);

  /// Writes `sliding_state.vtu` and `sliding_state_contact.vtu` for a linearisation about steady sliding.
  void write_sliding_fields(const Linearisation &linearisation, Run &run);
} // namespace Squeal
