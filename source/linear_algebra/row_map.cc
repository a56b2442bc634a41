// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/dense_serialization.h>
#include <squeal/linear_algebra/row_map.h>

#include <deal.II/base/mpi.h>

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

  namespace MPI = dealii::Utilities::MPI;

  namespace
  {
    /// Number of columns in a message: a compromise between the size of the buffers and the number of messages.
    constexpr Eigen::Index columns_at_a_time = 16;
  } // namespace

  RowDelivery::RowDelivery(const std::vector<int> &numbers, const RowMap &owners)
    : communicator(owners.communicator())
    , nothing(MPI::max(static_cast<int>(numbers.size()), communicator) == 0)
  {
    Places wanted;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      {
        const int process = owners.owner(numbers[i]);
        places_here[process].push_back(static_cast<int>(i));
        wanted[process].push_back(numbers[i]);
      }
    places_owned = MPI::some_to_some(communicator, wanted);
    for (auto &[process, places] : places_owned)
      for (int &place : places)
        place -= owners.first();
  }

  void RowDelivery::exchange(const Places                        &from,
                             const Eigen::Ref<const DenseMatrix> &X,
                             const Places                        &to,
                             Eigen::Ref<DenseMatrix>              Y,
                             const bool                           adding) const
  {
    for (Eigen::Index first = 0; first < X.cols(); first += columns_at_a_time)
      {
        const auto                          columns = Eigen::seqN(first, std::min(columns_at_a_time, X.cols() - first));
        std::map<unsigned int, DenseMatrix> rows;
        for (const auto &[process, places] : from)
          rows[process] = X(places, columns);
        for (const auto &[process, received] : MPI::some_to_some(communicator, rows))
          if (adding)
            Y(to.at(process), columns) += received;
          else
            Y(to.at(process), columns) = received;
      }
  }
} // namespace Squeal
