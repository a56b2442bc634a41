// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

namespace Squeal
{
  /**
   * Sets the number of threads with which this process runs dense kernels, if
   * the BLAS library is OpenBLAS. Threads only pay on idle cores: they made a
   * factorisation 15 times slower while other processes held the cores.
   * Returns the number that the library reports afterwards, 0 if it cannot be
   * asked.
   */
  int set_blas_threads(int n_threads);

  /// That number as it is.
  int blas_threads();

  /// Rows of a matrix from which on the fronts of its factors are large enough for several threads.
  constexpr int rows_of_large_matrices = 100000;

  /// As long as it lives, the BLAS library has the threads of tasks where a matrix that is factorised has so many rows that they pay. Else
  /// parallel regions of OpenMP that begin on this thread have this thread alone: CHOLMOD has four for every front otherwise, whatever
  /// OMP_NUM_THREADS says, which wait for each other longer than they work.
  class ThreadsOfFactorization
  {
  public:
    explicit ThreadsOfFactorization(int n_rows);
    ~ThreadsOfFactorization();
    ThreadsOfFactorization(const ThreadsOfFactorization &)            = delete;
    ThreadsOfFactorization &operator=(const ThreadsOfFactorization &) = delete;

  private:
    int blas_before   = 0;  ///< 0: nothing was changed
    int levels_before = -1; ///< of parallel regions; -1: nothing was changed
  };
} // namespace Squeal
