// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense.h>

#include <Eigen/LU>

namespace Squeal
{
  /// LU factors of a small square matrix, possibly singular, with an estimate of ‖A⁻¹‖₁.
  template <typename Matrix>
  class DenseLU
  {
  public:
    explicit DenseLU(const Matrix &A);

    /// A⁻¹ B and A⁻ᵀ B; defined only if the reciprocal condition is nonzero. B may have no columns.
    [[nodiscard]] Matrix solve(const Matrix &B) const;
    [[nodiscard]] Matrix solve_transposed(const Matrix &B) const;

    /// Estimated 1 / (‖A‖₁ ‖A⁻¹‖₁); 0 for a zero pivot and for entries that are not finite.
    double reciprocal_condition() const
    {
      return rcond;
    }

    /// Estimate of ‖A⁻¹‖₁; infinite if A is singular to working precision.
    double inverse_norm() const;

    /// Logarithm of det A: the sum of the logarithms of the pivots, imaginary part in [−π, π]; −∞ for a zero pivot.
    std::complex<double> log_determinant() const;

  private:
    Eigen::PartialPivLU<Matrix> factors;
    double                      norm, rcond = 0.;
  };

  using RealLU    = DenseLU<DenseMatrix>;
  using ComplexLU = DenseLU<ComplexDenseMatrix>;

  /// LU factors of a regular matrix. Throws a SolverError that names @p what if the matrix is singular to working precision.
  RealLU regular_lu(const DenseMatrix &A, const char *what);

  /// S⁻¹ A S with a positive diagonal S that reduces the norm by making the norms of row i and column i nearly equal (Osborne).
  ComplexDenseMatrix balanced(ComplexDenseMatrix A);
} // namespace Squeal
