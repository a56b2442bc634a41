// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/modes/complex_modes.h>

#include <vector>

namespace Squeal
{
  /**
   * Condition numbers and estimated errors of the eigenvalues of a run, for the machine precision ε. All quantities are dimensionless and
   * independent of the units of length, mass and time.
   *
   * Condition numbers of matrices A are computed for D A D with D = diag(A)^(-1/2), which determines the rounding errors of a Cholesky
   * factor (A. van der Sluis, Numerische Mathematik 14 (1969) 14–23). They are lower bounds from Lanczos' method.
   *
   * First-order error of an eigenvalue of (λ² M̃ + λ C̃ + K̃) φ = 0:
   *
   *   |δλ| / |λ| = ½ κ (√ε_res + ε γ),   γ = |φ|ᵀ |K| |φ| / φᴴ K φ
   *
   * If the solver estimates its error from left and right residuals, this estimate replaces ½ κ √ε_res, which is too large for modes
   * computed in a reduced basis. ε_res (ComplexModes::energy_residuals) is the residual in the energy norm of the displacements that it
   * causes; γ is the factor by which relative errors ε of the entries of K, for example from assembly, change φᴴ K φ. γ is large if parts
   * of the stiffness cancel, as in bending of a thin plate.
   *
   * κ_j = √(G_jj (G⁻¹)_jj) is the condition number of λ_j in the space of the computed modes and their conjugates. G contains energy
   * products of the states (φ_i, λ_i φ_i),
   *
   *   G_ij = φ_iᴴ K φ_j + λ̄_i λ_j φ_iᴴ M φ_j        2k × 2k
   *
   * Members of a multiple eigenvalue (relative distance up to 1e-7) share the κ of their space. κ is 1 without friction and damping and
   * infinite at a coalescence. It is a lower bound, because components of the left vectors in modes beyond the band are neglected.
   */
  struct Conditioning
  {
    double              stiffness;                 ///< condition number of K_c, or of the shifted matrix that is factorised instead [-]
    double              mass;                      ///< condition number of M_c [-]
    std::vector<double> modes;                     ///< κ of each λ [-]
    std::vector<double> errors;                    ///< |δλ| / |λ| of each λ [-]
    double              largest_cancellation = 1.; ///< largest γ [-]
    double              span                 = 1.; ///< condition number of G for normalised states; large if modes are nearly dependent [-]
    double              largest_residual     = 0.; ///< largest √ε_res [-]

    double largest_error() const;

    /// Estimated number of correct decimal digits of all eigenvalues in the band: −log₁₀ of the largest error, at least 0.
    double digits() const;
  };

  /// ‖x + iy‖ of each pair of columns.
  std::vector<double> complex_norms(const MultiVector &real_part, const MultiVector &imaginary_part);

  /// w(λ) = Σ |θ_k λ^(p_k)| ‖A_k‖_∞ over the terms, an upper bound of ‖Q(λ)‖.
  std::vector<double> pencil_norms(const CoupledSystem                     &system,
                                   const ParameterValues                   &values,
                                   const std::vector<std::complex<double>> &lambda);

  /// η = ‖Q(λ)φ‖ / (w ‖φ‖) of each mode [-].
  std::vector<double> backward_errors(const CoupledSystem &system, const ParameterValues &values, const ComplexModes &modes);

  /// Products [Re Φ, Im Φ]ᵀ A [Re Φ, Im Φ] of modes Φ with the frictionless matrices A = K_c and M_c.
  struct ModalProducts
  {
    DenseMatrix stiffness, mass;
  };

  ModalProducts modal_products(const CoupledSystem &system, const ComplexModes &modes);

  /// Estimates all quantities of Conditioning with about 15 solves for one vector. @p products: from modal_products() or from a reduced
  /// model.
  Conditioning estimate_conditioning(const CoupledSystem  &system,
                                     const UpdatedInverse &inverse,
                                     double                shift,
                                     const ComplexModes   &modes,
                                     const ModalProducts  &products);
} // namespace Squeal
