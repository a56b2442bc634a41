#pragma once

#include "lane_kernels.h"

#include <squeal/linear_algebra/dense.h>

#include <utility>
#include <vector>

namespace Squeal
{
  /// Entries of a matrix that is not distributed, by rows.
  struct RowArrays
  {
    std::vector<int>    start, column;
    std::vector<double> value;

    SparseRows rows() const
    {
      return {static_cast<int>(start.size()) - 1, start.data(), column.data(), value.data()};
    }
  };

  /// Aᵀ, columns ascending in each row.
  RowArrays transposed(const SparseRows &A, int n_columns);

  /// A B, columns ascending in each row. Rows are tasks; entries do not depend on the number of threads.
  RowArrays product(const SparseRows &A, const SparseRows &B, int n_columns);

  /// Σ factor A for matrices of as many rows, one at least.
  RowArrays sum(const std::vector<std::pair<double, SparseRows>> &summands, int n_columns);

  /// Y = A X for the rows of A and those columns of it that are known here.
  void multiply_rows(const SparseRows &A, const Eigen::Ref<const DenseMatrix> &X, Eigen::Ref<DenseMatrix> Y);

  /// Y = Aᵀ X for all rows of A. Columns of X are tasks.
  void multiply_transpose(const SparseRows &A, const Eigen::Ref<const DenseMatrix> &X, Eigen::Ref<DenseMatrix> Y);
} // namespace Squeal
