#include <squeal/base/exceptions.h>
#include <squeal/base/file_writing.h>
#include <squeal/output/result_folder.h>
#include <squeal/output/run_record.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <sstream>
#include <system_error>
#include <utility>

namespace Squeal
{
  namespace fs = std::filesystem;

  namespace
  {
    /// As the user wrote it, without the slash at its end and detours.
    std::string shown_name(const std::string &directory)
    {
      std::string name = fs::path(directory).lexically_normal().string();
      while (name.size() > 1 && name.back() == '/')
        name.pop_back();
      return name;
    }

    FileError not_written(const std::string &file, const int problem)
    {
      return FileError(std::string("the file cannot be written: ") + std::strerror(problem), "file " + file,
                       "check permissions and free space");
    }

    /// Whether a folder is there with something in it.
    bool holds_something(const fs::path &folder)
    {
      return fs::exists(fs::symlink_status(folder)) && !(fs::is_directory(folder) && fs::is_empty(folder));
    }

    void check_not_removed(const fs::path &unfinished, const std::string &shown)
    {
      std::error_code ignored;
      if (!fs::is_directory(unfinished, ignored))
        throw FileError("the folder of the unfinished results was removed while the program ran", "folder " + shown + ".unfinished",
                        "let nothing else write to the folders of a run, and run again");
    }

    /// Waits until the disk has everything; returns the number of the error, or 0.
    int store(const fs::path &folder)
    {
      const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
      const int problem    = descriptor < 0 || ::syncfs(descriptor) != 0 ? errno : 0;
      if (descriptor >= 0)
        ::close(descriptor);
      return problem;
    }

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

    /**
     * Where a result folder of this name comes to lie: absolute, all symbolic links
     * followed, so that a link goes on pointing to the results.
     *
     * Throws FileError if the name is empty, too long, or leads round in circles.
     */
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

    /**
     * Throws FileError if results cannot be put at @p place: there is a file, or a
     * folder that holds something other than results, or one that cannot be replaced
     * since programs work in it, something is mounted on it, or the user may not.
     *
     * @param name   as the user has it, for messages
     * @param record file that marks a folder as results
     */
    void check_result_place(const fs::path &place, const std::string &name, const std::string &record)
    {
      const std::string where = "--output " + name;
      if (lies_in(fs::current_path(), place))
        throw FileError("`" + name + "` is the folder in which the program was started, or lies about it", where,
                        "name a folder within it");
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
  } // namespace

  ResultFolder::ResultFolder(const std::string &directory, const bool is_root, const std::string &command, Interruption *interruption)
    : shown(shown_name(directory))
    , is_root(is_root)
    , interruption(interruption)
  {
    if (!is_root)
      return;
    place           = result_place(directory);
    unfinished      = place.string() + ".unfinished";
    replaced        = place.string() + ".replaced";
    const auto held = uninterrupted();
    try
      {
        open(command);
      }
    catch (const fs::filesystem_error &error)
      {
        remove_traces();
        throw FileError("the result folder cannot be created: " + error.code().message(), "--output " + shown,
                        "choose a folder that you may write to");
      }
    catch (const FileError &)
      {
        remove_traces();
        throw;
      }
    if (interruption != nullptr)
      interruption->before_end([this] {
        remove_traces();
        return state == State::in_place ? "the results were complete" : "no results were written";
      });
  }

  void ResultFolder::open(const std::string &command)
  {
    check_result_place(place, shown, run_record);
    for (fs::path parent = place.parent_path(); !fs::exists(parent); parent = parent.parent_path())
      new_parents.insert(new_parents.begin(), parent);
    fs::create_directories(place.parent_path());
    lock = std::make_unique<FolderLock>(place.string() + ".lock", shown, command);
    settle_former_run();
    // Once more, as another run may have ended meanwhile
    check_result_place(place, shown, run_record);
    state = State::at_work;
    fs::create_directory(unfinished);
    try_writing();
  }

  /// Clears away what a run has left that was killed.
  void ResultFolder::settle_former_run() const
  {
    if (lock->was_left_behind())
      {
        if (!fs::exists(place) && fs::exists(replaced))
          fs::rename(replaced, place);
        fs::remove_all(replaced);
        fs::remove_all(unfinished);
      }
    for (const fs::path &folder : {unfinished, replaced})
      if (holds_something(folder))
        throw FileError("`" + folder.string() + "` is in the way: the program needs this name for a while", "--output " + shown,
                        "move or delete it, or choose another name");
  }

  /// A disk that is full and names that are too long should show before the work, not after.
  void ResultFolder::try_writing() const
  {
    constexpr std::size_t longest_name = 200, size = 4096;
    const fs::path        file    = unfinished / std::string(longest_name, 'x');
    const int             problem = write_file(file, O_TRUNC, {std::string(size, ' ')}, true);
    fs::remove(file);
    if (problem != 0)
      throw FileError(std::string("files cannot be written to the result folder: ") + std::strerror(problem), "--output " + shown,
                      "choose a folder that you may write to, with free space");
  }

