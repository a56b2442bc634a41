// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/imported_system.h>
#include <squeal/estimates/direct_modes.h>
#include <squeal/modes/contour_count.h>
#include <squeal/studies/steps/friction_modes.h>

namespace Squeal
{
  /// Reads the system file of the parameters, as a step of the run.
  SystemFile read_system(Run &run);

  /// The system of a system file at the given parameter values.
  struct GivenSystem
  {
    SystemFile      file;
    ParameterValues values;
    CoupledSystem   coupled;
    double          value; ///< value of the varied parameter
  };
  GivenSystem given_system(Run &run);

  /**
   * Frictionless modes of an imported system, labelled `mode 1`, `mode 2`, ...; skew terms are ignored. Modes of the complete system inherit
   * these labels. The linearisation has no meshed model. Progress is reported as steps of the run.
   *
   * @param system system that is factorised and solved: @p whole or a part of it, for example without damping
   *
   * Throws SolverError if @p system has no definite part, or if no shift makes its stiffness positive definite.
   */
  FrictionlessModes imported_modes(const CoupledSystem &system, const CoupledSystem &whole, Run &run, double margin = 0.);

  /// Modes of a system without its damping, up to slightly beyond the band, as starting vectors of reduced models. Without a definite part,
  /// the result contains only the linearisation.
  FrictionlessModes starting_modes(const CoupledSystem &whole, Run &run);

  /// Label with a number, for example `mode 3`.
  ModeLabel numbered_label(int number);

  /// Solves a system without a definite part for its modes, using LU factors of Q(s), and counts them, as steps of the run. Labels are
  /// numbers.
  FrictionModes direct_solution(const GivenSystem &given, Run &run);

  /// Number of modes in the rectangle of the band by the argument principle.
  struct CountedModes
  {
    ContourOptions contour;
    ContourCount   count;
  };

  /// Counts the modes of a system at a value of its varied parameter.
  ///
  /// @param frictionless not used for a system without a definite part
  CountedModes counted_modes(const CoupledSystem &system, double value, const FrictionlessModes &frictionless, Run &run);

  /// Counts modes by the argument principle in the rectangle of the band, as a step of the run; skipped if is_countable() is false. Throws
  /// SolverError if the count differs from the modes found.
  void count_modes(const GivenSystem &given, const FrictionlessModes &frictionless, const FrictionModes &friction, Run &run);

  /// Columns of a table of modes: backward errors, condition numbers and relative errors of λ [-].
  Columns<int> accuracy_columns(const GivenSystem &given, const JudgedModes &modes);

  /// Columns of a table of modes, by mode index: shares of the groups of dofs in the kinetic energy, φ_gᴴ (M φ)_g / φᴴ M φ [%].
  Columns<int> group_columns(const GivenSystem &given, const ComplexModes &modes);
} // namespace Squeal
