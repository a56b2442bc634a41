#pragma once

#include <mpi.h>

#include <cstddef>
#include <vector>

namespace Squeal
{
  /**
   * Brings rows of vectors that a library has left on any process to the processes that own them. Rows are numbered without gaps
   * over all processes, those of process 0 first. Who sends what to whom is found once; all processes must call.
   */
  class RowDelivery
  {
  public:
    /**
     * @param numbers   of the rows here, in the order in which they lie; every row is on one process
     * @param first_row number of the first row that this process owns
     * @param n_rows    that it owns
     */
    RowDelivery(std::vector<int> numbers, int first_row, int n_rows, MPI_Comm communicator);

    /// Numbers of the rows here.
    const std::vector<int> &rows() const
    {
      return numbers;
    }

    /// Y = the own rows of vectors of which X has those that are here; @p X_stride and @p Y_stride are the distances of columns.
    void deliver(const double *X, std::size_t X_stride, double *Y, std::size_t Y_stride, int n_columns) const;

  private:
    /// Rows that are sent or received: one process after the other.
    struct Messages
    {
      std::vector<int> counts, offsets; ///< of each process
      std::vector<int> places;          ///< of the rows among those here, or among the own ones
    };

    const std::vector<int> numbers;
    const MPI_Comm         communicator;
    Messages               sent, received;
  };
} // namespace Squeal
