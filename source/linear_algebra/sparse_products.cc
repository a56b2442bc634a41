// SPDX-License-Identifier: GPL-3.0-or-later

#include "sparse_products.h"

#include <squeal/base/tasks.h>

namespace Squeal
{
  namespace
  {
    constexpr int rows_of_task = 2048;

    /// Computes at most @p width columns of A X in row-major storage, so that each entry of A is read only once.
    template <int width>
    void multiply_columns(const SparseRows &A, const Eigen::Ref<const DenseMatrix> &X, Eigen::Ref<DenseMatrix> Y)
    {
      using SideBySide = Eigen::Matrix<double, Eigen::Dynamic, width, Eigen::RowMajor>;
      SideBySide rows(X.rows(), width);
      run_parts(X.rows(), rows_of_task, [&](const int first, const int n) { rows.block(first, 0, n, X.cols()) = X.middleRows(first, n); });
      run_parts(A.rows(), rows_of_task, [&](const int first, const int n) {
        const SideBySide image = A.middleRows(first, n) * rows;
        Y.middleRows(first, n) = image.leftCols(X.cols());
      });
    }
  } // namespace

  void multiply_rows(const SparseRows &A, const Eigen::Ref<const DenseMatrix> &X, Eigen::Ref<DenseMatrix> Y)
  {
    // Copying X to row-major storage would cost more than the product
    if (X.cols() == 1 || A.nonZeros() < X.rows())
      {
        run_parts(A.rows(), rows_of_task, [&](const int first, const int n) { Y.middleRows(first, n) = A.middleRows(first, n) * X; });
        return;
      }
    constexpr int few = 8, most = 16;
    for (Eigen::Index first = 0; first < X.cols(); first += most)
      {
        const Eigen::Index n = std::min<Eigen::Index>(X.cols() - first, most);
        (n <= few ? multiply_columns<few> : multiply_columns<most>)(A, X.middleCols(first, n), Y.middleCols(first, n));
      }
  }

  void multiply_transpose(const SparseRows &A, const Eigen::Ref<const DenseMatrix> &X, Eigen::Ref<DenseMatrix> Y)
  {
    run_tasks(static_cast<int>(X.cols()), [&](const int j) { Y.col(j) = A.transpose() * X.col(j); });
  }
} // namespace Squeal
