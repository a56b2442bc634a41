// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/linear_algebra/dense.h>

namespace Squeal
{
  DenseMatrix sparing_zeros(const DenseMatrix &X, const std::function<DenseMatrix(const DenseMatrix &)> &operation)
  {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index j = 0; j < X.cols(); ++j)
      if ((X.col(j).array() != 0.).any())
        kept.push_back(j);
    if (static_cast<Eigen::Index>(kept.size()) == X.cols())
      return operation(X);
    const DenseMatrix of_kept              = operation(X(Eigen::placeholders::all, kept));
    DenseMatrix       result               = DenseMatrix::Zero(of_kept.rows(), X.cols());
    result(Eigen::placeholders::all, kept) = of_kept;
    return result;
  }

  namespace
  {
    /// A X by blocks of adjacent nonzero rows of X.
    DenseMatrix multiply_sparing_rows(const DenseMatrix &A, const DenseMatrix &X)
    {
      DenseMatrix result  = DenseMatrix::Zero(A.rows(), X.cols());
      const auto  is_zero = [&](const Eigen::Index i) { return (X.row(i).array() == 0.).all(); };
      for (Eigen::Index first = 0; first < X.rows();)
        {
          Eigen::Index last = first;
          while (last < X.rows() && !is_zero(last))
            ++last;
          if (last > first)
            result.noalias() += A.middleCols(first, last - first) * X.middleRows(first, last - first);
          first = last + 1;
        }
      return result;
    }
  } // namespace

  DenseMatrix multiply_sparing_zeros(const DenseMatrix &A, const DenseMatrix &X)
  {
    return sparing_zeros(X, [&A](const DenseMatrix &columns) { return multiply_sparing_rows(A, columns); });
  }

  ComplexDenseMatrix multiply(const DenseMatrix &A, const ComplexDenseMatrix &X)
  {
    return from_halves(multiply_sparing_zeros(A, halves(X)));
  }

  DenseMatrix halves(const ComplexDenseMatrix &X)
  {
    DenseMatrix result(X.rows(), 2 * X.cols());
    result << X.real(), X.imag();
    return result;
  }

  ComplexDenseMatrix from_halves(const DenseMatrix &halves)
  {
    const Eigen::Index k = halves.cols() / 2;
    ComplexDenseMatrix X(halves.rows(), k);
    X.real() = halves.leftCols(k);
    X.imag() = halves.rightCols(k);
    return X;
  }

  ComplexDenseMatrix product_of_halves(const DenseMatrix &products)
  {
    const Eigen::Index m = products.rows() / 2, n = products.cols() / 2;
    ComplexDenseMatrix result(m, n);
    result.real() = products.topLeftCorner(m, n) - products.bottomRightCorner(m, n);
    result.imag() = products.topRightCorner(m, n) + products.bottomLeftCorner(m, n);
    return result;
  }

  DenseMatrix append_columns(const DenseMatrix &X, const DenseMatrix &Y)
  {
    if (X.cols() == 0)
      return Y;
    DenseMatrix result(Y.rows(), X.cols() + Y.cols());
    result << X, Y;
    return result;
  }
} // namespace Squeal
