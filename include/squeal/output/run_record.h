#pragma once

#include <squeal/base/progress.h>

#include <cstdint>
#include <filesystem>
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

  /// Versions, revision, machine, counts, time and peak memory of each step, and files, as JSON.
  void write_run_record(std::ostream &stream, const RunRecord &record, const Progress &progress);

  /// The files that a record lists; nothing if it lists none or cannot be read.
  std::optional<FileSizes> read_file_list(const std::filesystem::path &record);
} // namespace Squeal
