// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/progress.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace Squeal
{
  /// Names of files relative to a folder, and their sizes [byte].
  using FileSizes = std::map<std::string, std::uintmax_t>;

  /// Metadata for repeating a run and comparing its cost.
  struct RunRecord
  {
    std::string                                 command; ///< shell command that repeats the run
    int                                         n_processes;
    unsigned int                                n_threads;
    int                                         blas_threads;
    std::vector<std::pair<std::string, long>>   counts;     ///< numbers of elements, dofs, contact nodes, modes, ...
    std::vector<std::pair<std::string, double>> quantities; ///< worst element quality, ...
    std::vector<std::string>                    warnings;
    FileSizes                                   files    = {};        ///< files written by the run, except the record
    std::string                                 revision = "unknown"; ///< revision of the program's sources
  };

  std::vector<std::pair<std::string, std::string>> library_versions();

  /// Writes versions, revision, machine, counts, time and peak memory of each step, and files, as JSON.
  void write_run_record(std::ostream &stream, const RunRecord &record, const Progress &progress);

  /// Files listed in a record; no value if the record lists no files or cannot be read.
  std::optional<FileSizes> read_file_list(const std::filesystem::path &record);

  /**
   * Result folder of a run. Files are written to its subfolder `.unfinished` and moved to the folder when the run is complete, the run
   * record last. A run that fails earlier does not change former results. The folder is locked against concurrent runs.
   *
   * Former results that the record lists are replaced or removed; the user's own files are kept, and renamed if a result has the same name.
   * A folder with other files is rejected if it has neither a record nor the subfolder of an unfinished run.
   */
  class ResultFolder
  {
  public:
    /**
     * Creates the folder and checks that it is writable.
     *
     * @param is_root process that creates, moves and removes files
     *
     * Throws FileError if @p directory contains files but no results, is not writable, or is in use.
     */
    ResultFolder(const std::string &directory, bool is_root);

    /// Removes uncommitted files, unless moving them failed.
    ~ResultFolder();

    ResultFolder(const ResultFolder &)            = delete;
    ResultFolder &operator=(const ResultFolder &) = delete;

    /// Writes a file on the root process; throws FileError with the cause if it cannot be written completely.
    void write(const std::string &name, const std::function<void(std::ostream &)> &writer) const;

    /// Files that have been written, with their sizes, for the run record.
    const FileSizes &files() const;

    /**
     * Moves the files to the folder, unless one of them has been removed or changed in the meantime. Returns notes for the user, one line
     * each.
     *
     * @param afterwards called on all processes once the results are in place
     *
     * Throws FileError if files are missing or changed, or cannot be moved; if they cannot be moved, the message names the folder that
     * contains them.
     */
    std::vector<std::string> commit(const std::function<void()> &afterwards = {});

    /// Name of the folder as given by the user.
    const std::string &name() const;

    /// File that marks a folder as the result of a run and lists its files; scripts add the pictures that they draw.
    static constexpr const char *run_record = "run.json";

  private:
    void                     open();
    void                     take_lock();
    std::vector<std::string> put_in_place() const;
    void                     remove_traces();

    const std::string     shown;
    const bool            is_root;
    std::filesystem::path place, unfinished;
    bool                  is_new   = false; ///< true if this run has created the folder
    bool                  is_stuck = false; ///< true if the results are complete but could not be moved
    int                   lock     = -1;    ///< descriptor of the locked folder

    mutable FileSizes written;
  };
} // namespace Squeal
