#include <squeal/base/tasks.h>
#include <squeal/linear_algebra/weighted_gram.h>

namespace Squeal
{
  DenseMatrix weighted_gram(const MultiVector &X, const SparseMatrix &A, const MultiVector &Y)
  {
    DenseMatrix result(X.n_columns(), Y.n_columns());
    for_column_blocks(Y.n_columns(), [&](const int first, const int n) { result.middleCols(first, n) = gram(X, A * view(Y, first, n)); });
    return result;
  }

  DenseMatrix weighted_gram(const MultiVector &X, const SparseMatrix &A)
  {
    const int   k = X.n_columns();
    DenseMatrix result(k, k);
    for_column_blocks(k, [&](const int first, const int n) {
      const int         rows           = first + n;
      const DenseMatrix block          = gram(view(X, 0, rows), A * view(X, first, n));
      result.block(0, first, rows, n)  = block;
      result.block(first, 0, n, first) = block.topRows(first).transpose();
      result.block(first, first, n, n) = 0.5 * (block.bottomRows(n) + block.bottomRows(n).transpose());
    });
    return result;
  }

  void multiply_in_place(MultiVector &X, const DenseMatrix &S)
  {
    constexpr int rows_together = 1024;
    auto          x             = X.local();
    run_parts(X.n_local_rows(), rows_together, [&](const int first, const int n) {
      auto              rows    = x.middleRows(first, n);
      const DenseMatrix product = rows * S;
      rows                      = product;
    });
  }
} // namespace Squeal
