#pragma once

#include <mpi.h>

#include <memory>
#include <vector>

class Epetra_Map;

namespace Squeal
{
  /**
   * Which rows of distributed vectors and matrices each process has: every row
   * has a number and belongs to one process, where it has a place 0, 1, ....
   * Copies share their data.
   */
  class RowMap
  {
  public:
    /// No rows.
    RowMap() = default;

    /// Rows 0, ..., n - 1 in pieces of nearly equal size.
    static RowMap even(int n, MPI_Comm communicator);

    /// @p n_local rows on this process, numbered from 0 in the order of the processes.
    static RowMap contiguous(int n_local, MPI_Comm communicator);

    /// The rows with these numbers, ≥ 0, on this process.
    static RowMap of(const std::vector<int> &numbers, MPI_Comm communicator);

    /// Rows of all processes.
    int n() const;

    /// Rows of this process.
    int n_local() const;

    /// Number of the row at a place of this process.
    int number(int place) const;

    /// Place of a row; -1 if it belongs to another process or the number is negative.
    int place(int number) const;

    MPI_Comm communicator() const;

    /// This process among those of the communicator.
    int rank() const;
    int n_processes() const;

    /// Whether all processes have the same rows in the same order. All processes must call.
    bool operator==(const RowMap &other) const;

    /// For linear_algebra/ alone.
    explicit RowMap(const Epetra_Map &map);
    const Epetra_Map &implementation() const;

  private:
    std::shared_ptr<const Epetra_Map> map;
  };
} // namespace Squeal
