#pragma once

#include <squeal/linear_algebra/multivector.h>

namespace Squeal
{
  /// All rows of a short distributed X (contact nodes, not dofs) on every process.
  DenseMatrix replicate(const MultiVector &X);

  /// The rows of a replicated matrix that @p map owns here.
  MultiVector distribute(const DenseMatrix &X, const RowMap &map);

  /// All rows of X on process 0, in the order of their numbers; no rows on the others.
  DenseMatrix gather(const MultiVector &X);

  /// The rows of a matrix on process 0 that @p map owns here; @p X does not matter on the other processes.
  MultiVector scatter(const DenseMatrix &X, const RowMap &map);
} // namespace Squeal
