#include <squeal/linear_algebra/replicate.h>

#include <Epetra_Comm.h>

namespace Squeal
{
  DenseMatrix replicate(const MultiVector &X)
  {
    const int   n = X.GlobalLength(), k = X.NumVectors();
    DenseMatrix local(n, k), result(n, k);
    for (int j = 0; j < k; ++j)
      for (int i = 0; i < X.MyLength(); ++i)
        local(X.Map().GID(i), j) = X[j][i];
    if (n * k > 0)
      X.Comm().SumAll(local.column(), result.column(), n * k);
    return result;
  }

  MultiVector distribute(const DenseMatrix &X, const Epetra_Map &map)
  {
    MultiVector result(map, X.n_columns());
    for (int j = 0; j < X.n_columns(); ++j)
      for (int i = 0; i < map.NumMyElements(); ++i)
        result[j][i] = X(map.GID(i), j);
    return result;
  }
} // namespace Squeal
