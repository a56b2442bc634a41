#pragma once

#include <squeal/tracking/error_controlled_sweep.h>

#include <mpi.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
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
   * Keeps what a sweep has found in one archive, so that an interrupted run continues. It stays when a run fails, until
   * remove(). All processes must call everything; process 0 alone reads and writes, and an error there is thrown on all.
   *
   * The archive begins with the version of its format and what identifies the sweep; results and blocks of bases follow as they are
   * found, each written before the sweep goes on; a loss of power costs what the last second has found. What a killed run or a full disk leaves of one is cut off when the archive is
   * read or the next one comes. To append costs what a record costs, while a file that replaces the former one would cost all of
   * them every time. Blocks have all rows in the order of their numbers: a sweep may continue on another number of processes. A
   * damaged result is computed anew; where a block is damaged everything is, since results and later
   * blocks rest on it. `points.csv` shows the reader every mode of the band.
   */
  class ChartCheckpoint
  {
  public:
    /**
     * Reads the unfinished sweep that lies in @p folder, if there is one.
     *
     * @param folder            created with its parents when the first result or block comes
     * @param key               text that names everything on which results depend, the version of the program included
     * @param largest_circular_frequency end of the band [rad/s], for `points.csv`
     *
     * Throws FileError if the unfinished sweep in @p folder has another key, if the folder
     * holds something else, or if it cannot be read.
     */
    ChartCheckpoint(const std::string &folder, const std::string &key, MPI_Comm communicator, double largest_circular_frequency);

    /// Results that an earlier run has kept.
    int n_found() const;

    /**
     * A part of the sweep that has a basis of its own with @p rows, as a store that refers to this checkpoint: it finds what an
     * earlier run has kept there, and keeps what is found now. Throws FileError if it cannot; what was kept before stays.
     */
    std::unique_ptr<ChartStore> part(const std::string &name, const RowMap &rows);

    /// Deletes the folder when nothing in it is needed any more; throws FileError if it cannot.
    void remove();

    static constexpr const char *archive_name = "sweep.archive";
    static constexpr const char *points_name  = "points.csv";

  private:
    class Part;
    struct Record;

    /// What an archive holds of a part: results by line and friction coefficient.
    struct Contents
    {
      int                                          n_blocks = 0; ///< with those of this run
      std::vector<DenseMatrix>                     blocks;
      std::map<std::pair<int, double>, ChartPoint> results;
    };

    /// Calls @p action on process 0; what it throws is thrown on all processes as a FileError.
    void on_root(const std::function<void()> &action) const;

    // On process 0 only:
    void open();
    bool read();                                            ///< whether no block is missing on which others rest
    void append(const Record &record, const double *block); ///< the entries of a block are written from where they lie

    const std::string                     folder, identity;
    const std::filesystem::path           archive;
    const MPI_Comm                        communicator;
    const double                          largest_circular_frequency;
    std::map<std::string, Contents>       parts;
    bool                                  is_begun  = false; ///< whether the archive is this sweep's
    int                                   n_results = 0;
    std::uintmax_t                        end       = 0; ///< of the last record of the archive [byte]
    std::chrono::steady_clock::time_point last_on_disk;
  };
} // namespace Squeal
