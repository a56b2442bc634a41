#include <squeal/base/exceptions.h>
#include <squeal/output/result_place.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>

namespace Squeal
{
  namespace fs = std::filesystem;

  namespace
  {
    /// The folder's name behind all links, whether there is anything of that name or not.
    fs::path without_links(fs::path path)
    {
      constexpr int most_links = 40; // as for the kernel
      for (int n = 0; n < most_links; ++n)
        {
          const fs::path name = path.filename();
          if (name == "." || name == "..")
            return fs::weakly_canonical(path);
          path = fs::weakly_canonical(path.parent_path()) / name;
          if (!fs::is_symlink(path))
            return path;
          path = path.parent_path() / fs::read_symlink(path);
          path = (path / "").parent_path();
        }
      throw fs::filesystem_error("", path, std::make_error_code(std::errc::too_many_symbolic_link_levels));
    }

    /// Whether something is mounted on a folder: it cannot be renamed then.
    bool is_mounted(const fs::path &folder)
    {
      struct statx properties;
      return ::statx(AT_FDCWD, folder.c_str(), AT_SYMLINK_NOFOLLOW, STATX_BASIC_STATS, &properties) == 0 &&
             (properties.stx_attributes & properties.stx_attributes_mask & STATX_ATTR_MOUNT_ROOT) != 0;
    }

    /// Whether the folder about it lets nobody but the owner rename a folder.
    bool is_held_by_others(const fs::path &folder)
    {
      struct stat inner, outer;
      if (::stat(folder.c_str(), &inner) != 0 || ::stat(folder.parent_path().c_str(), &outer) != 0)
        return false;
      const uid_t user = ::geteuid();
      return (outer.st_mode & S_ISVTX) != 0 && user != 0 && user != inner.st_uid && user != outer.st_uid;
    }

    bool lies_in(const fs::path &inner, const fs::path &outer)
    {
      return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
    }
  } // namespace

  fs::path result_place(const std::string &name)
  {
    if (name.empty())
      throw FileError("the name of the result folder is empty", "--output", "name a folder");
    try
      {
        // The slash at the end, of which there may be one, goes with the empty name behind it.
        return without_links((fs::absolute(name) / "").parent_path());
      }
    catch (const fs::filesystem_error &error)
      {
        throw FileError("the result folder cannot be created: " + error.code().message(), "--output " + name, "choose another name");
      }
  }

  void check_result_place(const fs::path &place, const std::string &name, const std::string &record)
  {
    const std::string where = "--output " + name;
    if (lies_in(fs::current_path(), place))
      throw FileError("`" + name + "` is the folder in which the program was started, or lies about it", where, "name a folder within it");
    if (!fs::exists(place))
      return;
    if (!fs::is_directory(place))
      throw FileError("`" + name + "` is a file, not a folder", where, "choose another name");
    if (is_mounted(place))
      throw FileError("a file system is mounted on `" + name + "`, so that no other folder can take its name", where,
                      "name a folder within it");
    if (::access(place.c_str(), R_OK | W_OK | X_OK) != 0 || is_held_by_others(place))
      throw FileError("the folder `" + name + "` cannot be replaced: Permission denied", where, "choose a folder that you may write to");
    if (!fs::is_empty(place) && !fs::exists(place / record))
      throw FileError("the folder `" + name + "` holds files that are not the results of a run", where,
                      "choose another name, or empty the folder");
  }
} // namespace Squeal
