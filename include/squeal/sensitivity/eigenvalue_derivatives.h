// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/contact_operators.h>
#include <squeal/contact/coupled_system.h>

#include <array>
#include <complex>
#include <vector>

namespace Squeal
{
  /// Eigenvalues with right and left vectors at full order, ψᵀ Q(λ) = 0 without conjugate, in any normalisation.
  struct Eigentriples
  {
    std::vector<std::complex<double>> lambda;      ///< [rad/s]
    MultiVector                       right, left; ///< φ and ψ, n × 2k: real parts, then imaginary parts
  };

  /**
   * Vectors u and w on the dofs of the uncoupled bodies through which a matrix X of a body contributes to Q:
   *
   *   ψᵀ (T_cᵀ X T_c − μ A V_X) φ = wᵀ X u,   u = T_c φ,   w = T_c ψ − μ Sᵀ P_t T_c ψ,
   *
   * because A = T_cᵀ P_tᵀ and V_X = S X T_c. Friction enters derivatives with respect to the bodies only through w.
   */
  Eigentriples on_bodies(const ContactOperators &contact, double friction_coefficient, const Eigentriples &coupled);

  /// Products of the terms of Q(λ; p) = Σ θ_k(p) λ^p_k A_k with right and left vectors, for derivatives with respect to all parameters. A
  /// direction s is given by rates dp/ds in a ParameterValues: one rate for a number, one for each entry of a list (for example, the
  /// damping coefficients of contact nodes).
  class TermProducts
  {
  public:
    /// Collective.
    TermProducts(const std::vector<Term> &terms, const Eigentriples &modes);

    /// ψ_iᵀ Q(λ_j) φ_j, k × k.
    ComplexDenseMatrix pencil(const ParameterValues &values) const;

    /// ψ_iᵀ ((λ_i + λ_j) M + C) φ_j, k × k: diagonal ψᵀ Q'(λ) φ; off-diagonal zero for exact vectors with λ_i ≠ λ_j.
    ComplexDenseMatrix by_lambda(const ParameterValues &values) const;

    /// ψ_iᵀ (dQ(λ_j)/ds) φ_j, k × k, along a direction of the parameters; parameters without a rate are constant.
    ComplexDenseMatrix along(const ParameterValues &values, const ParameterValues &rates) const;

  private:
    struct Product
    {
      Term               term;        ///< the term without its matrices
      ComplexDenseMatrix value;       ///< ψ_iᵀ A φ_j; empty for a term with weights
      ComplexDenseMatrix left, right; ///< Lᵀψ and Rᵀφ of a term with weights, m × k
    };

    /// ψ_iᵀ A φ_j of a term; @p weights contains the list parameter d of a term with weights: its values or their rates.
    ComplexDenseMatrix matrix(const Product &product, const ParameterValues &weights) const;

    std::vector<std::complex<double>> lambda;
    std::vector<Product>              products;
  };

  /**
   * Derivatives of eigenvalues of Q(λ; p) φ = 0, ψᵀ Q(λ; p) = 0 from
   *
   *   N_ij = ψ_iᵀ (∂Q(λ_j)/∂p) φ_j   and   D_ij = ψ_iᵀ ((λ_i + λ_j) M + C) φ_j        k × k, TermProducts
   *
   * with right and left vectors. For a simple eigenvalue
   *
   *   dλ_i/dp = −N_ii / D_ii
   *
   * (P. Lancaster, *On eigenvalues of matrices dependent on a parameter*, Numerische Mathematik 6 (1964) 377–387). If a pair nearly
   * coalesces, D_ii tends to zero, and neither eigenvalue has a derivative at the exceptional point. Their mean and their squared
   * difference are differentiable: on the span of the vectors, the pencil is represented by a matrix Λ, and Λ' = −D⁻¹ N in the basis of the
   * vectors φ.
   */
  std::complex<double> eigenvalue_derivative(const ComplexDenseMatrix &N, const ComplexDenseMatrix &D, int mode);

  /// Derivative of the mean of m eigenvalues, −trace(D⁻¹ N) / m of their m × m blocks; also exists for multiple eigenvalues.
  std::complex<double> mean_derivative(const ComplexDenseMatrix &N, const ComplexDenseMatrix &D, const std::vector<int> &modes);

  /// d(λ_1 − λ_2)²/dp = 2 (λ_1 − λ_2) (λ_1' − λ_2') for the first two modes [rad²/s² per unit of p].
  std::complex<double> squared_difference_derivative(const ComplexDenseMatrix                &N,
                                                     const ComplexDenseMatrix                &D,
                                                     const std::vector<std::complex<double>> &lambda);

  /// Value at 0 of the even part of a function, extrapolated from its means at ±h, ±2h and ±3h. The error is the difference from the
  /// extrapolation of two means, which usually overestimates the error of the value.
  struct ValueAtCentre
  {
    std::complex<double> value;
    double               error;
  };
  ValueAtCentre value_at_centre(const std::array<std::complex<double>, 3> &means);
} // namespace Squeal
