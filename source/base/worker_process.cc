// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/worker_process.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>

#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace Squeal
{
  namespace
  {
    /// Environment variable for the number of threads of this program and of libraries.
    constexpr const char *threads_variable = "OMP_NUM_THREADS";

    /// Environment without the variables of the MPI job, so that the worker does not join this job.
    process::environment environment_of_worker(const unsigned int n_threads)
    {
      process::environment result = boost::this_process::environment();
      for (const auto &variable : boost::this_process::environment())
        for (const char *of_job : {"OMPI_", "PMIX_", "PMI_"})
          if (variable.get_name().rfind(of_job, 0) == 0)
            result.erase(variable.get_name());
      if (result.count(threads_variable) == 0)
        result[threads_variable] = std::to_string(n_threads);
      return result;
    }

    std::string described(const int status)
    {
      if (WIFSIGNALED(status))
        return std::string("killed by SIG") + ::sigabbrev_np(WTERMSIG(status));
      return WEXITSTATUS(status) == 0 ? "" : "exit status " + std::to_string(WEXITSTATUS(status));
    }
  } // namespace

  unsigned int n_usable_cores()
  {
    cpu_set_t cores;
    CPU_ZERO(&cores);
    if (::sched_getaffinity(0, sizeof(cores), &cores) != 0)
      return std::max(1l, ::sysconf(_SC_NPROCESSORS_ONLN));
    return std::max(1, CPU_COUNT(&cores));
  }

  WorkerProcess::WorkerProcess(const std::vector<std::string> &arguments, const std::filesystem::path &log, const unsigned int n_threads)
  {
    const auto end_with_parent = [parent = ::getpid()](auto &) {
      ::prctl(PR_SET_PDEATHSIG, SIGTERM);
      if (::getppid() != parent) // the parent ended before the call of prctl()
        ::_exit(1);
    };
    try
      {
        worker = process::child("/proc/self/exe", process::args(arguments), environment_of_worker(n_threads),
                                (process::std_out & process::std_err) > log.string(), process::std_in < process::null,
                                process::extend::on_exec_setup(end_with_parent));
      }
    catch (const process::process_error &error)
      {
        throw FileError("a process cannot be started: " + error.code().message(), "file " + log.string(),
                        "check permissions, free disk space, and limits on processes and memory");
      }
  }

  WorkerProcess::~WorkerProcess()
  {
    if (!worker.running())
      return;
    ::kill(worker.id(), SIGTERM);
    worker.wait();
  }

  std::optional<std::string> WorkerProcess::end()
  {
    return worker.running() ? std::nullopt : std::optional(described(worker.native_exit_code()));
  }
} // namespace Squeal
