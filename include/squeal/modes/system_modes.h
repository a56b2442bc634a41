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
  /// Modes of a coupled system without friction, and an inverse that is updated for each friction coefficient; computed from terms, without
  /// a mesh.
  struct SystemModes
  {
    double                          shift = 0.; ///< shift of the inverse [rad/s]; positive if a body has rigid-body motions
    std::shared_ptr<UpdatedInverse> inverse;
    SymmetricModes                  real;                    ///< real modes in the band and its margin
    Cost                            factorisation, solution; ///< cost of the inverse and of the real modes
  };

  /// Solver options for the real modes of @p what; @p shift [rad/s] is positive if bodies have rigid-body motions.
  SymmetricModesOptions real_modes_options(const SolverParameters &solvers, const std::string &what, double shift);

  /// Counts the modes of the band by one factorisation, as a step of @p progress. Throws ParameterError if there are more modes than the
  /// parameters allow.
  ModeCount number_of_modes(const CoupledSystem    &system,
                            double                  largest_circular_frequency,
                            const SolverParameters &solvers,
                            Progress               &progress);

  /**
   * Factorises the system and computes its real modes, as steps of @p progress. Throws SolverError if no mode is in the band.
   *
   * @param shift s ≥ 0 [rad/s] that makes K_c + s² M_c positive definite
   * @param count number of modes in the band and its margin
   */
  SystemModes system_modes(const CoupledSystem    &system,
                           double                  shift,
                           double                  largest_circular_frequency,
                           const ModeCount        &count,
                           int                     block_size,
                           const SolverParameters &solvers,
                           Progress               &progress);

  /// Number of ascending @p eigenvalues [rad²/s²] in the band.
  std::size_t n_in_band(const std::vector<double> &eigenvalues, double largest_eigenvalue);

  /// Rectangle of the band for count_by_contour(); @p frictionless are the modes of the system without damping.
  ContourOptions contour_of_band(const CoupledSystem    &system,
                                 const SystemModes      &frictionless,
                                 const Band             &band,
                                 const SolverParameters &solvers);

  /**
   * Reference complex modes at full order by shift-invert block Krylov on the sparse nonsymmetric quadratic pencil at the friction
   * coefficient @p mu.
   *
   * @param inverse    factor and attachment modes of the frictionless system at @p shift
   * @param n_expected number of real modes in the band, an estimate of the number of complex modes
   * @param real_modes these real modes, as starting vectors; null: none
   *
   * If the stiffness with friction is almost singular, it is factorised with a shift for this μ.
   *
   * Throws SolverError if a mode does not meet the tolerance, or if there is modal damping and the shift is not zero.
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
