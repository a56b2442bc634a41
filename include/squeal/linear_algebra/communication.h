// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense.h>

#include <mpi.h>

namespace Squeal
{
  int n_processes(MPI_Comm communicator);

  /// Rank of this process.
  int this_process(MPI_Comm communicator);

  /// Whether this process has no other to communicate with. In a run of one process it asks nobody, so that any thread may call it.
  bool is_alone(MPI_Comm communicator);

  /// Replaces n numbers, double or int, by their sums over the processes, or by the smallest of all processes.
  template <typename Number>
  void sum_over_processes(MPI_Comm communicator, Number *values, std::size_t n);
  template <typename Number>
  void smallest_of_processes(MPI_Comm communicator, Number *values, std::size_t n);

  /// The largest of the numbers of all processes.
  double largest_of_processes(MPI_Comm communicator, double value);

  /// Replaces bytes by those of process 0.
  void copy_from_root(MPI_Comm communicator, void *bytes, std::size_t n);

  /// Replaces n numbers by those of process 0. Rounding may differ between processes where the same numbers are computed on all; decisions
  /// must be taken on the same bits.
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
