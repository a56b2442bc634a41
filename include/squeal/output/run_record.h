#pragma once

#include <squeal/base/progress.h>

#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

namespace Squeal
{
  /// What a run was: enough to repeat it and to compare its cost.
  struct RunRecord
  {
    std::string                                  command;     ///< as typed
    int                                          n_processes; ///< of MPI
    int                                          blas_threads;
    std::vector<std::pair<std::string, long>>    counts;      ///< elements, dofs, contact nodes, modes, ...
    std::vector<std::pair<std::string, double>>  quantities;  ///< worst element quality, ...
    std::vector<std::string>                     warnings;    ///< doubts about the input
  };

  /// Versions, revision, machine, counts, time and peak memory of each step, and the margins of decisions, as JSON.
  void write_run_record(std::ostream &stream, const RunRecord &record, const Progress &progress);
} // namespace Squeal
