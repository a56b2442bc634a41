#pragma once

#include <squeal/linear_algebra/multivector.h>

namespace Squeal
{
  /// All rows of a short distributed X (contact nodes, not dofs) on every process.
  DenseMatrix replicate(const MultiVector &X);

  /// The rows of a replicated matrix that @p map owns here.
  MultiVector distribute(const DenseMatrix &X, const Epetra_Map &map);
} // namespace Squeal
