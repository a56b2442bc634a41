#pragma once

#include <squeal/linear_algebra/dense.h>

#include <deal.II/base/mpi.h>

namespace Squeal
{
  /// Replaces n numbers by their sums over the processes.
  inline void sum_over_processes(const MPI_Comm communicator, double *values, const std::size_t n)
  {
    const dealii::ArrayView<double> view(values, n);
    dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(view), communicator, view);
  }

  /**
   * Replaces n numbers by those of process 0. Rounding may differ between processes where the same numbers are computed on
   * all; decisions must be taken on the same bits.
   */
  template <typename Number>
  void agree(const MPI_Comm communicator, Number *values, const std::size_t n)
  {
    if (dealii::Utilities::MPI::n_mpi_processes(communicator) > 1)
      dealii::Utilities::MPI::broadcast(values, n, 0, communicator);
  }

  inline void agree(const MPI_Comm communicator, DenseMatrix &A)
  {
    agree(communicator, A.data(), A.size());
  }
} // namespace Squeal
