#pragma once

#include <squeal/stability/certified_sweep.h>

#include <Epetra_Map.h>
#include <mpi.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// The folder beside that of the results called @p output in which an unfinished sweep is kept; a ResultFolder does not touch it.
  std::string checkpoint_folder(const std::string &output);

  /**
   * Keeps what a sweep has found in a folder, so that an interrupted run
   * continues. It stays when a run fails, until remove(). All
   * processes must call everything; process 0 alone reads and writes, and an
   * error there is thrown on all.
   *
   * `parameters.prm` tells whose sweep it is; `points.csv` is for the reader, with
   * one row for each mode of the band. Results and blocks of the basis are
   * binary files with every bit, their rows in the global order: a sweep may
   * continue on another number of processes. A file appears under its name
   * when it is complete. A result that is damaged nevertheless is computed anew; where
   * a block is damaged or missing all is, since results and later blocks rest on it.
   */
  class ChartCheckpoint : public ChartStore
  {
  public:
    /**
     * Begins a sweep in @p folder, or finds the one that lies there.
     *
     * @param folder            created with its parents if need be
     * @param key               text of a parameter file; names everything on which results depend, the version of the program included
     * @param rows              of the vectors of the basis
     * @param largest_frequency end of the band [rad/s], for `points.csv`
     *
     * Throws FileError if the unfinished sweep in @p folder has another key, if the folder
     * holds something else, or if it cannot be read or written.
     */
    ChartCheckpoint(const std::string &folder, const std::string &key, const Epetra_Map &rows, MPI_Comm communicator, double largest_frequency);

    /// Results that were there at the start.
    int n_found() const;

    std::optional<ChartPoint> find(const OperatingPoint &point) const override;

    /// Throws FileError if the files cannot be written; what was kept before stays.
    void keep(const OperatingPoint &point, const ChartPoint &result) override;

    std::vector<MultiVector> basis() const override;

    /// Throws FileError if the file cannot be written; what was kept before stays.
    void keep(const MultiVector &block) override;

    /// Deletes the folder when nothing in it is needed any more; throws FileError if it cannot.
    void remove();

    /// Whose sweep it is.
    static constexpr const char *key_file = "parameters.prm";
    /// What it has found, for the reader.
    static constexpr const char *points_file = "points.csv";

  private:
    /// Calls @p action on process 0; what it throws is thrown on all processes as a FileError.
    void on_root(const std::function<void()> &action) const;

    // On process 0 only:
    void               open(const std::string &key);
    bool               read_blocks();        ///< whether all are there
    std::optional<int> read_results() const; ///< how many; nothing if they rest on blocks that are not there
    void               start_afresh();

    std::string folder;
    Epetra_Map  rows;
    MPI_Comm    communicator;
    bool        is_root;
    double      largest_frequency;
    int         n_blocks = 0, n_results = 0;
  };
} // namespace Squeal
