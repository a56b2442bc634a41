#include <squeal/linear_algebra/replicate.h>
#include <squeal/system/low_rank_factor.h>

namespace Squeal
{
  LowRankFactor::LowRankFactor(std::shared_ptr<const SparseMatrix> transpose)
    : rows(std::move(transpose))
  {}

  LowRankFactor::LowRankFactor(MultiVector columns)
    : full(std::make_shared<MultiVector>(std::move(columns)))
  {}

  int LowRankFactor::rank() const
  {
    return rows ? rows->n_rows() : full->n_columns();
  }

  DenseMatrix LowRankFactor::transpose_times(const MultiVector &X) const
  {
    return rows ? replicate(*rows * X) : gram(*full, X);
  }

  MultiVector LowRankFactor::operator*(const DenseMatrix &Y) const
  {
    return rows ? Squeal::transpose_times(*rows, distribute(Y, rows->rows())) : *full * Y;
  }

  MultiVector LowRankFactor::columns(const int first, const int n) const
  {
    if (full)
      return MultiVector(view(*full, first, n));
    return *this * DenseMatrix(DenseMatrix::Identity(rank(), rank()).middleCols(first, n));
  }

  const std::shared_ptr<const SparseMatrix> &LowRankFactor::sparse_transpose() const
  {
    return rows;
  }
} // namespace Squeal
