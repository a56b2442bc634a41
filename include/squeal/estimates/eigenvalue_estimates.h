// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/modes/complex_modes.h>
#include <squeal/modes/reduced_modes.h>
#include <squeal/reduction/residual_products.h>

#include <complex>
#include <vector>

namespace Squeal
{
  /// Error estimates for λ of reduced eigentriples from their full-order residuals; see estimate_eigenvalues().
  struct EigenvalueEstimates
  {
    std::vector<std::complex<double>> corrections;   ///< δλ; λ + δλ is usually more accurate than λ [rad/s]
    std::vector<double>               errors;        ///< |δλ| / |λ| [-]
    std::vector<double>               conditions;    ///< κ [-]
    std::vector<bool>                 claimed;       ///< true if κ is moderate and the mode cannot coalesce: δλ is meaningful
    std::vector<double>               uncertainties; ///< |δλ| plus the effect of close modes [rad/s]
    std::vector<Verdict>              verdicts;
    std::vector<double>               energy_residuals; ///< ε_res of φ, eq. (16) [-]
    std::vector<double>               left_residuals;   ///< ε_res of ψ [-]
    ComplexDenseMatrix                couplings;        ///< D, k × k: D_ij = L_iᵀ K_c⁻¹ R_j / ψ_iᵀQ'(λ_i)φ_i [rad/s]
  };

  /// Full-order residuals of reduced eigentriples, n × 2k: real, then imaginary parts.
  struct ResidualVectors
  {
    MultiVector right_forces, left_forces;               ///< R_F and L_F
    MultiVector right_displacements, left_displacements; ///< K_c⁻¹ R_F and K_c⁻¹ L_F

    ResidualProducts products() const;
  };

  ResidualVectors residual_vectors(const CoupledSystem  &system,
                                   const UpdatedInverse &inverse,
                                   const ReducedModel   &model,
                                   const ReducedModes   &modes);

  /**
   * Estimates errors of reduced eigenvalues from right and left residuals, R_F = Q(λ)φ and L_F = Q(λ)ᵀψ with φ = T φ_r, ψ = T ψ_r. A
   * Galerkin step that adds K_c⁻¹ R_F and K_c⁻¹ L_F changes λ by
   *
   *   ψᵀQ'(λ)φ δλ + ψᵀMφ δλ² = L_Fᵀ K_c⁻¹ R_F;
   *
   * δλ is the smaller root.
   *
   * The condition number of an eigenvalue,
   *
   *   κ = 2 |λ| ‖ψ‖_M ‖φ‖_M / |ψᵀQ'(λ)φ|,
   *
   * is one for a symmetric problem and infinite at a coalescence: a relative change ε of the matrices moves λ by at most κ ε/2 |λ|. Two
   * modes may coalesce within the error of the reduction if
   *
   *   4 |g_ij g_ji| s² ≥ |λ_i − λ_j|²,   g_ij = L_iᵀ K_c⁻¹ R_j / ψ_iᵀQ'(λ_i)φ_i,
   *
   * with the safety factor s = error_safety. In this case, or if κ > 1000, δλ is not meaningful (`claimed` is false). The uncertainty of
   * λ_i is |δλ_i| + Σ |g_ij| over the modes j that may coalesce with it (Gershgorin's bound).
   *
   * Verdicts follow from verdict_of() with this uncertainty; a mode with κ > 1000 is undecided. For verdicts without damping, two modes may
   * also coalesce if s |δλ_i − δλ_j| ≥ |λ_i − λ_j|.
   *
   * If the inverse has a shift, the shifted stiffness replaces K_c.
   */
  EigenvalueEstimates estimate_eigenvalues(const ReducedModes &modes, const ResidualProducts &products);

  /// Right and left vectors at full order, with their residuals; @p estimates may be null.
  ComplexModes full_order_modes(const CoupledSystem       &system,
                                const UpdatedInverse      &inverse,
                                const ReducedModel        &model,
                                const ReducedModes        &modes,
                                const EigenvalueEstimates *estimates);
} // namespace Squeal
