#include <squeal/base/exceptions.h>
#include <squeal/base/worker_process.h>

#include <fcntl.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

extern char **environ;

namespace Squeal
{
  namespace
  {
    constexpr const char *program = "/proc/self/exe";

    [[noreturn]] void cannot_start(const int error, const std::string &where)
    {
      throw FileError(std::string("a process cannot be started: ") + std::strerror(error), where,
                      "check permissions, free space, and limits on processes and memory");
    }

    /// Variable with which users choose the number of threads, of this program and of libraries.
    constexpr const char *threads_variable = "OMP_NUM_THREADS";

    /**
     * The environment without what tells a process of the MPI job that it belongs to: the other one is none of them. @p threads is the
     * variable that limits threads where the user does not.
     */
    std::vector<char *> environment_of_worker(std::string &threads)
    {
      std::vector<char *> result;
      for (char **variable = environ; *variable != nullptr; ++variable)
        {
          const std::string_view text(*variable);
          if (text.rfind("OMPI_", 0) != 0 && text.rfind("PMIX_", 0) != 0 && text.rfind("PMI_", 0) != 0)
            result.push_back(*variable);
        }
      if (std::getenv(threads_variable) == nullptr)
        result.push_back(threads.data());
      result.push_back(nullptr);
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
    // The copy of this process may do little before it becomes another program: all it needs is made ready here
    std::vector<char *> words = {const_cast<char *>("squeal")};
    for (const std::string &argument : arguments)
      words.push_back(const_cast<char *>(argument.c_str()));
    words.push_back(nullptr);
    std::string               threads     = std::string(threads_variable) + "=" + std::to_string(n_threads);
    const std::vector<char *> environment = environment_of_worker(threads);
    const int                 printed     = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    const int                 no_input    = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (printed < 0 || no_input < 0)
      cannot_start(errno, "file " + log.string());
    const pid_t parent = ::getpid();

    process = ::fork();
    if (process == 0)
      {
        ::prctl(PR_SET_PDEATHSIG, SIGTERM);
        if (::getppid() != parent) // it ended meanwhile
          ::_exit(1);
        ::dup2(no_input, STDIN_FILENO);
        ::dup2(printed, STDOUT_FILENO);
        ::dup2(printed, STDERR_FILENO);
        ::execve(program, words.data(), environment.data());
        ::_exit(127);
      }
    const int error = errno;
    ::close(printed);
    ::close(no_input);
    if (process < 0)
      cannot_start(error, "file " + std::string(program));
  }

  WorkerProcess::~WorkerProcess()
  {
    if (how_it_ended)
      return;
    ::kill(process, SIGTERM);
    int status = 0;
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR)
      {}
  }

  std::optional<std::string> WorkerProcess::end()
  {
    int status = 0;
    if (!how_it_ended && ::waitpid(process, &status, WNOHANG) == process)
      how_it_ended = described(status);
    return how_it_ended;
  }
} // namespace Squeal
