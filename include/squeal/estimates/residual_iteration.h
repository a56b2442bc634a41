// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/progress.h>
#include <squeal/estimates/eigenvalue_estimates.h>
#include <squeal/modes/complex_modes.h>

#include <optional>
#include <vector>

namespace Squeal
{
  /// Stopping criteria of a residual iteration.
  struct ResidualIterationOptions
  {
    Band   band          = 0.;
    double tolerance     = 1e-7; ///< limit for the estimated |δλ| / |λ| of every mode [-]
    int    maximum_basis = 1500; ///< largest number of basis vectors
    int    maximum_steps = 30;
  };

  /// Starting model of a residual iteration: the real modes Φ_R and their first-order responses to damping and, if @p friction is set, to
  /// friction (right and left). The basis is M_c-orthonormal.
  ReducedModel starting_model(const CoupledSystem &system, const UpdatedInverse &inverse, const MultiVector &real_modes, bool friction);

  /// Removes from X its projection on the M-orthonormal basis of a model.
  void remove_basis(const SparseMatrix &M, const ReducedModel &model, MultiVector &X);

  /// Displacement residuals of the @p chosen modes, right and left, real and imaginary parts, each divided by the norm of its mode: n × 4k.
  MultiVector residual_directions(const ResidualVectors &residuals, const ReducedModes &modes, const std::vector<int> &chosen);

  /// M_c-orthonormal vectors that extend the basis of @p model: principal axes of the components of @p directions outside the basis;
  /// nothing if these components vanish.
  std::optional<MultiVector> new_vectors(const CoupledSystem            &system,
                                         const ReducedModel             &model,
                                         const std::vector<MultiVector> &directions);

  /// A two-sided basis enriched by residuals, and its results at the friction coefficient with the largest error.
  struct GrownBasis
  {
    ReducedModel        model; ///< reduced model with an M_c-orthonormal basis
    ReducedModes        modes;
    EigenvalueEstimates estimates;
    double              worst_error; ///< largest estimated |δλ| / |λ| at all friction coefficients [-]
    int                 n_growths;
  };

  /**
   * Enriches a two-sided basis by residuals (Bobillot; section 4.3 of the paper) until the estimated errors of all modes and real
   * eigenvalues in the band are below the tolerance at each of the @p friction_coefficients; see estimate_eigenvalues() for the errors. The
   * basis starts from the real modes Φ_R and their first-order responses to friction and damping, right and left,
   *
   *   K_c⁻¹ A V_K Φ_R,  K_c⁻¹ V_Kᵀ Aᵀ Φ_R,  K_c⁻¹ C_c Φ_R.
   *
   * It is extended at the friction coefficient with the largest error by the displacement residuals K_c⁻¹ R_F and K_c⁻¹ L_F of all modes
   * above the tolerance, compressed to their principal axes in the M-norm.
   *
   * One Cholesky factor of K_c is reused for every step and every μ.
   *
   * @param real_modes Φ_R, n × n_R, M-orthonormal
   * @param inverse    factor of K_c (or of the shifted stiffness) and K_c⁻¹ A
   *
   * Throws SolverError if the errors do not meet the tolerance within the limits of the options. @p system must outlive the result.
   */
  GrownBasis grow_residual_basis(const CoupledSystem            &system,
                                 const UpdatedInverse           &inverse,
                                 const MultiVector              &real_modes,
                                 const std::vector<double>      &friction_coefficients,
                                 const ResidualIterationOptions &options,
                                 Progress                       &progress);

  /// Complex modes, right and left, from a basis enriched at the friction coefficient @p mu.
  ComplexModes residual_iteration(const CoupledSystem            &system,
                                  const UpdatedInverse           &inverse,
                                  const MultiVector              &real_modes,
                                  double                          mu,
                                  const ResidualIterationOptions &options,
                                  Progress                       &progress);
} // namespace Squeal
