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
  /// Number of MPI processes on this machine.
  unsigned int n_processes_here(MPI_Comm communicator);

  /// Command-line settings in addition to the parameters.
  struct RunOptions
  {
    std::string command;  ///< shell command that repeats the run, for the run record
    std::string revision; ///< revision of the program's sources
    std::string output;   ///< result folder
    bool        dry_run = false;

    std::vector<std::string> again;   ///< command-line arguments that give a worker process the same parameters
    std::string              designs; ///< numbers of the requested designs, as in "3, 7-9"; empty: all
  };

  /// Context of a run: parameters, processes and progress output.
  struct RunContext
  {
    const Parameters &parameters;
    const MPI_Comm    communicator;
    Progress         &progress;
    std::ostream     &screen; ///< stream for tables; its buffer is null on all processes except one
    const bool        is_dry, is_root;
    const RunOptions  options;
  };

  /// Results of a run: tables and fields in a folder, and the run record.
  class RunResults
  {
  public:
    /// Result folder; a dry run has none.
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
    std::vector<std::string>      tables; ///< files in the order of writing
  };

  /// Context and results of a run, for all studies.
  class Run : public RunContext, public RunResults
  {
  public:
    /// Throws FileError if the result folder cannot be created; a dry run creates none.
    Run(const Parameters &parameters, const RunOptions &options, MPI_Comm communicator, Progress &progress, std::ostream &screen);

    /// A part of @p whole with other parameters and its own progress output, without output files.
    Run(const Parameters &parameters, const RunContext &whole, Progress &progress);

    /// Copies the user's geometry to the results, so that they are reproducible.
    void keep_geometry();

    /// Prints a warning about the input and adds it to the run record.
    void warn(const std::string &text);

    /// Writes NAME.csv and prints the table.
    void write_table(const std::string &name, const Table &table);

    /// Writes the parameters and the run record, and completes the result folder. @p afterwards may then remove temporary data.
    void finish(const std::function<void()> &afterwards = {});
  };

  /// Meshes the model or reads the system file, and runs the study; a dry run stops before the study.
  void run_study(Run &run);
} // namespace Squeal
