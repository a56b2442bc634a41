#pragma once

#include <squeal/base/progress.h>
#include <squeal/stability/complex_modes.h>

namespace Squeal
{
  /// How far the basis of a residual iteration is grown.
  struct ResidualIterationOptions
  {
    double largest_frequency = 0.;   ///< end of the band [rad/s]
    double tolerance         = 1e-7; ///< on the estimated |δλ| / |λ| of every mode [-]
    int    maximum_basis     = 1500; ///< vectors
    int    maximum_steps     = 30;
  };

  /**
   * Complex modes by residual iteration (Bobillot; section 4.3 of the paper),
   * made two-sided. The basis starts from the real modes Φ_R and their
   * responses to friction and damping of first order, right and left,
   *
   *   K_c⁻¹ A V_K Φ_R,  K_c⁻¹ V_Kᵀ Aᵀ Φ_R,  K_c⁻¹ C_c Φ_R
   *
   * (that to modal damping, K_c⁻¹ M_c Φ_R diag(2 ζ ω) = Φ_R diag(2 ζ / ω), is in
   * their span already), and grows by the displacement residuals K_c⁻¹ R_F and
   * K_c⁻¹ L_F of the right and left reduced eigenvectors of all modes that are
   * not accurate yet, compressed by their principal axes in the M-norm. The
   * error of an eigenvalue is estimated from both residuals: with R_F = Q(λ)φ,
   * L_F = Q(λ)ᵀψ (ψᵀ the left eigenvector, no conjugate) the next Galerkin step
   * changes λ by
   *
   *   ψᵀQ'(λ)φ δλ + ψᵀMφ δλ² = L_Fᵀ K_c⁻¹ R_F,
   *
   * of which the smaller root is taken: near a coalescence ψᵀQ'φ vanishes, and
   * the estimate goes over to the square root that holds there.
   *
   * One Cholesky factor of K_c serves every step and every μ.
   *
   * @param real_modes Φ_R, n × n_R, M-orthonormal
   * @param inverse    factor of K_c (or of the shifted stiffness) and K_c⁻¹ A
   *
   * Throws SolverError if the basis reaches its largest size before the tolerance.
   */
  ComplexModes residual_iteration(const CoupledSystem            &system,
                                  const UpdatedInverse           &inverse,
                                  const MultiVector              &real_modes,
                                  double                          mu,
                                  const ResidualIterationOptions &options,
                                  Progress                       &progress);
} // namespace Squeal
