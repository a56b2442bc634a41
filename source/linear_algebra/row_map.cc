#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/row_map.h>

#include <algorithm>
#include <numeric>

namespace Squeal
{
  RowMap::RowMap(const int n_local, const MPI_Comm communicator)
    : processes(communicator)
    , starts({0, n_local})
  {
    if (is_alone(communicator))
      return;
    MPI_Comm_rank(communicator, &process);
    const std::vector<int> lengths = dealii::Utilities::MPI::all_gather(communicator, n_local);
    starts.resize(lengths.size() + 1);
    std::partial_sum(lengths.begin(), lengths.end(), starts.begin() + 1);
  }

  RowMap RowMap::even(const int n, const MPI_Comm communicator)
  {
    if (is_alone(communicator))
      return {n, communicator};
    int process, n_processes;
    MPI_Comm_rank(communicator, &process);
    MPI_Comm_size(communicator, &n_processes);
    return {n / n_processes + (process < n % n_processes ? 1 : 0), communicator};
  }

  int RowMap::owner(const int number) const
  {
    return static_cast<int>(std::upper_bound(starts.begin() + 1, starts.end(), number) - starts.begin()) - 1;
  }
} // namespace Squeal
