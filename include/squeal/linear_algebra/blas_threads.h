// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

namespace Squeal
{
  /**
   * Sets the number of threads of dense kernels in this process if the BLAS library is OpenBLAS. More threads are faster only on idle
   * cores: a factorisation was 15 times slower with several threads while other processes used the cores. Returns the number reported by
   * the library, 0 if it is not OpenBLAS.
   */
  int set_blas_threads(int n_threads);

  /// Number of OpenBLAS threads; 0 for other BLAS libraries.
  int blas_threads();

  /// Number of rows above which the fronts of a factorisation are large enough for several threads.
  constexpr int rows_of_large_matrices = 100000;

  /// Sets the threads of a factorisation during the lifetime of this object. If the matrix is large enough, BLAS uses as many threads as
  /// tasks do. Otherwise OpenMP regions started by this thread are serial, because CHOLMOD would use four threads for every front,
  /// regardless of OMP_NUM_THREADS, and these threads would mostly wait.
  class ThreadsOfFactorization
  {
  public:
    explicit ThreadsOfFactorization(int n_rows);
    ~ThreadsOfFactorization();
    ThreadsOfFactorization(const ThreadsOfFactorization &)            = delete;
    ThreadsOfFactorization &operator=(const ThreadsOfFactorization &) = delete;

  private:
    int blas_before   = 0;  ///< previous number of BLAS threads; 0: unchanged
    int levels_before = -1; ///< previous nesting level of parallel regions; -1: unchanged
  };
} // namespace Squeal
