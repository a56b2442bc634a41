// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <boost/process/child.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// Cores that this process may use, as the system and whoever started it leave them.
  unsigned int n_usable_cores();

  /// This program once more, in a process of its own: whatever happens to it leaves this one alone. It knows nothing of the MPI job that
  /// this process belongs to, and is told to end (SIGTERM) when this process ends in whatever way.
  class WorkerProcess
  {
  public:
    /**
     * Starts it.
     *
     * @param arguments behind the name of the program
     * @param log       file that takes what it prints
     * @param n_threads where the user has not chosen their number by OMP_NUM_THREADS: more threads than cores wait for each other
     *
     * Throws FileError if it cannot be started.
     */
    WorkerProcess(const std::vector<std::string> &arguments, const std::filesystem::path &log, unsigned int n_threads);

    /// Tells it to end, and waits until it has.
    ~WorkerProcess();

    WorkerProcess(const WorkerProcess &)            = delete;
    WorkerProcess &operator=(const WorkerProcess &) = delete;

    /// How it ended: "" for success, "exit status 1", "killed by SIGSEGV"; nothing while it runs.
    std::optional<std::string> end();

  private:
    boost::process::child worker;
  };
} // namespace Squeal
