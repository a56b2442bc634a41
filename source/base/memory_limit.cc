#include <squeal/base/memory_limit.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>

namespace Squeal
{
  namespace fs = std::filesystem;

  namespace
  {
    constexpr double unlimited = std::numeric_limits<double>::infinity();

    /// The number behind a word at the beginning of a line; nothing if there is none.
    std::optional<double> number_behind(const fs::path &file, const std::string &word)
    {
      std::ifstream stream(file);
      for (std::string line; std::getline(stream, line);)
        {
          std::istringstream words(line);
          std::string        first;
          double             number;
          if (words >> first && first == word && words >> number)
            return number;
        }
      return {};
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
      const fs::path statistics = folder / "memory.stat";
      const double   cache =
        number_behind(statistics, files.inactive_cache).value_or(0.) + number_behind(statistics, files.active_cache).value_or(0.);
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
    double           result   = unlimited;
    if (const auto available = number_behind(root / "proc/meminfo", "MemAvailable:"))
      result = *available * kilobyte;

    // Lines "number:controllers:group"; the second version has no controllers there
    const fs::path hierarchies = root / "sys/fs/cgroup";
    std::ifstream  groups(root / "proc/self/cgroup");
    for (std::string line; std::getline(groups, line);)
      {
        std::istringstream parts(line);
        std::string        number, controllers, group;
        std::getline(parts, number, ':');
        std::getline(parts, controllers, ':');
        std::getline(parts, group);
        if (controllers.empty())
          result = std::min(result, left_by_groups(hierarchies, group, version_2));
        else if (("," + controllers + ",").find(",memory,") != std::string::npos)
          result = std::min(result, left_by_groups(hierarchies / "memory", group, version_1));
      }
    return result;
  }
} // namespace Squeal
