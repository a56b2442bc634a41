// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/dense_lu.h>

#include <cmath>
#include <limits>
#include <string>

namespace Squeal
{
  namespace
  {
    /// Reciprocal condition number below which a matrix counts as singular; rounding gives exactly singular matrices 10⁻¹⁷ to 10⁻¹⁵ [-].
    constexpr double singular_condition = 1e-14;
    /// Smaller limit for Q(λ), which is nearly singular close to an eigenvalue [-].
    constexpr double singular_complex_condition = 1e-16;
  } // namespace

  template <typename Matrix>
  DenseLU<Matrix>::DenseLU(const Matrix &A)
    : norm(A.size() == 0 ? 0. : A.cwiseAbs().colwise().sum().template maxCoeff<Eigen::PropagateNaN>())
  {
    // Do not factorise matrices with non-finite entries, whose LU factors are undefined
    if (!std::isfinite(norm))
      return;
    factors.compute(A);
    if (A.size() == 0)
      rcond = 1.;
    else if ((factors.matrixLU().diagonal().array() != 0.).all())
      rcond = factors.rcond();
  }

  template <typename Matrix>
  double DenseLU<Matrix>::inverse_norm() const
  {
    if (factors.rows() == 0 && norm == 0.)
      return 0.;
    return rcond > singular_complex_condition ? 1. / (rcond * norm) : std::numeric_limits<double>::infinity();
  }

  template <typename Matrix>
  std::complex<double> DenseLU<Matrix>::log_determinant() const
  {
    double modulus = 0., argument = factors.permutationP().determinant() < 0 ? M_PI : 0.;
    for (const auto &pivot : factors.matrixLU().diagonal())
      {
        modulus += std::log(std::abs(pivot));
        argument += std::arg(pivot);
      }
    return {modulus, std::remainder(argument, 2. * M_PI)};
  }

  // Eigen's solve() accesses the first entry, which does not exist in a matrix without columns
  template <typename Matrix>
  Matrix DenseLU<Matrix>::solve(const Matrix &B) const
  {
    return B.cols() == 0 ? B : Matrix(factors.solve(B));
  }

  template <typename Matrix>
  Matrix DenseLU<Matrix>::solve_transposed(const Matrix &B) const
  {
    return B.cols() == 0 ? B : Matrix(factors.transpose().solve(B));
  }

  template class DenseLU<DenseMatrix>;
  template class DenseLU<ComplexDenseMatrix>;

  RealLU regular_lu(const DenseMatrix &A, const char *what)
  {
    RealLU factors(A);
    if (!(factors.reciprocal_condition() > singular_condition))
      throw SolverError("a dense matrix of size " + std::to_string(A.rows()) + " is singular to working precision or not finite", what,
                        "check for linearly dependent vectors, or for a parameter value at which the problem becomes singular");
    return factors;
  }

  ComplexDenseMatrix balanced(ComplexDenseMatrix A)
  {
    // Few sweeps are sufficient because the exact minimum is not needed
    for (int sweep = 0; sweep < 5; ++sweep)
      for (Eigen::Index k = 0; k < A.rows(); ++k)
        {
          const std::complex<double> diagonal = A(k, k);
          A(k, k)                             = 0.;
          const double scale                  = std::sqrt(A.row(k).norm() / A.col(k).norm());
          if (scale > 0. && std::isfinite(scale))
            {
              A.col(k) *= scale;
              A.row(k) /= scale;
            }
          A(k, k) = diagonal;
        }
    return A;
  }
} // namespace Squeal
