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

  /// The system file of the parameters at the values that they give.
  struct GivenSystem
  {
    SystemFile      file;
    ParameterValues values;
    CoupledSystem   coupled;
    double          value; ///< of the varied parameter of the coupled system
  };
  GivenSystem given_system(Run &run);

  /**
   * Modes of an imported system without skew terms, by the names `mode 1`, `mode 2`, ... that modes with all terms take from them; as
   * steps of the run. Its linearisation has no scene.
   *
   * @param system @p whole or a part of it, such as that without damping, which modes and factor are made from
   *
   * Throws SolverError if the system has no definite part.
   */
  FrictionlessModes imported_modes(const CoupledSystem &system, const CoupledSystem &whole, Run &run, double margin = 0.);

  /// Modes of a system without its damping, somewhat beyond the band, from which reduced models start; without a definite part only the
  /// linearisation.
  FrictionlessModes starting_modes(const CoupledSystem &whole, Run &run);

  /// `mode 3`.
  ModeLabel numbered_label(int number);

  /// Modes of a system without a definite part by LU factors of Q(s), counted, as steps of the run; named by their numbers.
  FrictionModes direct_solution(const GivenSystem &given, Run &run);

  /// Modes in the rectangle of the band by the argument principle.
  struct CountedModes
  {
    ContourOptions contour;
    ContourCount   count;
  };

  /// @param frictionless of no matter for a system without a definite part
  CountedModes counted_modes(const CoupledSystem &system, double value, const FrictionlessModes &frictionless, Run &run);

  /// Counts modes by the argument principle in the rectangle of the band, as a step of the run. Throws SolverError unless as many were found.
  void count_modes(const GivenSystem &given, const FrictionlessModes &frictionless, const FrictionModes &friction, Run &run);

  /// Columns of a table of modes: backward errors, condition numbers and relative errors of λ [-].
  Columns<int> accuracy_columns(const GivenSystem &given, const JudgedModes &modes);

  /// Columns of a table of modes, known by their numbers: shares of the kinetic energy of the groups of dofs, φ_gᴴ (M φ)_g / φᴴ M φ [%].
  Columns<int> group_columns(const GivenSystem &given, const ComplexModes &modes);
} // namespace Squeal
