// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/coupled_system.h>
#include <squeal/eigen/symmetric_modes.h>
#include <squeal/linear_algebra/factorization.h>

#include <complex>
#include <vector>

namespace Squeal
{
  /// Range of λ and accuracy of a CondensedDeterminant.
  struct CondensedDeterminantRequest
  {
    std::vector<std::complex<double>> lambda; ///< points of the range with the largest truncation errors: its corners [rad/s]
    double                            largest_friction_coefficient = 0.;
    double                            tolerance                    = 1e-6; ///< largest spectral norm of the truncation error of N [-]
  };

  /**
   * The determinant of the pencil with friction, Q(λ) = S(λ) + E G(λ) with S = K_c + λ² M_c, condensed to the low-rank terms θ λ^p L
   * diag(d) Rᵀ, which are mainly contact terms:
   *
   *   det Q(λ) = det S(λ) det N(λ),   N(λ) = I + G(λ) S(λ)⁻¹ E
   *
   * The columns of E are the factors L; the corresponding rows of G are Σ θ λ^p diag(d) Rᵀ, summed over the terms with this L. For L = A,
   * friction gives the rows −μ (V_K + λ² V_M).
   *
   * S(λ)⁻¹ is summed over the real modes up to ω_d, Φ with Φᵀ S Φ = D = diag(ω_j² + λ²); on their M-orthogonal complement it is a Chebyshev
   * series in H = (K_c + s M_c)⁻¹ M_c, whose eigenvalues there are at most 1 / w, w = ω_d² + s:
   *
   *   S⁻¹ = Φ D⁻¹ Φᵀ + S_⊥⁻¹,   S_⊥⁻¹ = Σ_k c_k T_k(2 w H − I) P (K_c + s M_c)⁻¹
   *   c_k = (2 − δ_k0) ((1 − r) / (1 + r))ᵏ / r,   r = √((ω_d² + λ²) / w),   Re r > 0
   *
   * det N is the product of det N_⊥, which varies little in the band, and det W, where W is a small matrix with poles at the real modes, λ
   * = ±iω_j:
   *
   *   det N = det N_⊥ det W,   N_⊥ = I + G S_⊥⁻¹ E,   W = I + D⁻¹ Φᵀ E N_⊥⁻¹ G Φ
   *
   * The series converges for all λ except ±iω, ω ≥ ω_d. The moments Rᵀ T_k ... E are small matrices that do not depend on μ. Because |T_k|
   * ≤ 1 in the inner product of K_c + s M_c, the truncation error of N after m terms is bounded by
   *
   *   ‖G (K_c + s M_c)^−½‖ Σ_{k > m} |c_k| ‖(K_c + s M_c)^−½ E‖   on the complement.
   */
  class CondensedDeterminant
  {
  public:
    /**
     * @param modes          all real modes up to @p deflation_end, at least one
     * @param deflation_end  ω_d [rad/s]
     * @param inverse        (K_c + s M_c)⁻¹
     * @param shift          s ≥ 0 [rad²/s²]
     *
     * Throws SolverError if there are sparse terms other than K_c and M_c, for example damping of the bodies. The system must outlive this
     * object.
     */
    CondensedDeterminant(const CoupledSystem               &system,
                         const SymmetricModes              &modes,
                         double                             deflation_end,
                         const LinearOperator              &inverse,
                         double                             shift,
                         const CondensedDeterminantRequest &request);

    /// N_⊥(λ).
    ComplexDenseMatrix complement(std::complex<double> lambda, double mu) const;

    /// W(λ), and bounds for the inverse of N.
    struct OnModes
    {
      ComplexDenseMatrix                matrix;             ///< W; its size is the number of modes
      std::vector<std::complex<double>> resonances;         ///< diagonal of D⁻¹
      double                            complement_inverse; ///< bound of ‖N_⊥⁻¹‖
      double                            gain;               ///< ‖N⁻¹‖ ≤ ‖N_⊥⁻¹‖ + gain ‖W⁻¹ D⁻¹‖
    };
    OnModes on_modes(std::complex<double> lambda, double mu) const;

    /// Bound of the spectral norm of the truncation error of N(λ) [-].
    double truncation(std::complex<double> lambda, double mu) const;

    std::vector<double> frequencies;   ///< ω_j of the modes in Φ, 0 for rigid-body modes [rad/s]
    int                 n_moments = 0; ///< number of terms of the series

  private:
    /// Rows of G from one term.
    struct Block
    {
      const Term              *term;
      int                      first_row;
      DenseMatrix              on_modes; ///< RᵀΦ
      std::vector<DenseMatrix> moments;  ///< Rᵀ T_k P (K + s M)⁻¹ E
      double                   norm;     ///< norm of diag(d) Rᵀ (K + s M)^−½ on the complement
    };

    const CoupledSystem &system;
    double               deflation_square, shift;
    std::vector<Block>   blocks;
    int                  n_rows      = 0;  ///< size of N
    double               forces_norm = 0.; ///< ‖(K + s M)^−½ E‖ on the complement
    ComplexDenseMatrix   modes_forces;     ///< ΦᵀE
  };
} // namespace Squeal
