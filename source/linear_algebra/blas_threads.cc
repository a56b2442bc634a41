// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/tasks.h>
#include <squeal/linear_algebra/blas_threads.h>

#include <dlfcn.h>

namespace Squeal
{
  namespace
  {
    /// A function of an optional library; null if it does not exist, for example OpenBLAS functions in Debian's reference BLAS.
    template <typename Function>
    Function *loaded(const char *name)
    {
      return reinterpret_cast<Function *>(dlsym(RTLD_DEFAULT, name));
    }
  } // namespace

  int blas_threads()
  {
    const auto getter = loaded<int()>("openblas_get_num_threads");
    return getter != nullptr ? getter() : 0;
  }

  int set_blas_threads(const int n_threads)
  {
    if (const auto setter = loaded<void(int)>("openblas_set_num_threads"); setter != nullptr)
      setter(n_threads);
    return blas_threads();
  }

  ThreadsOfFactorization::ThreadsOfFactorization(const int n_rows)
  {
    if (n_rows >= rows_of_large_matrices)
      {
        const int wanted = static_cast<int>(n_task_threads()), now = blas_threads();
        if (wanted <= now)
          return;
        blas_before = now;
        set_blas_threads(wanted);
      }
    else if (const auto levels = loaded<int()>("omp_get_max_active_levels"); levels != nullptr)
      {
        levels_before = levels();
        loaded<void(int)>("omp_set_max_active_levels")(0);
      }
  }

  ThreadsOfFactorization::~ThreadsOfFactorization()
  {
    if (blas_before > 0)
      set_blas_threads(blas_before);
    if (levels_before >= 0)
      loaded<void(int)>("omp_set_max_active_levels")(levels_before);
  }
} // namespace Squeal
