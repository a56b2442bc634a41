#include <squeal/output/result_files.h>

#include <fcntl.h>
#include <stdio.h>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <system_error>

namespace Squeal
{
  namespace fs = std::filesystem;

  namespace
  {
    template <std::size_t n>
    bool contains(const char *const (&words)[n], const fs::path &word)
    {
      return std::any_of(std::begin(words), std::end(words), [&](const char *candidate) { return word == candidate; });
    }

    bool is_there(const fs::path &file)
    {
      return fs::exists(fs::symlink_status(file));
    }

    /// The name under which a foreign file finds a place in @p folder: the part of it that is taken there is changed.
    fs::path name_in(const fs::path &folder, const fs::path &name, const fs::path &former_folder)
    {
      fs::path result;
      for (auto part = name.begin(); part != name.end(); ++part)
        {
          const bool is_last = std::next(part) == name.end();
          const auto is_free = [&](const fs::path &candidate) {
            return !is_there(folder / candidate) || (!is_last && fs::is_directory(fs::symlink_status(folder / candidate)));
          };
          fs::path candidate = result / *part;
          for (int n = 1; !is_free(candidate) || (n > 1 && is_there(former_folder / candidate)); ++n)
            candidate = (result / *part).string() + ".kept" + (n > 1 ? "-" + std::to_string(n) : "");
          result = candidate;
        }
      return result;
    }

    void link_or_copy(const fs::path &from, const fs::path &to)
    {
      fs::create_directories(to.parent_path());
      std::error_code problem;
      fs::create_hard_link(from, to, problem);
      if (!problem)
        return;
      fs::copy(from, to, fs::copy_options::copy_symlinks);
      if (fs::is_regular_file(fs::symlink_status(to)))
        fs::last_write_time(to, fs::last_write_time(from));
    }
  } // namespace

  FileSizes files_below(const fs::path &folder)
  {
    FileSizes result;
    for (const auto &entry : fs::recursive_directory_iterator(folder))
      if (fs::is_regular_file(entry.symlink_status()))
        result[entry.path().lexically_relative(folder).string()] = entry.file_size();
    return result;
  }

  std::string first_incomplete(const fs::path &folder, const FileSizes &files)
  {
    for (const auto &[name, size] : files)
      if (std::error_code missing; fs::file_size(folder / name, missing) != size)
        return name;
    return {};
  }

  bool is_name_of_result(const fs::path &name)
  {
    constexpr const char *folders[] = {"modes", "animations", "plots", "matrices"};
    constexpr const char *endings[] = {".csv", ".vtu", ".pvd", ".h5", ".xdmf", ".dat", ".gp", ".svg", ".mtx", ".msh"};
    constexpr const char *files[]   = {"parameters.prm", "run.json"};
    return contains(files, name) || (contains(endings, name.extension()) && (!name.has_parent_path() || contains(folders, *name.begin())));
  }

  std::vector<std::pair<std::string, std::string>> bring_over(const fs::path                                 &from,
                                                              const fs::path                                 &to,
                                                              const std::function<bool(const std::string &)> &is_of_run)
  {
    std::vector<std::pair<std::string, std::string>> renamed;
    for (const auto &entry : fs::recursive_directory_iterator(from))
      {
        const fs::path name = entry.path().lexically_relative(from);
        if (fs::is_directory(entry.symlink_status()) || is_of_run(name.string()))
          continue;
        const fs::path new_name = name_in(to, name, from);
        link_or_copy(entry.path(), to / new_name);
        if (new_name != name)
          renamed.emplace_back(name.string(), new_name.string());
      }
    return renamed;
  }

  bool exchange(const fs::path &one, const fs::path &other)
  {
    if (::renameat2(AT_FDCWD, one.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) == 0)
      return true;
    if (errno == EINVAL || errno == ENOSYS || errno == EOPNOTSUPP)
      return false;
    throw fs::filesystem_error("rename", one, other, std::error_code(errno, std::generic_category()));
  }

  void move_to_place(const fs::path &complete, const fs::path &place, const fs::path &aside)
  {
    fs::rename(place, aside);
    std::error_code problem;
    fs::rename(complete, place, problem);
    if (!problem)
      return;
    fs::rename(aside, place);
    throw fs::filesystem_error("rename", complete, place, problem);
  }
} // namespace Squeal
