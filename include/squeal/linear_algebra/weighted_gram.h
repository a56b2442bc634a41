#pragma once

#include <squeal/linear_algebra/sparse_matrix.h>

#include <algorithm>

namespace Squeal
{
  /// Xᵀ A Y, with A times some columns of Y at a time: all of A Y would take as much memory as Y.
  DenseMatrix weighted_gram(const MultiVector &X, const SparseMatrix &A, const MultiVector &Y);

  /// Xᵀ A X for a symmetric A, one half of it computed.
  DenseMatrix weighted_gram(const MultiVector &X, const SparseMatrix &A);

  /// Calls f(first, n) for blocks of columns so narrow that a copy of one takes little memory.
  template <typename Function>
  void for_column_blocks(const int n_columns, const Function &f)
  {
    constexpr int width = 32;
    for (int first = 0; first < n_columns; first += width)
      f(first, std::min(width, n_columns - first));
  }

  /// X ← X S for a square S.
  void multiply_in_place(MultiVector &X, const DenseMatrix &S);
} // namespace Squeal
