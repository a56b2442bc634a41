#pragma once

#include <squeal/linear_algebra/dense.h>

namespace Squeal
{
  /// Orthonormal basis Q of the span of the columns of X, and R of X = Q R; a dependent column leaves zeros in Q, and R_jj = 0.
  template <typename Matrix>
  struct OrthonormalBasis
  {
    Matrix Q, R;
  };

  /**
   * By the Gram-Schmidt process. @p is_independent decides on the norm of what is left of a column, as a part of that of the
   * column.
   */
  template <typename Matrix, typename Predicate>
  OrthonormalBasis<Matrix> orthonormal_basis(const Matrix &X, const Predicate &is_independent)
  {
    OrthonormalBasis<Matrix> basis{X, Matrix::Zero(X.cols(), X.cols())};
    auto &[Q, R] = basis;
    for (Eigen::Index j = 0; j < X.cols(); ++j)
      {
        const double before = Q.col(j).norm();
        // Twice is enough (W. Kahan, B. Parlett)
        for (int pass = 0; pass < 2 && j > 0; ++pass)
          {
            const Matrix c = Q.leftCols(j).adjoint() * Q.col(j);
            R.col(j).head(j) += c;
            Q.col(j).noalias() -= Q.leftCols(j) * c;
          }
        const double after = Q.col(j).norm();
        if (is_independent(after / before))
          {
            R(j, j) = after;
            Q.col(j) /= after;
          }
        else
          Q.col(j).setZero();
      }
    return basis;
  }
} // namespace Squeal
