// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/file_writing.h>
#include <squeal/base/text.h>
#include <squeal/base/version.h>
#include <squeal/output/result_folder.h>

#include <Trilinos_version.h>
#include <cholmod.h>
#include <deal.II/base/config.h>
#include <dmumps_c.h>
#include <gmsh.h>
#include <nlohmann/json.hpp>
#include <umfpack.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <ostream>
#include <sstream>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace Squeal
{
  namespace fs = std::filesystem;

  namespace
  {
    constexpr const char *unfinished_name = ".unfinished";

    /// Normalised name as given by the user, without a trailing slash.
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
                       "check permissions, free disk space and free memory");
    }

    bool is_there(const fs::path &file)
    {
      return fs::exists(fs::symlink_status(file));
    }

    /// First unused name of NAME.kept, NAME.kept-2, ...
    fs::path free_name(const fs::path &file)
    {
      fs::path result = file.string() + ".kept";
      for (int n = 2; is_there(result); ++n)
        result = file.string() + ".kept-" + std::to_string(n);
      return result;
    }
  } // namespace

  ResultFolder::ResultFolder(const std::string &directory, const bool is_root)
    : shown(shown_name(directory))
    , is_root(is_root)
  {
    if (!is_root)
      return;
    if (directory.empty())
      throw FileError("the name of the result folder is empty", "--output", "name a folder");
    try
      {
        place      = (fs::absolute(directory) / "").parent_path(); // without the trailing slash
        unfinished = place / unfinished_name;
        open();
      }
    catch (const fs::filesystem_error &error)
      {
        remove_traces();
        throw FileError("the result folder cannot be created: " + error.code().message(), "--output " + shown,
                        "choose a folder with write permission");
      }
    catch (const FileError &)
      {
        remove_traces();
        throw;
      }
  }

  void ResultFolder::open()
  {
    const std::string where = "--output " + shown;
    if (fs::exists(place) && !fs::is_directory(place))
      throw FileError("`" + shown + "` is a file, not a folder", where, "choose another name");
    is_new = fs::create_directories(place);
    if (!fs::is_empty(place) && !fs::exists(place / run_record) && !fs::exists(unfinished))
      throw FileError("the folder `" + shown + "` contains files that are not the results of a run", where,
                      "choose another name, or empty the folder");
    take_lock();
    fs::remove_all(unfinished); // files of a killed run
    fs::create_directory(unfinished);

    // Detect a full disk, or a file system that forbids long names, before the computation
    constexpr std::size_t longest_name = 200, size = 4096;
    const fs::path        file    = unfinished / std::string(longest_name, 'x');
    const int             problem = write_file(file, std::string(size, ' '));
    fs::remove(file);
    if (problem != 0)
      throw FileError(std::string("files cannot be written to the result folder: ") + std::strerror(problem), where,
                      "choose a folder with write permission and free disk space");
  }

  void ResultFolder::take_lock()
  {
    lock = ::open(place.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (::flock(lock, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) // ignore other errors, because some file systems have no locks
      return;
    ::close(lock);
    lock = -1; // keeps remove_traces() from removing the files of the other run
    throw FileError("another run is writing to `" + shown + "`", "--output " + shown,
                    "wait until the other run has ended, or choose another folder");
  }

  ResultFolder::~ResultFolder()
  {
    remove_traces();
  }

  /// Removes uncommitted results, unless moving them failed, and a new folder that is empty.
  void ResultFolder::remove_traces()
  {
    std::error_code ignored;
    if (lock >= 0)
      {
        if (!is_stuck)
          fs::remove_all(unfinished, ignored);
        ::close(lock);
        lock = -1;
      }
    if (is_new)
      fs::remove(place, ignored); // fails if the folder is not empty
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
    const fs::path    file = unfinished / name;
    std::error_code   ignored;
    fs::create_directories(file.parent_path(), ignored);
    if (const int problem = write_file(file, text); problem != 0)
      throw not_written(shown + "/" + name, problem);
    written[name] = text.size();
  }

  const FileSizes &ResultFolder::files() const
  {
    return written;
  }

  /// Moves the files, the record last, so that a folder with a record is complete.
  std::vector<std::string> ResultFolder::put_in_place() const
  {
    const FileSizes former = read_file_list(place / run_record).value_or(FileSizes());
    fs::remove(place / run_record);
    for (const auto &[name, size] : former)
      if (written.count(name) == 0)
        {
          std::error_code ignored;
          fs::remove(place / name, ignored);
          for (fs::path folder = fs::path(name).parent_path(); !folder.empty(); folder = folder.parent_path())
            fs::remove(place / folder, ignored); // fails if the folder is not empty
        }

    std::vector<std::string> remarks;
    const auto               move = [&](const std::string &name) {
      const fs::path target = place / name;
      if (is_there(target) && (former.count(name) == 0 || fs::is_directory(fs::symlink_status(target))))
        {
          const fs::path kept = free_name(target);
          fs::rename(target, kept);
          remarks.push_back("the results use the name `" + name + "`; your file in " + shown + " was renamed to `" +
                                          kept.lexically_relative(place).string() + "`");
        }
      fs::create_directories(target.parent_path());
      fs::rename(unfinished / name, target);
    };
    for (const auto &[name, size] : written)
      if (name != run_record)
        move(name);
    if (written.count(run_record) > 0)
      fs::rename(unfinished / run_record, place / run_record);
    fs::remove_all(unfinished);
    return remarks;
  }

  std::vector<std::string> ResultFolder::commit(const std::function<void()> &afterwards)
  {
    std::vector<std::string> remarks;
    if (is_root)
      {
        for (const auto &[name, size] : written)
          if (std::error_code missing; fs::file_size(unfinished / name, missing) != size)
            throw FileError("a result was removed or changed while the program ran", "file " + shown + "/" + name,
                            "make sure that no other program changes the result folder, and run again");
        try
          {
            remarks = put_in_place();
          }
        catch (const fs::filesystem_error &error)
          {
            is_stuck = true;
            throw FileError("the results cannot be moved to the result folder: " + error.code().message(), "--output " + shown,
                            "move the remaining results from `" + unfinished.string() + "` to this folder");
          }
      }
    if (afterwards)
      afterwards();
    return remarks;
  }

  const std::string &ResultFolder::name() const
  {
    return shown;
  }

  namespace
  {
    using Json = nlohmann::ordered_json;

    constexpr const char *file_list = "files [byte]";

    /// Current time in the form 2026-01-31T12:00:00Z.
    std::string utc_time()
    {
      const std::time_t  now = std::time(nullptr);
      std::ostringstream text;
      text << std::put_time(std::gmtime(&now), "%Y-%m-%dT%H:%M:%SZ");
      return text.str();
    }
  } // namespace

  std::vector<std::pair<std::string, std::string>> library_versions()
  {
    return {{"deal.II", DEAL_II_PACKAGE_VERSION},
            {"Trilinos", TRILINOS_VERSION_STRING},
            {"MUMPS", MUMPS_VERSION},
            {"CHOLMOD", text(CHOLMOD_MAIN_VERSION, ".", CHOLMOD_SUB_VERSION, ".", CHOLMOD_SUBSUB_VERSION)},
            {"UMFPACK", text(UMFPACK_MAIN_VERSION, ".", UMFPACK_SUB_VERSION, ".", UMFPACK_SUBSUB_VERSION)},
            {"Gmsh", GMSH_API_VERSION}};
  }

  void write_run_record(std::ostream &stream, const RunRecord &record, const Progress &progress)
  {
    Json tree;
    tree["command"]  = record.command;
    tree["finished"] = utc_time();
    tree["versions"] = {{"squeal", version}, {"revision", record.revision}};
    for (const auto &[library, its_version] : library_versions())
      tree["versions"][library] = its_version;
    tree["machine"] = {{"cores", std::thread::hardware_concurrency()},
                       {"processes", record.n_processes},
                       {"threads per process", record.n_threads},
                       {"BLAS threads per process", record.blas_threads}};
    for (const auto &[name, count] : record.counts)
      tree["counts"][name] = count;
    for (const auto &[name, value] : record.quantities)
      tree["quantities"][name] = value;
    tree["warnings"]      = record.warnings;
    tree["wall time [s]"] = progress.elapsed();
    for (const StepRecord &step : progress.steps())
      tree["steps"].push_back({{"name", step.name},
                               {"wall time [s]", step.seconds},
                               {"CPU time [s]", step.cpu_seconds},
                               {"peak memory so far [byte]", step.peak_memory},
                               {"result", step.summary}});
    tree[file_list] = record.files;
    // Replace invalid bytes, because file names and command-line words need not be UTF-8
    stream << tree.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  }

  std::optional<FileSizes> read_file_list(const std::filesystem::path &record)
  {
    std::ifstream stream(record);
    try
      {
        return Json::parse(stream).at(file_list).get<FileSizes>();
      }
    catch (const Json::exception &)
      {
        return {};
      }
  }
} // namespace Squeal
