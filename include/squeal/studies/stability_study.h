#pragma once

#include <squeal/base/progress.h>
#include <squeal/output/result_folder.h>
#include <squeal/parameters/parameters.h>

#include <mpi.h>

#include <iosfwd>
#include <string>

namespace Squeal
{
  /// What the command line adds to the parameters.
  struct RunOptions
  {
    std::string command; ///< as typed, for the run record
    std::string output;  ///< result folder
    bool        dry_run = false;
  };

  /**
   * `Study = stability`: component modes, real coupled modes and complex modes
   * at one friction coefficient, with their tables and mode shapes. With
   * dry_run the mesh is made, checked and counted, and nothing is written.
   *
   * @param screen where tables go; a null stream buffer on all processes but one
   */
  void run_stability_study(const Parameters &parameters, const RunOptions &options, MPI_Comm communicator, Progress &progress, std::ostream &screen);
} // namespace Squeal
