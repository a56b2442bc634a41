#include <squeal/linear_algebra/blas_threads.h>

#include <dlfcn.h>

namespace Squeal
{
  int set_blas_threads(const int n_threads)
  {
    // Looked up at run time: the reference BLAS, which Debian may install instead, has no such functions.
    using Setter      = void (*)(int);
    using Getter      = int (*)();
    const auto setter = reinterpret_cast<Setter>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
    const auto getter = reinterpret_cast<Getter>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));
    if (setter != nullptr)
      setter(n_threads);
    return getter != nullptr ? getter() : 0;
  }
} // namespace Squeal
