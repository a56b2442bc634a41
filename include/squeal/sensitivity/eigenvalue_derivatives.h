// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/contact_operators.h>
#include <squeal/contact/coupled_system.h>

#include <array>
#include <complex>
#include <vector>

namespace Squeal
{
  /// Eigenvalues with right and left vectors at full order, ψᵀ Q(λ) = 0 without conjugate, of any length.
  struct Eigentriples
  {
    std::vector<std::complex<double>> lambda;      ///< [rad/s]
    MultiVector                       right, left; ///< φ and ψ, n × 2k: real parts, then imaginary parts
  };

  /**
   * The vectors u and w on the dofs of the uncoupled bodies with which every matrix X of a body contributes to Q,
   *
   *   ψᵀ (T_cᵀ X T_c − μ A V_X) φ = wᵀ X u,   u = T_c φ,   w = T_c ψ − μ Sᵀ P_t T_c ψ,
   *
   * since A = T_cᵀ P_tᵀ and V_X = S X T_c: friction takes part in every derivative with respect to a body by w alone.
   */
  Eigentriples on_bodies(const ContactOperators &contact, double friction_coefficient, const Eigentriples &coupled);

  /// Products of the terms of Q(λ; p) = Σ θ_k(p) λ^p_k A_k with right and left vectors, from which follow its derivatives with respect to
  /// every parameter. Rates of parameters, a ParameterValues with dp/ds, give a direction s: one rate for a parameter that is a number, and
  /// one for each entry of a list, such as damping coefficients of contact nodes.
  class TermProducts
  {
  public:
    /// All processes must call.
    TermProducts(const std::vector<Term> &terms, const Eigentriples &modes);

    /// ψ_iᵀ Q(λ_j) φ_j, k × k.
    ComplexDenseMatrix pencil(const ParameterValues &values) const;

    /// ψ_iᵀ ((λ_i + λ_j) M + C) φ_j, k × k: on the diagonal ψᵀ Q'(λ) φ, zero elsewhere for exact vectors of λ_i ≠ λ_j.
    ComplexDenseMatrix by_lambda(const ParameterValues &values) const;

    /// ψ_iᵀ (dQ(λ_j)/ds) φ_j, k × k, along a direction of the parameters; parameters without a rate keep their values.
    ComplexDenseMatrix along(const ParameterValues &values, const ParameterValues &rates) const;

  private:
    /// Of one term.
    struct Product
    {
      Term               term;        ///< without its matrices
      ComplexDenseMatrix value;       ///< ψ_iᵀ A φ_j; empty for a term with weights
      ComplexDenseMatrix left, right; ///< Lᵀψ and Rᵀφ of a term with weights, m × k
    };

    /// ψ_iᵀ A φ_j of a term, with @p weights in place of its own values.
    ComplexDenseMatrix matrix(const Product &product, const ParameterValues &weights) const;

    std::vector<std::complex<double>> lambda;
    std::vector<Product>              products;
  };

  /**
   * Derivatives of eigenvalues of Q(λ; p) φ = 0, ψᵀ Q(λ; p) = 0 from
   *
   *   N_ij = ψ_iᵀ (∂Q(λ_j)/∂p) φ_j   and   D_ij = ψ_iᵀ ((λ_i + λ_j) M + C) φ_j        k × k, TermProducts
   *
   * of right and left vectors. Of a simple eigenvalue it is
   *
   *   dλ_i/dp = −N_ii / D_ii
   *
   * (P. Lancaster, *On eigenvalues of matrices dependent on a parameter*, Numerische Mathematik 6 (1964) 377–387). Where a pair
   * nearly coalesces D_ii tends to zero, and no eigenvalue of the pair has a derivative at the exceptional point, but its mean and
   * the square of its difference have: on the span of the vectors the pencil is a matrix Λ, and Λ' = −D⁻¹ N in the basis of the φ.
   */
  std::complex<double> eigenvalue_derivative(const ComplexDenseMatrix &N, const ComplexDenseMatrix &D, int mode);

  /// Derivative of the mean of some eigenvalues, −trace(D⁻¹ N) / m of their m × m blocks; exists at multiple eigenvalues, too.
  std::complex<double> mean_derivative(const ComplexDenseMatrix &N, const ComplexDenseMatrix &D, const std::vector<int> &modes);

  /// d(λ_1 − λ_2)²/dp = 2 (λ_1 − λ_2) (λ_1' − λ_2') of the first two modes [rad²/s² per unit of p].
  std::complex<double> squared_difference_derivative(const ComplexDenseMatrix                &N,
                                                     const ComplexDenseMatrix                &D,
                                                     const std::vector<std::complex<double>> &lambda);

  /// The value at 0 of an even function, or of the even part of one, from its values at h, 2h, 3h (means of both sides), and how far the
  /// value from two of them differs: an upper bound of the error unless the function has a singularity nearby.
  struct ValueAtCentre
  {
    std::complex<double> value;
    double               error;
  };
  ValueAtCentre value_at_centre(const std::array<std::complex<double>, 3> &means);
} // namespace Squeal
