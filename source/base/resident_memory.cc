#include <squeal/base/resident_memory.h>

#include <malloc.h>

#include <fstream>
#include <string>

namespace Squeal
{
  namespace
  {
    /// A line of /proc/self/status, "VmHWM:   123456 kB", in bytes.
    double status(const std::string &name)
    {
      std::ifstream stream("/proc/self/status");
      std::string   word;
      while (stream >> word)
        if (double kilobytes; word == name + ":" && stream >> kilobytes)
          return 1024. * kilobytes;
      return 0.;
    }
  } // namespace

  double resident_memory()
  {
    return status("VmRSS");
  }

  double peak_resident_memory()
  {
    return status("VmHWM");
  }

  void return_freed_blocks()
  {
    constexpr int large = 32 << 20; // the largest threshold that the allocator takes [byte]
    mallopt(M_MMAP_THRESHOLD, large);
    mallopt(M_MMAP_MAX, 65536);
    mallopt(M_TRIM_THRESHOLD, 8 * large);
  }

  void return_freed_memory()
  {
    malloc_trim(0);
  }

  bool reset_peak_memory()
  {
    return_freed_memory();
    // 5: the peak of the resident memory becomes what is resident now, proc(5)
    std::ofstream stream("/proc/self/clear_refs");
    stream << 5 << std::flush;
    return static_cast<bool>(stream);
  }
} // namespace Squeal
