#include "epetra_view.h"
#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/replicate.h>

#include <Epetra_Import.h>

namespace Squeal
{
  namespace
  {
    /// All rows of @p map on process 0.
    RowMap on_root(const RowMap &map)
    {
      return RowMap::contiguous(map.rank() == 0 ? map.n() : 0, map.communicator());
    }

    /// The entries of @p X in the rows that @p Y has.
    void redistribute(const MultiVector &X, MultiVector &Y)
    {
      if (X.n_columns() > 0)
        epetra_view(Y).Import(epetra_view(X), Epetra_Import(Y.map().implementation(), X.map().implementation()), Insert);
    }
  } // namespace

  DenseMatrix replicate(const MultiVector &X)
  {
    DenseMatrix result = DenseMatrix::Zero(X.map().n(), X.n_columns());
    for (int i = 0; i < X.n_local_rows(); ++i)
      result.row(X.map().number(i)) = X.local().row(i);
    sum_over_processes(X.communicator(), result.data(), result.size());
    return result;
  }

  MultiVector distribute(const DenseMatrix &X, const RowMap &map)
  {
    MultiVector result(map, X.cols(), false);
    for (int i = 0; i < map.n_local(); ++i)
      result.local().row(i) = X.row(map.number(i));
    return result;
  }

  DenseMatrix gather(const MultiVector &X)
  {
    MultiVector whole(on_root(X.map()), X.n_columns(), false);
    redistribute(X, whole);
    return whole.local();
  }

  MultiVector scatter(const DenseMatrix &X, const RowMap &map)
  {
    int n_columns = X.cols();
    agree(map.communicator(), &n_columns, 1);
    MultiVector whole(on_root(map), n_columns, false), result(map, n_columns, false);
    if (whole.n_local_rows() > 0)
      whole.local() = X;
    redistribute(whole, result);
    return result;
  }
} // namespace Squeal
