// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/modes/complex_modes.h>

#include <vector>

namespace Squeal
{
  /**
   * How much of the arithmetic precision ε the eigenvalues of a run keep. All quantities are dimensionless and do not change with the
   * units of length, mass and time.
   *
   * Condition numbers of matrices are those of D A D with D = diag(A)^(-1/2), on which alone the rounding errors of a Cholesky
   * factor hang (A. van der Sluis, Numerische Mathematik 14 (1969) 14–23), estimated from within by Lanczos' method.
   *
   * Error of an eigenvalue of (λ² M̃ + λ C̃ + K̃) φ = 0, of first order:
   *
   *   |δλ| / |λ| = ½ κ (√ε_res + ε γ),   γ = |φ|ᵀ |K| |φ| / φᴴ K φ
   *
   * Where the solver estimates its error by left and right residuals, that stands for ½ κ √ε_res, which is too large for modes of a basis.
   * ε_res (ComplexModes::energy_residuals) measures the residual by the energy of the displacements that it causes; γ is the factor by
   * which relative errors ε of the entries of K, such as those of assembly, change φᴴ K φ. It is large where parts of the
   * stiffness cancel, as for the bending of a thin plate.
   *
   * κ = √(G_jj (G⁻¹)_jj), the condition number of λ within the space of the modes found and their conjugates, with the
   * energies of pairs of states (φ_i, λ_i φ_i),
   *
   *   G_ij = φ_iᴴ K φ_j + λ̄_i λ_j φ_iᴴ M φ_j        2k × 2k
   *
   * Members of a multiple eigenvalue (1e-7 of it) have one κ, that of their space. It is 1 without friction and damping, infinite
   * at a coalescence, and a lower bound: parts of the left vectors in modes beyond the band are not in it.
   */
  struct Conditioning
  {
    double              stiffness; ///< condition number of K_c, or of the shifted matrix that is factorised in its place [-]
    double              mass;      ///< of M_c [-]
    std::vector<double> modes;     ///< κ of each λ [-]
    std::vector<double> errors;    ///< |δλ| / |λ| of each λ [-]
    double              largest_cancellation = 1.; ///< largest γ [-]
    double              span                 = 1.; ///< condition number of G, that of the problem projected on the modes found [-]
    double              largest_residual     = 0.; ///< largest √ε_res [-]

    double largest_error() const;

    /// Decimal digits that every eigenvalue of the band keeps, −log₁₀ of the largest error, 0 at least.
    double digits() const;
  };

  /// ‖x + iy‖ of corresponding columns.
  std::vector<double> complex_norms(const MultiVector &real_part, const MultiVector &imaginary_part);

  /// w(λ) = Σ |θ_k λ^(p_k)| ‖A_k‖_∞ of the terms, at least ‖Q(λ)‖.
  std::vector<double> pencil_norms(const CoupledSystem                     &system,
                                   const ParameterValues                   &values,
                                   const std::vector<std::complex<double>> &lambda);

  /// η = ‖Q(λ)φ‖ / (w ‖φ‖) of each mode [-].
  std::vector<double> backward_errors(const CoupledSystem &system, const ParameterValues &values, const ComplexModes &modes);

  /// [Re Φ, Im Φ]ᵀ A [Re Φ, Im Φ] of modes Φ and the frictionless A = K_c, M_c.
  struct ModalProducts
  {
    DenseMatrix stiffness, mass;
  };

  ModalProducts modal_products(const CoupledSystem &system, const ComplexModes &modes);

  /// Some 15 solves with one vector. @p products are those of modal_products(), or what a reduced model has of them.
  Conditioning estimate_conditioning(const CoupledSystem  &system,
                                     const UpdatedInverse &inverse,
                                     double                shift,
                                     const ComplexModes   &modes,
                                     const ModalProducts  &products);
} // namespace Squeal
