#include <squeal/linear_algebra/blas_kernels.h>

#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace Squeal
{
  namespace
  {
    constexpr const char *variable = "OPENBLAS_CORETYPE";

    /// Best set of kernels for this processor by what it can do, not by its name; null: none better than the fallback.
    const char *native_kernels()
    {
#if defined(__x86_64__)
      __builtin_cpu_init();
      if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
          __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512cd"))
        return "SkylakeX";
      if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        return "Haswell";
#endif
      return nullptr;
    }

    /// Whether the loaded OpenBLAS runs its fallback for processors that it does not know.
    bool runs_fallback()
    {
      using CoreName  = char *(*)();
      const auto name = reinterpret_cast<CoreName>(dlsym(RTLD_DEFAULT, "openblas_get_corename"));
      return name != nullptr && std::string_view(name()) == "Prescott";
    }
  } // namespace

  void use_native_blas_kernels(char **argv)
  {
    const char *kernels = native_kernels();
    if (kernels == nullptr || std::getenv(variable) != nullptr || !runs_fallback())
      return;
    setenv(variable, kernels, 1);
    // Where /proc is missing the slow kernels do as well: execv() returns.
    execv("/proc/self/exe", argv);
    unsetenv(variable);
  }
} // namespace Squeal
