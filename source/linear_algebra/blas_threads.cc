#include <squeal/base/tasks.h>
#include <squeal/linear_algebra/blas_threads.h>

#include <dlfcn.h>

namespace Squeal
{
  int blas_threads()
  {
    const auto getter = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));
    return getter != nullptr ? getter() : 0;
  }

  int set_blas_threads(const int n_threads)
  {
    // Looked up at run time: the reference BLAS, which Debian may install instead, has no such functions.
    const auto setter = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
    if (setter != nullptr)
      setter(n_threads);
    return blas_threads();
  }

  BlasThreadsOfLarge::BlasThreadsOfLarge(const int n_rows)
    : before(0)
  {
    const int wanted = static_cast<int>(n_task_threads()), now = blas_threads();
    if (n_rows < rows_of_large_matrices || wanted <= now)
      return;
    before = now;
    set_blas_threads(wanted);
  }

  BlasThreadsOfLarge::~BlasThreadsOfLarge()
  {
    if (before > 0)
      set_blas_threads(before);
  }
} // namespace Squeal
