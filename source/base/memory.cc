// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/memory.h>

#include <boost/algorithm/string/predicate.hpp>

#include <malloc.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>

namespace Squeal
{
  namespace fs = std::filesystem;

  namespace
  {
    constexpr double unlimited = std::numeric_limits<double>::infinity(), kilobyte = 1024.;

    /// Numbers after the first word of each line.
    std::map<std::string, double> numbers_in(const fs::path &file)
    {
      std::map<std::string, double> numbers;
      std::ifstream                 stream(file);
      std::string                   word;
      double                        number;
      for (std::string line; std::getline(stream, line);)
        if (std::istringstream(line) >> word >> number)
          numbers[word] = number;
      return numbers;
    }

    /// Remaining memory of a control group [byte]; infinite if its limit is `max` or its folder is missing, as in a container.
    double left_by_group(const fs::path &folder)
    {
      double limit, usage;
      if (!(std::ifstream(folder / "memory.max") >> limit) || !(std::ifstream(folder / "memory.current") >> usage))
        return unlimited;
      auto         statistics = numbers_in(folder / "memory.stat");
      const double cache      = statistics["inactive_file"] + statistics["active_file"];
      return std::max(0., limit - std::max(0., usage - cache));
    }
  } // namespace

  double available_memory(const fs::path &root)
  {
    const auto memory = numbers_in(root / "proc/meminfo");
    double     result = memory.count("MemAvailable:") > 0 ? memory.at("MemAvailable:") * kilobyte : unlimited;

    // Include the limits of the group of this process and of all its parent groups
    const std::string prefix = "0::/";
    std::ifstream     groups(root / "proc/self/cgroup");
    for (std::string line; std::getline(groups, line);)
      if (boost::starts_with(line, prefix))
        {
          result = std::min(result, left_by_group(root / "sys/fs/cgroup"));
          for (fs::path group = line.substr(prefix.size()); !group.empty(); group = group.parent_path())
            result = std::min(result, left_by_group(root / "sys/fs/cgroup" / group));
        }
    return result;
  }

  double available_memory(const MPI_Comm communicator)
  {
    MPI_Comm machine;
    int      rank;
    MPI_Comm_split_type(communicator, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    MPI_Comm_rank(machine, &rank);
    MPI_Comm_free(&machine);
    double result = rank == 0 ? available_memory() : 0.; // one process of each machine contributes
    MPI_Allreduce(MPI_IN_PLACE, &result, 1, MPI_DOUBLE, MPI_SUM, communicator);
    return result;
  }

  double resident_memory()
  {
    return numbers_in("/proc/self/status")["VmRSS:"] * kilobyte;
  }

  double peak_resident_memory()
  {
    return numbers_in("/proc/self/status")["VmHWM:"] * kilobyte;
  }

  void return_freed_blocks()
  {
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, 256 << 20);
  }

  void return_freed_memory()
  {
    malloc_trim(0);
  }

  bool reset_peak_memory()
  {
    return_freed_memory();
    // Writing 5 resets the peak to the current resident memory, see proc(5)
    std::ofstream stream("/proc/self/clear_refs");
    stream << 5 << std::flush;
    return static_cast<bool>(stream);
  }
} // namespace Squeal
