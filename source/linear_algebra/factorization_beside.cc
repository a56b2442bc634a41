#include <squeal/base/tasks.h>
#include <squeal/linear_algebra/blas_threads.h>
#include <squeal/linear_algebra/factorization_beside.h>

#include <ctime>

namespace Squeal
{
  namespace
  {
    double thread_seconds()
    {
      timespec time = {};
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
      return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    }
  } // namespace

  bool needs_no_process(const RowMap &rows, const FactorizationLibrary library)
  {
    return rows.n_processes() == 1 && (library == FactorizationLibrary::automatic || library == FactorizationLibrary::cholmod);
  }

  bool is_done_beside(const RowMap &rows)
  {
    return n_task_threads() > 1 && rows.n() < rows_of_large_matrices;
  }

  std::future<FactorBeside> factorize_beside(const RowMap                                               &rows,
                                             const std::function<std::shared_ptr<const SparseMatrix>()> &matrix,
                                             const FactorizationLibrary                                  library,
                                             const std::string                                          &what,
                                             const std::function<void(const Factorization &)>           &then)
  {
    if (!needs_no_process(rows, library) || !is_done_beside(rows))
      return std::async(std::launch::deferred, [=] {
        FactorBeside result{factorize_positive_definite(*matrix(), library, what)};
        if (then)
          then(*result.factor);
        return result;
      });
    // To make the matrix may take communication
    return std::async(std::launch::async, [A = matrix(), library, what, then] {
      const double before = thread_seconds();
      FactorBeside result{factorize_positive_definite(*A, library, what)};
      if (then)
        then(*result.factor);
      result.cpu_seconds = thread_seconds() - before;
      return result;
    });
  }
} // namespace Squeal
