#pragma once

#include <squeal/linear_algebra/dense.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include <optional>

namespace Squeal
{
  /// Orthonormal basis Q of the span of the columns of X, and R of X = Q R; a dependent column leaves zeros in Q, and R_jj = 0.
  template <typename Matrix>
  struct OrthonormalBasis
  {
    Matrix Q, R;
  };

  /// By Cholesky factors of XᴴX, twice (CholeskyQR2: T. Fukaya et al., 2014), in a few products of blocks. Nothing where a column leaves
  /// less than 10⁻³ of itself beside those before it: squares of such parts drown in rounding errors.
  template <typename Matrix>
  std::optional<OrthonormalBasis<Matrix>> basis_by_cholesky(const Matrix &X)
  {
    constexpr double         least_part = 1e-3;
    OrthonormalBasis<Matrix> basis{X, Matrix::Identity(X.cols(), X.cols())};
    for (int pass = 0; pass < 2; ++pass)
      {
        const Matrix             G = basis.Q.adjoint() * basis.Q;
        const Eigen::LLT<Matrix> cholesky(G);
        const Matrix             R = cholesky.matrixU();
        if (cholesky.info() != Eigen::Success || !(R.diagonal().real().array() > least_part * G.diagonal().real().array().sqrt()).all())
          return {};
        R.template triangularView<Eigen::Upper>().template solveInPlace<Eigen::OnTheRight>(basis.Q);
        basis.R = R * basis.R;
      }
    return basis;
  }

  /// Orthonormal basis of the span of the columns of X, none of them zero and as independent as they may be, by Householder's reflections.
  inline DenseMatrix orthonormal_columns(const DenseMatrix &X)
  {
    const Eigen::HouseholderQR<DenseMatrix> qr(X * X.colwise().norm().cwiseInverse().asDiagonal());
    return qr.householderQ() * DenseMatrix::Identity(X.rows(), X.cols());
  }

  /// By the Gram-Schmidt process where columns are few or hardly independent. @p is_independent decides on the norm of what is left of a
  /// column, as a part of that of the column.
  template <typename Matrix, typename Predicate>
  OrthonormalBasis<Matrix> orthonormal_basis(const Matrix &X, const Predicate &is_independent)
  {
    constexpr Eigen::Index few = 4;
    if (X.cols() > few)
      if (auto found = basis_by_cholesky(X);
          found && (found->R.diagonal().real().array() / X.colwise().norm().transpose().array()).unaryExpr(is_independent).all())
        return *std::move(found);
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
