// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/updated_inverse.h>
#include <squeal/eigen/symmetric_modes.h>
#include <squeal/modes/complex_modes.h>
#include <squeal/modes/contour_count.h>
#include <squeal/parameters/analysis.h>

#include <memory>
#include <string>
#include <vector>

namespace Squeal
{
  /// Modes of a coupled system without friction, and the inverse that serves them and every μ: terms are all that they need, no mesh.
  struct SystemModes
  {
    double                          shift = 0.; ///< of the inverse [rad/s]; positive if a body is free
    std::shared_ptr<UpdatedInverse> inverse;
    SymmetricModes                  real;                    ///< in the band and its margin
    Cost                            factorisation, solution; ///< of the inverse, and of the real modes
  };

  /// How the parameters want real modes of @p what to be found, shifted by @p shift [rad/s] where bodies are free.
  SymmetricModesOptions real_modes_options(const SolverParameters &solvers, const std::string &what, double shift);

  /// Counts the modes of the band as a step of @p progress, and refuses more than the parameters allow before any is computed (throws
  /// ParameterError): counting them takes one factorisation.
  ModeCount number_of_modes(const CoupledSystem    &system,
                            double                  largest_circular_frequency,
                            const SolverParameters &solvers,
                            Progress               &progress);

  /**
   * The factorisation and the real modes of the system, as steps of @p progress. Throws SolverError if none lies in the band.
   *
   * @param shift s ≥ 0 [rad/s] with which K_c + s² M_c is positive definite; without damping in the system unless it is zero
   * @param count of the band and its margin
   */
  SystemModes system_modes(const CoupledSystem    &system,
                           double                  shift,
                           double                  largest_circular_frequency,
                           const ModeCount        &count,
                           int                     block_size,
                           const SolverParameters &solvers,
                           Progress               &progress);

  /// Modes inside the band, of ascending @p eigenvalues [rad²/s²].
  std::size_t n_in_band(const std::vector<double> &eigenvalues, double largest_eigenvalue);

  /// The rectangle of the band in which count_by_contour() counts modes of a system of which @p frictionless are modes without damping.
  ContourOptions contour_of_band(const CoupledSystem    &system,
                                 const SystemModes      &frictionless,
                                 const Band             &band,
                                 const SolverParameters &solvers);

  /**
   * Complex modes at full order by shift-invert block Krylov on the sparse nonsymmetric quadratic pencil at friction coefficient @p mu: the
   * reference.
   *
   * @param inverse    factor and attachment modes of the frictionless system at @p shift
   * @param n_expected real modes in the band, which tells how many to look for
   * @param real_modes these, from which the process then starts; null: none
   *
   * Where the stiffness with friction is almost singular without a shift, a factor with a shift is made for this μ.
   *
   * Throws SolverError if a mode misses the tolerance, or if there is modal damping and the shift is not zero.
   */
  ComplexModes krylov_modes(const CoupledSystem    &system,
                            UpdatedInverse         &inverse,
                            double                  shift,
                            double                  mu,
                            const Band             &band,
                            int                     n_expected,
                            const SolverParameters &parameters,
                            Progress               &progress,
                            const MultiVector      *real_modes = nullptr);
} // namespace Squeal
