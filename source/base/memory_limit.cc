#include <squeal/base/memory_limit.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string>

namespace Squeal
{
  namespace fs = std::filesystem;

  namespace
  {
    constexpr double unlimited = std::numeric_limits<double>::infinity();

    /// Numbers behind the words with which lines begin.
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

    /// The number of which a file consists; nothing where it says `max`, or is missing.
    std::optional<double> number_in(const fs::path &file)
    {
      std::ifstream stream(file);
      double        number;
      if (stream >> number)
        return number;
      return {};
    }

    /// Names of the files of a control group, which differ between its versions.
    struct GroupFiles
    {
      const char *limit, *usage, *inactive_cache, *active_cache;
    };
    constexpr GroupFiles version_1 = {"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file", "total_active_file"};
    constexpr GroupFiles version_2 = {"memory.max", "memory.current", "inactive_file", "active_file"};

    /// What the group of one folder leaves [byte].
    double left_by_group(const fs::path &folder, const GroupFiles &files)
    {
      const auto limit = number_in(folder / files.limit), usage = number_in(folder / files.usage);
      if (!limit || !usage)
        return unlimited;
      auto         statistics = numbers_in(folder / "memory.stat");
      const double cache      = statistics[files.inactive_cache] + statistics[files.active_cache];
      return std::max(0., *limit - std::max(0., *usage - cache));
    }

    /// What a group and all groups about it leave [byte]. In a container the inner folders may not be there.
    double left_by_groups(const fs::path &hierarchy, fs::path group, const GroupFiles &files)
    {
      double result = left_by_group(hierarchy, files);
      for (group = group.relative_path(); !group.empty(); group = group.parent_path())
        result = std::min(result, left_by_group(hierarchy / group, files));
      return result;
    }
  } // namespace

  double available_memory(const fs::path &root)
  {
    constexpr double kilobyte = 1024.;
    const auto       memory   = numbers_in(root / "proc/meminfo");
    double           result   = memory.count("MemAvailable:") > 0 ? memory.at("MemAvailable:") * kilobyte : unlimited;

    // Lines "number:controllers:group"; the second version has no controllers there
    const fs::path hierarchies = root / "sys/fs/cgroup";
    std::ifstream  groups(root / "proc/self/cgroup");
    for (std::string line; std::getline(groups, line);)
      {
        std::istringstream parts(line);
        std::string        number, controllers, group;
        std::getline(std::getline(std::getline(parts, number, ':'), controllers, ':'), group);
        if (controllers.empty())
          result = std::min(result, left_by_groups(hierarchies, group, version_2));
        else if (("," + controllers + ",").find(",memory,") != std::string::npos)
          result = std::min(result, left_by_groups(hierarchies / "memory", group, version_1));
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
    double result = rank == 0 ? available_memory() : 0.; // one process of each machine tells
    MPI_Allreduce(MPI_IN_PLACE, &result, 1, MPI_DOUBLE, MPI_SUM, communicator);
    return result;
  }
} // namespace Squeal
