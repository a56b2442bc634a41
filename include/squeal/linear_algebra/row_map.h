// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense.h>

#include <mpi.h>

#include <map>
#include <vector>

namespace Squeal
{
  /// Which rows of distributed vectors and matrices each process has: rows 0, 1, ... in pieces, that of process 0 first. A row has a number
  /// among all, and a place 0, 1, ... among those of its process.
  class RowMap
  {
  public:
    /// No rows.
    RowMap() = default;

    /// @p n_local rows on this process. All processes must call.
    RowMap(int n_local, MPI_Comm communicator);

    /// @p n rows in pieces of nearly equal size.
    static RowMap even(int n, MPI_Comm communicator);

    /// Rows of all processes.
    int n() const
    {
      return starts.back();
    }

    /// Rows of this process.
    int n_local() const
    {
      return starts[process + 1] - starts[process];
    }

    /// Number of the first row of this process.
    int first() const
    {
      return starts[process];
    }

    /// Number of the row at a place of this process.
    int number(const int place) const
    {
      return first() + place;
    }

    /// Place of a row; -1 if it belongs to another process or the number is negative.
    int place(const int number) const
    {
      return number >= first() && number < first() + n_local() ? number - first() : -1;
    }

    /// The process that has a row.
    int owner(int number) const;

    MPI_Comm communicator() const
    {
      return processes;
    }

    /// This process among those of the communicator.
    int rank() const
    {
      return process;
    }

    int n_processes() const
    {
      return static_cast<int>(starts.size()) - 1;
    }

    /// Whether all processes have the same rows.
    bool operator==(const RowMap &other) const
    {
      return starts == other.starts;
    }

  private:
    MPI_Comm         processes = MPI_COMM_SELF;
    int              process   = 0;
    std::vector<int> starts    = {0, 0}; ///< number of the first row of each process, and of all rows
  };

  /// Brings rows of vectors from where they are to where they are wanted: from any process to those that own them, and back. Who sends what
  /// to whom is found once; all processes must call.
  class RowDelivery
  {
  public:
    /// @param numbers of the rows here, in the order in which they lie; several processes may have the same
    RowDelivery(const std::vector<int> &numbers, const RowMap &owners);

    /// Whether no process has a row here.
    bool empty() const
    {
      return nothing;
    }

    /// Own rows become those that are here.
    void deliver(const Eigen::Ref<const DenseMatrix> &here, Eigen::Ref<DenseMatrix> own) const
    {
      exchange(places_here, here, places_owned, own, false);
    }

    /// The same, but what is here is added to the own rows, process after process.
    void add(const Eigen::Ref<const DenseMatrix> &here, Eigen::Ref<DenseMatrix> own) const
    {
      exchange(places_here, here, places_owned, own, true);
    }

    /// Rows here become those of their owners.
    void fetch(const Eigen::Ref<const DenseMatrix> &own, Eigen::Ref<DenseMatrix> here) const
    {
      exchange(places_owned, own, places_here, here, false);
    }

  private:
    /// Of the rows that are exchanged with each process.
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
