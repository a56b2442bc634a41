#pragma once

#include <squeal/linear_algebra/multivector.h>

#include <Epetra_Map.h>
#include <Epetra_MultiVector.h>

#include <algorithm>

namespace Squeal
{
  /// Epetra's view of vectors: it refers to the numbers of @p X.
  inline Epetra_MultiVector epetra_view(const MultiVector &X)
  {
    return {View, X.map().implementation(), const_cast<double *>(X.local().data()), std::max(1, X.n_local_rows()), X.n_columns()};
  }
} // namespace Squeal
