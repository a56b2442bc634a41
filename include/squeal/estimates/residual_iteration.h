// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/progress.h>
#include <squeal/estimates/eigenvalue_estimates.h>
#include <squeal/modes/complex_modes.h>

#include <optional>
#include <vector>

namespace Squeal
{
  /// How far the basis of a residual iteration is grown.
  struct ResidualIterationOptions
  {
    Band   band          = 0.;
    double tolerance     = 1e-7; ///< on the estimated |δλ| / |λ| of every mode [-]
    int    maximum_basis = 1500; ///< vectors
    int    maximum_steps = 30;
  };

  /// The model from which a residual iteration starts: the real modes Φ_R, with their responses of first order to damping and, if there is
  /// @p friction, to friction, right and left. Its basis is M_c-orthonormal.
  ReducedModel starting_model(const CoupledSystem &system, const UpdatedInverse &inverse, const MultiVector &real_modes, bool friction);

  /// Leaves what X has outside of the M-orthonormal basis of a model.
  void remove_basis(const SparseMatrix &M, const ReducedModel &model, MultiVector &X);

  /// Displacement residuals of the @p chosen modes, right and left, real and imaginary parts, each scaled to its mode: n × 4k.
  MultiVector residual_directions(const ResidualVectors &residuals, const ReducedModes &modes, const std::vector<int> &chosen);

  /// M_c-orthonormal vectors by which the basis of @p model grows: principal axes of what @p directions have outside of it; nothing if they
  /// lie in the basis or there are none.
  std::optional<MultiVector> new_vectors(const CoupledSystem            &system,
                                         const ReducedModel             &model,
                                         const std::vector<MultiVector> &directions);

  /// A two-sided basis grown by residuals, with what it gives at the friction coefficient of the largest error.
  struct GrownBasis
  {
    ReducedModel        model; ///< its basis is M_c-orthonormal
    ReducedModes        modes;
    EigenvalueEstimates estimates;
    double              worst_error; ///< largest estimated |δλ| / |λ| at all friction coefficients [-]
    int                 n_growths;
  };

  /**
   * Grows a basis by residuals (Bobillot; section 4.3 of the paper), made
   * two-sided, until the estimated errors of all modes and real eigenvalues
   * that the band lists are below the tolerance at every one of
   * the @p friction_coefficients. It starts from
   * the real modes Φ_R and their responses to friction and damping of first
   * order, right and left,
   *
   *   K_c⁻¹ A V_K Φ_R,  K_c⁻¹ V_Kᵀ Aᵀ Φ_R,  K_c⁻¹ C_c Φ_R,
   *
   * and grows, where the error is largest, by the displacement residuals K_c⁻¹ R_F
   * and K_c⁻¹ L_F of the right and left reduced eigenvectors of all modes that
   * are not accurate yet, compressed by their principal axes in the M-norm. See
   * estimate_eigenvalues() for the error of an eigenvalue.
   *
   * One Cholesky factor of K_c serves every step and every μ.
   *
   * @param real_modes Φ_R, n × n_R, M-orthonormal
   * @param inverse    factor of K_c (or of the shifted stiffness) and K_c⁻¹ A
   *
   * Throws SolverError if the basis reaches its largest size before the
   * tolerance. @p system must outlive the result.
   */
  GrownBasis grow_residual_basis(const CoupledSystem            &system,
                                 const UpdatedInverse           &inverse,
                                 const MultiVector              &real_modes,
                                 const std::vector<double>      &friction_coefficients,
                                 const ResidualIterationOptions &options,
                                 Progress                       &progress);

  /// Complex modes, right and left, from a basis grown at friction coefficient @p mu.
  ComplexModes residual_iteration(const CoupledSystem            &system,
                                  const UpdatedInverse           &inverse,
                                  const MultiVector              &real_modes,
                                  double                          mu,
                                  const ResidualIterationOptions &options,
                                  Progress                       &progress);
} // namespace Squeal
