#pragma once

#include <squeal/linear_algebra/factorization.h>

#include <memory>

namespace Squeal
{
  /// A sparse square matrix as a LinearOperator.
  class MatrixOperator : public LinearOperator
  {
  public:
    explicit MatrixOperator(std::shared_ptr<const SparseMatrix> matrix)
      : matrix(std::move(matrix))
    {}

    void apply(const MultiVector &X, MultiVector &Y) const override
    {
      matrix->Multiply(false, X, Y);
    }

    const Epetra_Map &map() const override
    {
      return matrix->RowMap();
    }

  private:
    std::shared_ptr<const SparseMatrix> matrix;
  };
} // namespace Squeal
