#pragma once

#include <squeal/tracking/error_controlled_sweep.h>

#include <mpi.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace Squeal
{
  /// The folder beside that of the results called @p output in which an unfinished sweep is kept; a ResultFolder does not touch it.
  std::string checkpoint_folder(const std::string &output);

  /**
   * Keeps what a sweep has found, so that an interrupted run continues. It stays when a run fails, until remove(). All processes must
   * call everything; process 0 alone reads and writes, and an error there is thrown on all.
   *
   * `sweep.key` identifies the sweep; every result and every block of a basis is a numbered file, which gets its name when it is
   * complete and before the sweep goes on. Files are read in the order of their numbers up to the first that is missing or damaged,
   * since later ones rest on it. Blocks have all rows in the order of their numbers: a sweep may continue on another number of
   * processes.
   */
  class ChartCheckpoint
  {
  public:
    /**
     * Reads the unfinished sweep that lies in @p folder, if there is one.
     *
     * @param folder created with its parents when the first result or block comes
     * @param key    text that names everything on which results depend, the version of the program included
     *
     * Throws FileError if the unfinished sweep in @p folder has another key, if the folder
     * holds something else, or if it cannot be read.
     */
    ChartCheckpoint(const std::string &folder, const std::string &key, MPI_Comm communicator);

    /// Results that an earlier run has kept.
    int n_found() const;

    /**
     * A part of the sweep that has a basis of its own with @p rows, as a store that refers to this checkpoint: it finds what an
     * earlier run has kept there, and keeps what is found now. Throws FileError if it cannot; what was kept before stays.
     */
    std::unique_ptr<ChartStore> part(const std::string &name, const RowMap &rows);

    /// Deletes the folder when nothing in it is needed any more; throws FileError if it cannot.
    void remove();

    static constexpr const char *key_name = "sweep.key";

  private:
    class Part;
    struct Record;

    /// What an earlier run has kept of a part: results by line and friction coefficient.
    struct Contents
    {
      std::vector<DenseMatrix>                     blocks;
      std::map<std::pair<int, double>, ChartPoint> results;
    };

    /// Calls @p action on process 0; what it throws is thrown on all processes as a FileError.
    void on_root(const std::function<void()> &action) const;

    // On process 0 only:
    void        open();
    bool        read(const std::string &file); ///< whether it is a whole record
    void        keep(const Record &record);
    std::string file(int number) const;

    const std::string               folder, identity;
    const MPI_Comm                  communicator;
    std::map<std::string, Contents> parts;
    int                             n_records = 0, n_results = 0;
  };
} // namespace Squeal