  ResultFolder::~ResultFolder()
  {
    const auto held = uninterrupted();
    remove_traces();
    if (is_root && interruption != nullptr)
      interruption->before_end({});
  }

  std::unique_lock<std::mutex> ResultFolder::uninterrupted() const
  {
    return interruption != nullptr ? interruption->hold() : std::unique_lock<std::mutex>();
  }

  /// Removes everything but results in their place.
  void ResultFolder::remove_traces()
  {
    std::error_code ignored;
    if (state == State::at_work)
      {
        // A library may go on writing.
        constexpr int most_attempts = 100;
        for (int n = 0; n < most_attempts && fs::exists(unfinished, ignored); ++n)
          fs::remove_all(unfinished, ignored);
      }
    lock.reset();
    if (state != State::in_place)
      for (auto parent = new_parents.rbegin(); parent != new_parents.rend(); ++parent)
        fs::remove(*parent, ignored);
  }

  void ResultFolder::write(const std::string &name, const std::function<void(std::ostream &)> &writer) const
  {
    if (!is_root)
      return;
    std::ostringstream stream;
    writer(stream);
    if (stream.bad())
      throw not_written(shown + "/" + name, ENOMEM);
    const std::string text = stream.str();
    write_now(name, text);
  }

  fs::path ResultFolder::write_now(const std::string &name, const std::string &text) const
  {
    // Once a signal has begun to clear away, nothing new may come up.
    const auto held = uninterrupted();
    check_not_removed(unfinished, shown);
    const fs::path  file = unfinished / name;
    std::error_code ignored;
    fs::create_directories(file.parent_path(), ignored);
    if (const int problem = write_file(file, O_TRUNC, {text}, false); problem != 0)
      throw not_written(shown + "/" + name, problem);
    written[name] = text.size();
    return file;
  }

  fs::path ResultFolder::begin_file(const std::string &name) const
  {
    return is_root ? write_now(name, "") : fs::path();
  }

  void ResultFolder::end_file(const std::string &name) const
  {
    if (!is_root)
      return;
    check_not_removed(unfinished, shown);
    std::error_code problem;
    written[name] = fs::file_size(unfinished / name, problem);
    if (problem)
      throw not_written(shown + "/" + name, problem.value());
  }

  FileSizes ResultFolder::files() const
  {
    if (!is_root)
      return {};
    check_not_removed(unfinished, shown);
    return files_below(unfinished);
  }

  void ResultFolder::check_complete(const fs::path &folder, const FileSizes &sizes) const
  {
    if (const std::string missing = first_incomplete(folder, sizes); !missing.empty())
      throw FileError("a result was removed or changed while the program ran", "file " + shown + "/" + missing,
                      "let nothing else write to the folders of a run, and run again");
  }

  std::vector<std::string> ResultFolder::bring_user_files() const
  {
    std::vector<std::string> remarks;
    const auto               listed    = read_file_list(place / run_record);
    const bool               is_result = fs::exists(place / run_record);
    const auto               is_of_run = [&](const std::string &file) {
      return file == run_record || (listed ? listed->count(file) > 0 : is_result && is_name_of_result(file));
    };
    for (const auto &[name, new_name] : bring_over(place, unfinished, is_of_run))
      remarks.push_back("the results need the name `" + name + "`: the file of yours in " + shown + " is `" + new_name + "` now");
    fs::permissions(unfinished, fs::status(place).permissions());
    return remarks;
  }

  /// At every moment `place`, or else `replaced`, is a complete folder.
  void ResultFolder::put_in_place() const
  {
    if (!fs::exists(place))
      fs::rename(unfinished, place);
    else if (!exchange(unfinished, place))
      move_to_place(unfinished, place, replaced);
  }

  std::vector<std::string> ResultFolder::commit(const std::function<void()> &afterwards)
  {
    if (!is_root)
      {
        if (afterwards)
          afterwards();
        return {};
      }
    const auto held = uninterrupted();
    check_complete(unfinished, written);
    // The folder must not take its name with files that a failure of the machine could cut.
    if (const int problem = store(unfinished); problem != 0)
      throw not_written(shown, problem);
    const FileSizes          complete = files();
    std::vector<std::string> remarks;
    try
      {
        if (fs::exists(place))
          remarks = bring_user_files();
        put_in_place();
        state = State::in_place;
      }
    catch (const fs::filesystem_error &error)
      {
        // Without the file of the lock, no later run clears it away.
        state = State::unplaced;
        throw FileError("the results cannot be moved to their place: " + error.code().message(), "--output " + shown,
                        "they are complete in `" + unfinished.string() + "`: move them yourself");
      }
    check_complete(place, complete);
    for (const fs::path &former : {unfinished, replaced})
      {
        std::error_code problem;
        fs::remove_all(former, problem);
        if (problem)
          remarks.push_back("the former results in `" + former.string() + "` cannot be deleted: " + problem.message());
      }
    if (afterwards)
      afterwards();
    return remarks;
  }

  const std::string &ResultFolder::name() const
  {
    return shown;
  }
} // namespace Squeal
