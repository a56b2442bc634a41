// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/text.h>
#include <squeal/output/result_folder.h>
#include <squeal/output/table.h>
#include <squeal/parameters/parameters.h>

#include <mpi.h>

#include <memory>

namespace Squeal
{
  /// MPI processes on this machine.
  unsigned int n_processes_here(MPI_Comm communicator);

  /// What the command line adds to the parameters.
  struct RunOptions
  {
    std::string command;  ///< that repeats the run in a shell, for the run record
    std::string revision; ///< of the program's sources
    std::string output;   ///< result folder
    bool        dry_run = false;

    std::vector<std::string> again;   ///< words of the command line that give another process these parameters
    std::string              designs; ///< numbers of designs that are wanted, as in "3, 7-9"; empty: all
  };

  /// The context of a run: its question, its processes, and where it says how it goes.
  struct RunContext
  {
    const Parameters &parameters;
    const MPI_Comm    communicator;
    Progress         &progress;
    std::ostream     &screen; ///< where tables go; a null stream buffer on all processes but one
    const bool        is_dry, is_root;
    const RunOptions  options;
  };

  /// The results of a run: its tables and fields in a folder, and its record.
  class RunResults
  {
  public:
    /// Folder of the results; a dry run has none.
    const ResultFolder &folder() const
    {
      return *place;
    }

    void count(const std::string &name, const long value)
    {
      record.counts.emplace_back(name, value);
    }
    void measure(const std::string &name, const double value)
    {
      record.quantities.emplace_back(name, value);
    }

    /// Writes NAME.csv.
    void store_table(const std::string &name, const Table &table);

  protected:
    RunRecord                     record = {};
    std::unique_ptr<ResultFolder> place;
    std::vector<std::string>      tables; ///< files, in the order in which they were written
  };

  /// What every study has at hand.
  class Run : public RunContext, public RunResults
  {
  public:
    /// Throws FileError if the result folder cannot be made; a dry run makes none.
    Run(const Parameters &parameters, const RunOptions &options, MPI_Comm communicator, Progress &progress, std::ostream &screen);

    /// Part of @p whole that computes with other parameters, reports to a channel of its own, and writes nothing.
    Run(const Parameters &parameters, const RunContext &whole, Progress &progress);

    /// Keeps a copy of a geometry of the user's own, so that the results repeat themselves.
    void keep_geometry();

    /// Prints a doubt about the input and keeps it for the run record.
    void warn(const std::string &text);

    /// Writes NAME.csv and shows the table.
    void write_table(const std::string &name, const Table &table);

    /// Writes the parameters as used and the run record, and gives the folder its name; @p afterwards removes what only an unfinished run
    /// needs.
    void finish(const std::function<void()> &afterwards = {});
  };

  /// Meshes the scene and answers the question of the run; a dry run only meshes.
  void run_study(Run &run);
} // namespace Squeal
