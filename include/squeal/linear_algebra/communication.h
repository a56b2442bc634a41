#pragma once

#include <squeal/linear_algebra/dense.h>

#include <deal.II/base/mpi.h>

namespace Squeal
{
  /// Whether this process has no other to communicate with. In a run of one process it asks nobody, so that any thread may call it.
  inline bool is_alone(const MPI_Comm communicator)
  {
    static const bool only_one = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1;
    return only_one || dealii::Utilities::MPI::n_mpi_processes(communicator) == 1;
  }

  /// Replaces n numbers by their sums over the processes.
  inline void sum_over_processes(const MPI_Comm communicator, double *values, const std::size_t n)
  {
    if (is_alone(communicator))
      return;
    const dealii::ArrayView<double> view(values, n);
    dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(view), communicator, view);
  }

  /// The largest of the numbers of all processes.
  inline double largest_of_processes(const MPI_Comm communicator, const double value)
  {
    return is_alone(communicator) ? value : dealii::Utilities::MPI::max(value, communicator);
  }

  /// Replaces n numbers by those of process 0. Rounding may differ between processes where the same numbers are computed on all; decisions
  /// must be taken on the same bits.
  template <typename Number>
  void agree(const MPI_Comm communicator, Number *values, const std::size_t n)
  {
    if (!is_alone(communicator))
      dealii::Utilities::MPI::broadcast(values, n, 0, communicator);
  }

  inline void agree(const MPI_Comm communicator, DenseMatrix &A)
  {
    agree(communicator, A.data(), A.size());
  }
} // namespace Squeal
