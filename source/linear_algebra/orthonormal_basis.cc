// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/linear_algebra/orthonormal_basis.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include <optional>

namespace Squeal
{
  namespace
  {
    /// A unit vector is linearly dependent if its remainder after Gram-Schmidt is below this norm [-].
    constexpr double dependent = 1e-13;

    /// CholeskyQR2: Cholesky factors of XᴴX, twice (T. Fukaya et al., 2014), which takes only a few block products. Empty if the
    /// component of a column outside the span of the previous columns is below 10⁻³ of its norm: its square would be lost in rounding.
    std::optional<OrthonormalBasis> basis_by_cholesky(const ComplexDenseMatrix &X)
    {
      constexpr double least_part = 1e-3;
      OrthonormalBasis basis{X, ComplexDenseMatrix::Identity(X.cols(), X.cols())};
      for (int pass = 0; pass < 2; ++pass)
        {
          const ComplexDenseMatrix             G = basis.Q.adjoint() * basis.Q;
          const Eigen::LLT<ComplexDenseMatrix> cholesky(G);
          const ComplexDenseMatrix             R = cholesky.matrixU();
          if (cholesky.info() != Eigen::Success || !(R.diagonal().real().array() > least_part * G.diagonal().real().array().sqrt()).all())
            return {};
          R.triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(basis.Q);
          basis.R = R * basis.R;
        }
      return basis;
    }
  } // namespace

  DenseMatrix orthonormal_columns(const DenseMatrix &X)
  {
    const Eigen::HouseholderQR<DenseMatrix> qr(X * X.colwise().norm().cwiseInverse().asDiagonal());
    return qr.householderQ() * DenseMatrix::Identity(X.rows(), X.cols());
  }

  OrthonormalBasis orthonormal_basis(const ComplexDenseMatrix &X)
  {
    constexpr Eigen::Index few = 4;
    if (X.cols() > few)
      if (auto found = basis_by_cholesky(X);
          found && (found->R.diagonal().real().array() > dependent * X.colwise().norm().transpose().array()).all())
        return *std::move(found);
    OrthonormalBasis basis{X, ComplexDenseMatrix::Zero(X.cols(), X.cols())};
    auto &[Q, R] = basis;
    for (Eigen::Index j = 0; j < X.cols(); ++j)
      {
        const double before = Q.col(j).norm();
        // Orthogonalise twice, which is sufficient (W. Kahan, B. Parlett)
        for (int pass = 0; pass < 2 && j > 0; ++pass)
          {
            const ComplexDenseMatrix c = Q.leftCols(j).adjoint() * Q.col(j);
            R.col(j).head(j) += c;
            Q.col(j).noalias() -= Q.leftCols(j) * c;
          }
        const double after = Q.col(j).norm();
        if (after / before > dependent)
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
