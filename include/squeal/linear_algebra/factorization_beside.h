#pragma once

#include <squeal/linear_algebra/factorization.h>

#include <functional>
#include <future>
#include <memory>
#include <string>

namespace Squeal
{
  struct FactorBeside
  {
    std::unique_ptr<Factorization> factor;
    double                         cpu_seconds = 0.; ///< of the other thread on which it was made; 0 if there was none [s]
  };

  /// Whether what a library does with a matrix of these @p rows calls no MPI, so that any thread may ask for it: MUMPS does on one process, too.
  bool needs_no_process(const RowMap &rows, FactorizationLibrary library);

  /// Whether work on a matrix of these @p rows that calls no MPI is done on another thread: if there may be one, and unless the matrix is so
  /// large that all threads share it, and memory matters.
  bool is_done_beside(const RowMap &rows);

  /**
   * What factorize_positive_definite() returns or throws, when it is asked for. Where another thread may work and the factorisation needs no
   * other process, it is made beside what is done until then; a matrix so large that all threads share its fronts, and memory matters, waits.
   *
   * @param rows   of the matrix
   * @param matrix gives it when its factorisation begins, and is not called later
   * @param then   what is done with the factor on the thread that made it, and may not communicate; seen by whoever asked for the factor
   */
  std::future<FactorBeside> factorize_beside(const RowMap                                               &rows,
                                             const std::function<std::shared_ptr<const SparseMatrix>()> &matrix,
                                             FactorizationLibrary                                        library,
                                             const std::string                                          &what,
                                             const std::function<void(const Factorization &)>           &then            = nullptr);
} // namespace Squeal
