#include <squeal/linear_algebra/replicate.h>

#include <Epetra_Comm.h>
#include <Epetra_Import.h>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    /// All rows of @p map on process 0.
    Epetra_Map on_root(const Epetra_BlockMap &map)
    {
      const int n = map.NumGlobalElements();
      return Epetra_Map(n, map.Comm().MyPID() == 0 ? n : 0, 0, map.Comm());
    }
  } // namespace

  DenseMatrix replicate(const MultiVector &X)
  {
    const int   n = X.GlobalLength(), k = X.NumVectors();
    DenseMatrix local = DenseMatrix::Zero(n, k), result(n, k);
    for (int j = 0; j < k; ++j)
      for (int i = 0; i < X.MyLength(); ++i)
        local(X.Map().GID(i), j) = X[j][i];
    if (n * k > 0)
      X.Comm().SumAll(local.data(), result.data(), n * k);
    return result;
  }

  MultiVector distribute(const DenseMatrix &X, const Epetra_Map &map)
  {
    MultiVector result(map, X.cols());
    for (int j = 0; j < X.cols(); ++j)
      for (int i = 0; i < map.NumMyElements(); ++i)
        result[j][i] = X(map.GID(i), j);
    return result;
  }

  DenseMatrix gather(const MultiVector &X)
  {
    const Epetra_Map map = on_root(X.Map());
    MultiVector      whole(map, X.NumVectors(), false);
    whole.Import(X, Epetra_Import(map, X.Map()), Insert);
    DenseMatrix result(whole.MyLength(), whole.NumVectors());
    for (int j = 0; j < result.cols(); ++j)
      std::copy_n(whole[j], whole.MyLength(), result.col(j).begin());
    return result;
  }

  MultiVector scatter(const DenseMatrix &X, const Epetra_Map &map)
  {
    int n_columns = X.cols();
    map.Comm().Broadcast(&n_columns, 1, 0);
    MultiVector whole(on_root(map), n_columns, false), result(map, n_columns, false);
    if (whole.MyLength() > 0)
      for (int j = 0; j < n_columns; ++j)
        std::copy_n(X.col(j).begin(), whole.MyLength(), whole[j]);
    result.Import(whole, Epetra_Import(map, whole.Map()), Insert);
    return result;
  }
} // namespace Squeal
