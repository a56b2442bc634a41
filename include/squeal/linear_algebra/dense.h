// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <Eigen/Core>

#include <complex>
#include <functional>
#include <vector>

namespace Squeal
{
  /// Dense matrices, mainly of reduced models and contact nodes; such matrices are identical on every process.
  using DenseMatrix        = Eigen::MatrixXd;
  using ComplexDenseMatrix = Eigen::MatrixXcd;

  /// View of numbers as a column.
  template <typename Number>
  Eigen::Map<const Eigen::Matrix<Number, Eigen::Dynamic, 1>> as_column(const std::vector<Number> &values)
  {
    return {values.data(), static_cast<Eigen::Index>(values.size())};
  }

  /// Largest absolute entry; 0 for an empty matrix, NaN if an entry is NaN.
  template <typename Derived>
  double max_norm(const Eigen::MatrixBase<Derived> &A)
  {
    return A.size() == 0 ? 0. : A.cwiseAbs().template maxCoeff<Eigen::PropagateNaN>();
  }

  /// Applies a linear operation to the nonzero columns of X only, because the imaginary parts of neutral modes are zero.
  DenseMatrix sparing_zeros(const DenseMatrix &X, const std::function<DenseMatrix(const DenseMatrix &)> &operation);

  /// A X without the zero columns and rows of X, which occur for vanishing terms and after an extension of the basis.
  DenseMatrix multiply_sparing_zeros(const DenseMatrix &A, const DenseMatrix &X);

  /// A X for a real A and a complex X, as one real product with [Re X, Im X].
  ComplexDenseMatrix multiply(const DenseMatrix &A, const ComplexDenseMatrix &X);

  /// [Re X, Im X].
  DenseMatrix halves(const ComplexDenseMatrix &X);

  /// X from [Re X, Im X].
  ComplexDenseMatrix from_halves(const DenseMatrix &halves);

  /// XᵀY (without conjugation) from [Re X, Im X]ᵀ [Re Y, Im Y].
  ComplexDenseMatrix product_of_halves(const DenseMatrix &products);

  /// [X Y]; X may be empty.
  DenseMatrix append_columns(const DenseMatrix &X, const DenseMatrix &Y);

  /// The matrix with zero rows appended or its last rows removed.
  template <typename Derived>
  typename Derived::PlainObject with_rows(const Eigen::MatrixBase<Derived> &A, const Eigen::Index n_rows)
  {
    typename Derived::PlainObject result = A;
    result.conservativeResizeLike(Derived::PlainObject::Zero(n_rows, A.cols()));
    return result;
  }
} // namespace Squeal
