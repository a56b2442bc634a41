#pragma once

#include <squeal/linear_algebra/dense.h>

#include <array>
#include <complex>
#include <vector>

namespace Squeal
{
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

  /// d(λ_1 − λ_2)²/dp = 2 (λ_1 − λ_2) (λ_1' − λ_2') of two modes [rad²/s² per unit of p].
  std::complex<double> squared_difference_derivative(const ComplexDenseMatrix                &N,
                                                     const ComplexDenseMatrix                &D,
                                                     const std::vector<std::complex<double>> &lambda,
                                                     int                                      first,
                                                     int                                      second);

  /**
   * The value at 0 of an even function, or of the even part of one, from its values at h, 2h, 3h (means of both sides), and how far
   * the value from two of them differs: an upper bound of the error unless the function has a singularity nearby.
   */
  struct ValueAtCentre
  {
    std::complex<double> value;
    double               error;
  };
  ValueAtCentre value_at_centre(const std::array<std::complex<double>, 3> &means);
} // namespace Squeal
