// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/process.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// Number of cores that this process may use according to its affinity.
  unsigned int n_usable_cores();

  /// Runs this program in a separate process, so that a failure does not affect the calling process. The new process does not join the
  /// caller's MPI job and receives SIGTERM when the caller ends for any reason.
  class WorkerProcess
  {
  public:
    /**
     * Starts the process.
     *
     * @param arguments command-line arguments without the name of the program
     * @param log       file for its output
     * @param n_threads value of OMP_NUM_THREADS unless the user has set this variable
     *
     * Throws FileError if the process cannot be started.
     */
    WorkerProcess(const std::vector<std::string> &arguments, const std::filesystem::path &log, unsigned int n_threads);

    /// Sends SIGTERM and waits for the end of the process.
    ~WorkerProcess();

    WorkerProcess(const WorkerProcess &)            = delete;
    WorkerProcess &operator=(const WorkerProcess &) = delete;

    /// Result of the process: "" for success, "exit status 1", "killed by SIGSEGV"; no value while it runs.
    std::optional<std::string> end();

  private:
    process::child worker;
  };
} // namespace Squeal
