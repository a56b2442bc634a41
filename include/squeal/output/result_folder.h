#pragma once

#include <squeal/base/interruption.h>
#include <squeal/output/folder_lock.h>
#include <squeal/output/result_files.h>

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace Squeal
{
  /**
   * The folder in which a run leaves its results. Everything is written into a
   * temporary folder beside it, which takes its name when the run is complete;
   * a run that fails or is killed leaves the earlier results as they are, and
   * no other run may write to the same folder meanwhile.
   *
   * Of an earlier result, the files of that run are replaced, and what the user
   * put there stays. A folder that holds no result at all is never replaced.
   */
  class ResultFolder
  {
  public:
    /**
     * Makes the temporary folder and tries whether files can be written there.
     *
     * @param directory    name of the folder after commit(); links are followed
     * @param is_root      process that creates, renames and removes
     * @param command      of this run, for other runs that want the folder
     * @param interruption lets a signal clean up here; none if null
     *
     * Throws FileError if @p directory holds something other than results, cannot be created or replaced, or is in use.
     */
    ResultFolder(const std::string &directory, bool is_root, const std::string &command = "", Interruption *interruption = nullptr);

    /// Removes the temporary folder unless committed.
    ~ResultFolder();

    ResultFolder(const ResultFolder &)            = delete;
    ResultFolder &operator=(const ResultFolder &) = delete;

    /// Writes a file on the root process; throws FileError with the cause if it could not be written to the end.
    void write(const std::string &name, const std::function<void(std::ostream &)> &writer) const;

    /**
     * Begins a file that a library writes: an empty one, whose path the root process gets. Throws FileError with the cause, there, if it
     * cannot be made.
     */
    std::filesystem::path begin_file(const std::string &name) const;

    /// Notes what a library has written.
    void end_file(const std::string &name) const;

    /// What the run has written so far, with sizes; for its record.
    FileSizes files() const;

    /**
     * Gives the folder its name. Nothing happens to earlier results unless all
     * files are there to their last byte. Returns what the user should know, one line each.
     *
     * @param afterwards done when the results are in their place, on all processes; a signal waits until it is done, too, so that
     *                   what only an unfinished run needs goes with the run
     *
     * Throws FileError if files are missing, or the folder cannot be put in its
     * place; in the latter case the message says where the results are.
     */
    std::vector<std::string> commit(const std::function<void()> &afterwards = {});

    /// Name of the finished folder, as the user has it.
    const std::string &name() const;

    /// File that marks a folder as the result of a run, and lists its files; scripts add the pictures that they draw of them.
    static constexpr const char *run_record = "run.json";

  private:
    enum class State
    {
      not_begun,
      at_work,  ///< the temporary folder is ours and goes with us
      unplaced, ///< results are complete but could not be put in place
      in_place
    };

    void                         open(const std::string &command);
    std::filesystem::path        write_now(const std::string &name, const std::string &text) const;
    void                         settle_former_run() const;
    void                         try_writing() const;
    void                         check_complete(const std::filesystem::path &folder, const FileSizes &sizes) const;
    std::vector<std::string>     bring_user_files() const;
    void                         put_in_place() const;
    void                         remove_traces();
    std::unique_lock<std::mutex> uninterrupted() const;

    const std::string                  shown; ///< name as the user has it
    const bool                         is_root;
    Interruption *const                interruption;
    std::filesystem::path              place, unfinished, replaced;
    std::vector<std::filesystem::path> new_parents; ///< folders made on the way to it, outermost first
    std::unique_ptr<FolderLock>        lock;
    State                              state = State::not_begun;

    mutable FileSizes written; ///< whoever may write to the folder adds to the list
  };
} // namespace Squeal
