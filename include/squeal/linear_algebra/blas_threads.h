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

  /// As long as it lives, the BLAS library has the threads of tasks where a matrix that is factorised has so many rows that they pay.
  class BlasThreadsOfLarge
  {
  public:
    explicit BlasThreadsOfLarge(int n_rows);
    ~BlasThreadsOfLarge();
    BlasThreadsOfLarge(const BlasThreadsOfLarge &)            = delete;
    BlasThreadsOfLarge &operator=(const BlasThreadsOfLarge &) = delete;

  private:
    int before; ///< 0: nothing was changed
  };
} // namespace Squeal
