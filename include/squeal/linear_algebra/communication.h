// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense.h>

#include <mpi.h>

namespace Squeal
{
  int n_processes(MPI_Comm communicator);

  /// Rank of this process.
  int this_process(MPI_Comm communicator);

  /// True if this is the only process. In a serial run, only the first call uses MPI, so that any thread may make later calls.
  bool is_alone(MPI_Comm communicator);

  /// Replace n numbers (double or int) by their sums or minima over all processes.
  template <typename Number>
  void sum_over_processes(MPI_Comm communicator, Number *values, std::size_t n);
  template <typename Number>
  void smallest_of_processes(MPI_Comm communicator, Number *values, std::size_t n);

  /// Largest @p value of all processes.
  double largest_of_processes(MPI_Comm communicator, double value);

  /// Broadcasts bytes from process 0.
  void copy_from_root(MPI_Comm communicator, void *bytes, std::size_t n);

  /// Broadcasts n numbers from process 0. Identical computations may round differently on different processes, but decisions must be based
  /// on identical numbers.
  template <typename Number>
  void agree(const MPI_Comm communicator, Number *values, const std::size_t n)
  {
    copy_from_root(communicator, values, n * sizeof(Number));
  }

  inline void agree(const MPI_Comm communicator, DenseMatrix &A)
  {
    agree(communicator, A.data(), A.size());
  }
} // namespace Squeal
