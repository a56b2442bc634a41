#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/linear_algebra/row_delivery.h>

#include <numeric>

namespace Squeal
{
  namespace
  {
    /// Between process 0, where all rows lie, and their owners.
    RowDelivery from_root(const RowMap &map)
    {
      std::vector<int> numbers(map.rank() == 0 ? map.n() : 0);
      std::iota(numbers.begin(), numbers.end(), 0);
      return {numbers, map};
    }
  } // namespace

  DenseMatrix replicate(const MultiVector &X)
  {
    DenseMatrix result                                   = DenseMatrix::Zero(X.map().n(), X.n_columns());
    result.middleRows(X.map().first(), X.n_local_rows()) = X.local();
    sum_over_processes(X.communicator(), result.data(), result.size());
    return result;
  }

  MultiVector distribute(const DenseMatrix &X, const RowMap &map)
  {
    MultiVector result(map, X.cols(), false);
    result.local() = X.middleRows(map.first(), map.n_local());
    return result;
  }

  DenseMatrix gather(const MultiVector &X)
  {
    if (is_alone(X.communicator())) // any thread may gather
      return X.local();
    DenseMatrix whole(X.map().rank() == 0 ? X.map().n() : 0, X.n_columns());
    from_root(X.map()).fetch(X.local(), whole);
    return whole;
  }

  MultiVector scatter(const DenseMatrix &X, const RowMap &map)
  {
    if (is_alone(map.communicator()))
      return distribute(X, map);
    int n_columns = X.cols();
    agree(map.communicator(), &n_columns, 1);
    MultiVector result(map, n_columns, false);
    from_root(map).deliver(map.rank() == 0 ? X : DenseMatrix(0, n_columns), result.local());
    return result;
  }
} // namespace Squeal
