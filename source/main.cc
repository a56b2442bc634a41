// SPDX-License-Identifier: GPL-3.0-or-later

#include "revision.h"

#include <squeal/base/command_line.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/mpi_environment.h>
#include <squeal/base/memory.h>
#include <squeal/base/text.h>
#include <squeal/base/version.h>
#include <squeal/output/result_folder.h>
#include <squeal/parameters/parameters.h>
#include <squeal/studies/steps/parameter_usage.h>
#include <squeal/studies/steps/run.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>

#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <new>
#include <sstream>
#include <system_error>
#include <thread>

namespace
{
  constexpr const char *usage = R"(squeal PRM [options]

Predicts whether a disc brake tends to squeal.

  PRM                        parameter file
  --set "Section/Name=value" overrides a parameter; may be repeated
  --output DIR               result folder (default: results/<name of PRM>)
  --designs LIST             solves only these designs of Study = geometry, for example 3,7-9
  --dry-run                  checks the input, generates the mesh, prints counts and stops
  --print-parameters         prints every parameter with its value and meaning
  --version                  prints the version, the licence and the libraries
  -h, --help                 prints this text
)";

  void run(const Squeal::CommandLine &line, const std::string &command, std::ostream &screen, Squeal::Progress &progress)
  {
    using namespace Squeal;
    if (line.help)
      {
        screen << usage;
        return;
      }
    if (line.version)
      {
        screen << "squeal " << version << " (" << revision << "), GPL-3.0-or-later, without any warranty\n";
        for (const auto &[library, its_version] : library_versions())
          screen << library << " " << its_version << "\n";
        return;
      }
    if (line.print_parameters)
      {
        const Parameters parameters = line.parameter_file.empty() ? Parameters() : Parameters::read(line.parameter_file, line.overrides);
        parameters.print(screen, true);
        return;
      }
    if (line.parameter_file.empty())
      throw ParameterError("no parameter file is given", "command line",
                           "name one, for example squeal prm/disc_pins.prm; squeal --help lists the options");

    const Parameters parameters = Parameters::read(line.parameter_file, line.overrides);
    RunOptions       options;
    options.command  = command;
    options.revision = revision;
    options.output   = line.output.value_or("results/" + std::filesystem::path(line.parameter_file).stem().string());
    options.dry_run  = line.dry_run;
    options.again    = {
         (std::filesystem::path(".") / line.parameter_file).string()}; // prevents names that begin with `-` from being taken for options
    for (const std::string &text : line.overrides)
      options.again.push_back("--set=" + text);
    options.designs = line.designs;
    progress.note("squeal " + std::string(version) + ", " + line.parameter_file);
    Run run(parameters, options, MPI_COMM_WORLD, progress, screen);
    if (const std::string note = unused_parameters_note(parameters); !note.empty())
      progress.note(note);
    run_study(run);
  }

  /// Redirects closed standard streams to /dev/null. Otherwise, files and pipes opened later would reuse their descriptors and receive the
  /// printed output.
  void open_closed_streams()
  {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
      if (::fcntl(stream, F_GETFD) < 0 && ::open("/dev/null", O_RDWR) != stream) // open() returns the lowest free descriptor
        return;
  }

  /// Message of a failed run, from the exception that is being handled.
  std::string failure_message()
  {
    constexpr const char *defect = "\n  change: this is a defect of the program; please report it";
    try
      {
        throw;
      }
    catch (const Squeal::Error &error)
      {
        return error.what();
      }
    catch (const dealii::ExceptionBase &error)
      {
        std::ostringstream cause;
        error.print_info(cause);
        return "deal.II failed: " + cause.str() + "\n  where:  a library" + defect;
      }
    catch (const std::bad_alloc &)
      {
        return "the memory is exhausted\n  where:  this machine, or the limit of this process\n"
               "  change: use larger elements, fewer layers, a lower Band/Maximum frequency, or processes on more machines";
      }
    catch (const std::system_error &error)
      {
        return std::string("a system call failed: ") + error.what() +
               "\n  where:  a file, or the limits of this process on threads (ulimit -u) and memory (ulimit -v)\n"
               "  change: check permissions and free space of the file; or use fewer threads (OMP_NUM_THREADS=1 or Linear algebra/Threads "
               "= 1), or raise the limits";
      }
    catch (const std::exception &error)
      {
        return std::string(error.what()) + "\n  where:  a library" + defect;
      }
  }

  void print_error(const std::string &message)
  {
    std::cerr << std::flush << "\nerror: " << message << std::endl;
  }

  /// Prints the message of a failed run; returns the exit status.
  int report(const std::string &message, const bool is_root)
  {
    // Delay other processes, because most errors occur on all processes, and process 0 reports the error and aborts the job
    if (!is_root)
      std::this_thread::sleep_for(std::chrono::seconds(3));
    print_error(message);
    if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
      MPI_Abort(MPI_COMM_WORLD, 1);
    return 1;
  }
} // namespace

int main(int argc, char **argv)
{
  open_closed_streams();
  Squeal::return_freed_blocks();
  Squeal::prepare_mpi_environment();
  // Ignore SIGXFSZ so that write() fails with EFBIG
  std::signal(SIGXFSZ, SIG_IGN);

  // Check the current folder, because some libraries abort at startup if it does not exist
  std::error_code                              no_folder;
  [[maybe_unused]] const std::filesystem::path here = std::filesystem::current_path(no_folder);
  if (no_folder)
    {
      print_error(
        Squeal::FileError("the current folder cannot be found: " + no_folder.message(), "current folder", "change to an existing folder")
          .what());
      return 1;
    }

  // Hide the arguments from libraries, which would parse them, and disable the signal handlers of PETSc
  char   without_handler[]   = "-no_signal_handler";
  char  *library_arguments[] = {argv[0], without_handler, nullptr};
  char **library_argv        = library_arguments;
  int    library_argc        = 2;
  // Prevent deal.II from starting threads in addition to the threads of the program
  dealii::Utilities::MPI::MPI_InitFinalize mpi(library_argc, library_argv, 1);
  const bool                               is_root = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  std::ostream                             silence(nullptr);
  std::ostream                            &screen = is_root ? std::cout : silence;
  // Under mpirun, isatty() may be true without a terminal
  const bool        live    = isatty(STDOUT_FILENO) != 0 && dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1;
  const std::string command = Squeal::shell_command({argv, argv + argc});
  try
    {
      Squeal::Progress progress(screen, live && is_root);
      run(Squeal::parse_command_line({argv + 1, argv + argc}), command, screen, progress);
      if (is_root && !screen.flush())
        throw Squeal::FileError("the output could not be printed completely", "standard output",
                                "check the target of the redirection and its free space");
      return 0;
    }
  catch (...)
    {
      return report(failure_message(), is_root);
    }
}
