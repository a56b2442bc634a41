// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense.h>

#include <mpi.h>

#include <map>
#include <vector>

namespace Squeal
{
  /// Distribution of rows over the processes: each has a contiguous range, in the order of the ranks. A row has a global number and a local
  /// index on its process.
  class RowMap
  {
  public:
    RowMap() = default;

    /// Map with @p n_local rows on this process. Collective.
    RowMap(int n_local, MPI_Comm communicator);

    /// Map of @p n rows in ranges of nearly equal size.
    static RowMap even(int n, MPI_Comm communicator);

    /// Global number of rows.
    int n() const
    {
      return starts.back();
    }

    /// Number of rows of this process.
    int n_local() const
    {
      return starts[process + 1] - starts[process];
    }

    /// Number of the first row of this process.
    int first() const
    {
      return starts[process];
    }

    /// Global number of a local row.
    int number(const int place) const
    {
      return first() + place;
    }

    /// Local index of a row; -1 if it belongs to another process or the number is negative.
    int place(const int number) const
    {
      return number >= first() && number < first() + n_local() ? number - first() : -1;
    }

    int owner(int number) const;

    MPI_Comm communicator() const
    {
      return processes;
    }

    int rank() const
    {
      return process;
    }

    int n_processes() const
    {
      return static_cast<int>(starts.size()) - 1;
    }

    /// True if both maps give all processes the same rows.
    bool operator==(const RowMap &other) const
    {
      return starts == other.starts;
    }

  private:
    MPI_Comm         processes = MPI_COMM_SELF;
    int              process   = 0;
    std::vector<int> starts    = {0, 0}; ///< global number of the first row of each process, then the total number of rows
  };

  /// Moves rows of vectors from any process to their owners, and back. The communication pattern is determined once. Collective.
  class RowDelivery
  {
  public:
    /// @param numbers numbers of the local rows, in their order; several processes may have the same row
    RowDelivery(const std::vector<int> &numbers, const RowMap &owners);

    /// True if no process has a row.
    bool empty() const
    {
      return nothing;
    }

    void deliver(const Eigen::Ref<const DenseMatrix> &here, Eigen::Ref<DenseMatrix> own) const
    {
      exchange(places_here, here, places_owned, own, false);
    }

    /// Adds the rows to the rows of their owners, in the order of the processes.
    void add(const Eigen::Ref<const DenseMatrix> &here, Eigen::Ref<DenseMatrix> own) const
    {
      exchange(places_here, here, places_owned, own, true);
    }

    void fetch(const Eigen::Ref<const DenseMatrix> &own, Eigen::Ref<DenseMatrix> here) const
    {
      exchange(places_owned, own, places_here, here, false);
    }

  private:
    /// Local indices of the rows that are exchanged with each process.
    using Places = std::map<unsigned int, std::vector<int>>;

    void exchange(const Places                        &from,
                  const Eigen::Ref<const DenseMatrix> &X,
                  const Places                        &to,
                  Eigen::Ref<DenseMatrix>              Y,
                  bool                                 adding) const;

    MPI_Comm communicator;
    Places   places_here, places_owned;
    bool     nothing;
  };
} // namespace Squeal
