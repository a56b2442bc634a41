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
  /// Names of files, seen from a folder, and their sizes [byte].
  using FileSizes = std::map<std::string, std::uintmax_t>;

  /// What a run was: enough to repeat it and to compare its cost.
  struct RunRecord
  {
    std::string                                 command;     ///< that repeats it in a shell
    int                                         n_processes; ///< of MPI
    unsigned int                                n_threads;
    int                                         blas_threads;
    std::vector<std::pair<std::string, long>>   counts;               ///< elements, dofs, contact nodes, modes, ...
    std::vector<std::pair<std::string, double>> quantities;           ///< worst element quality, ...
    std::vector<std::string>                    warnings;             ///< doubts about the input
    FileSizes                                   files    = {};        ///< what the run has written, but for the record itself
    std::string                                 revision = "unknown"; ///< of the program's sources
  };

  /// Names and versions of the libraries that this build uses.
  std::vector<std::pair<std::string, std::string>> library_versions();

  /// Versions, revision, machine, counts, time and peak memory of each step, and files, as JSON.
  void write_run_record(std::ostream &stream, const RunRecord &record, const Progress &progress);

  /// The files that a record lists; nothing if it lists none or cannot be read.
  std::optional<FileSizes> read_file_list(const std::filesystem::path &record);

  /**
   * The folder of the results of a run. Files are written into its folder `.unfinished` and moved to their place when the run is complete, the
   * run record last. A run that fails leaves former results as they are; what a killed one leaves in `.unfinished`, the next one clears away.
   * A lock on the folder keeps a second run out.
   *
   * Of former results, the files that the record lists are replaced or removed; the user's own files stay. A folder without a record that holds
   * anything else is never written to.
   */
  class ResultFolder
  {
  public:
    /**
     * Makes the folder and tries whether files can be written there.
     *
     * @param is_root process that creates, moves and removes
     *
     * Throws FileError if @p directory holds something other than results, cannot be written to, or is in use.
     */
    ResultFolder(const std::string &directory, bool is_root);

    /// Removes what was not committed.
    ~ResultFolder();

    ResultFolder(const ResultFolder &)            = delete;
    ResultFolder &operator=(const ResultFolder &) = delete;

    /// Writes a file on the root process; throws FileError with the cause if it could not be written to the end.
    void write(const std::string &name, const std::function<void(std::ostream &)> &writer) const;

    /// What the run has written so far, with sizes; for its record.
    const FileSizes &files() const;

    /**
     * Moves the files to their place, unless one of them was removed or changed meanwhile. Returns what the user should know, one line each.
     *
     * @param afterwards done when the results are in their place, on all processes
     *
     * Throws FileError if files are missing, or cannot be moved; in the latter case the message says where they are.
     */
    std::vector<std::string> commit(const std::function<void()> &afterwards = {});

    /// Name of the folder, as the user has it.
    const std::string &name() const;

    /// File that marks a folder as the result of a run, and lists its files; scripts add the pictures that they draw of them.
    static constexpr const char *run_record = "run.json";

  private:
    void                     open();
    void                     take_lock();
    std::vector<std::string> put_in_place() const;
    void                     remove_traces();

    const std::string     shown; ///< name as the user has it
    const bool            is_root;
    std::filesystem::path place, unfinished;
    bool                  is_new   = false; ///< made by this run
    bool                  is_stuck = false; ///< complete, but could not be moved
    int                   lock     = -1;    ///< descriptor of the folder, which is locked

    mutable FileSizes written; ///< whoever may write to the folder adds to the list
  };
} // namespace Squeal
