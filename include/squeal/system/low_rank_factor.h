#pragma once

#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <memory>

namespace Squeal
{
  /// An n × m matrix F of few columns, kept either by its sparse transpose or in full.
  class LowRankFactor
  {
  public:
    /// @param transpose Fᵀ, m × n
    explicit LowRankFactor(std::shared_ptr<const SparseMatrix> transpose);

    /// @param columns F, n × m
    explicit LowRankFactor(MultiVector columns);

    /// m
    int rank() const;

    /// Fᵀ X, m × k, the same on every process.
    DenseMatrix transpose_times(const MultiVector &X) const;

    /// F Y for Y, m × k, the same on every process.
    MultiVector operator*(const DenseMatrix &Y) const;

    /// Columns [first, first + n) of F.
    MultiVector columns(int first, int n) const;

    /// Fᵀ; null if F is kept in full.
    const std::shared_ptr<const SparseMatrix> &sparse_transpose() const;

  private:
    std::shared_ptr<const SparseMatrix> rows;
    std::shared_ptr<const MultiVector>  full;
  };
} // namespace Squeal
