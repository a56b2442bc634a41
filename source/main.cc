#include <squeal/base/exceptions.h>
#include <squeal/base/version.h>
#include <squeal/linear_algebra/blas_kernels.h>
#include <squeal/parameters/parameters.h>
#include <squeal/studies/dissipation_study.h>
#include <squeal/studies/parameter_usage.h>
#include <squeal/studies/reduction_study.h>
#include <squeal/studies/stability_study.h>
#include <squeal/studies/sweep_study.h>

#include <deal.II/base/mpi.h>

#include <getopt.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <optional>
#include <thread>

namespace
{
  constexpr const char *usage = R"(squeal PRM [options]

Decides whether a disc rubbed by friction pins squeals.

  PRM                        parameter file
  --set "Section/Name=value" overrides a parameter; may be repeated
  --output DIR               result folder (default: results/<name of PRM>)
  --dry-run                  reads, checks, meshes, prints counts, and stops
  --print-parameters         prints every parameter with its value and meaning
  --version                  prints the version
  --help                     prints this text
)";

  struct CommandLine
  {
    std::string                parameter_file;
    std::vector<std::string>   overrides;
    std::optional<std::string> output;
    bool                       dry_run = false, print_parameters = false, version = false, help = false;
  };

  CommandLine parse(const int argc, char **argv)
  {
    const option options[] = {{"set", required_argument, nullptr, 's'},
                              {"output", required_argument, nullptr, 'o'},
                              {"dry-run", no_argument, nullptr, 'd'},
                              {"print-parameters", no_argument, nullptr, 'p'},
                              {"version", no_argument, nullptr, 'v'},
                              {"help", no_argument, nullptr, 'h'},
                              {nullptr, 0, nullptr, 0}};
    CommandLine  line;
    opterr = 0;
    for (int choice; (choice = getopt_long(argc, argv, ":", options, nullptr)) != -1;)
      switch (choice)
        {
          case 's':
            line.overrides.emplace_back(optarg);
            break;
          case 'o':
            line.output = optarg;
            break;
          case 'd':
            line.dry_run = true;
            break;
          case 'p':
            line.print_parameters = true;
            break;
          case 'v':
            line.version = true;
            break;
          case 'h':
            line.help = true;
            break;
          default:
            throw Squeal::ParameterError(choice == ':' ? "an option lacks its value" : "unknown option",
                                         std::string("command line, `") + argv[optind - 1] + "`", "squeal --help lists the options");
        }
    if (optind < argc)
      line.parameter_file = argv[optind++];
    if (optind < argc)
      throw Squeal::ParameterError("more than one parameter file", std::string("command line, `") + argv[optind] + "`",
                                   "give one; scripts/run.sh runs several in turn");
    return line;
  }

  void run(const CommandLine &line, const std::string &command, std::ostream &screen, Squeal::Progress &progress)
  {
    using namespace Squeal;
    if (line.help)
      {
        screen << usage;
        return;
      }
    if (line.version)
      {
        screen << "squeal " << version << " (" << revision << ")\n";
        return;
      }
    if (line.print_parameters)
      {
        const Parameters parameters =
          line.parameter_file.empty() ? Parameters() : Parameters::read(line.parameter_file, line.overrides);
        parameters.print(screen, true);
        return;
      }
    if (line.parameter_file.empty())
      throw ParameterError("no parameter file is given", "command line", "squeal prm/disc_pins.prm; squeal --help lists the options");

    const Parameters parameters = Parameters::read(line.parameter_file, line.overrides);
    RunOptions       options;
    options.command = command;
    options.output  = line.output.value_or("results/" + std::filesystem::path(line.parameter_file).stem().string());
    options.dry_run = line.dry_run;
    progress.note("squeal " + std::string(version) + ", " + line.parameter_file);
    Run run(parameters, options, MPI_COMM_WORLD, progress, screen);
    if (const std::string note = unused_parameters_note(parameters); !note.empty())
      progress.note(note);
    switch (parameters.study)
      {
        case Study::stability:
          run_stability_study(run);
          break;
        case Study::dissipation:
          run_dissipation_study(run);
          break;
        case Study::reduction:
          run_reduction_study(run);
          break;
        case Study::sweep:
          run_sweep_study(run);
          break;
      }
  }
  /// Prints the one message of a failed run; returns the exit status.
  int report(const std::string &message, const bool is_root)
  {
    int n_processes;
    MPI_Comm_size(MPI_COMM_WORLD, &n_processes);
    // Most errors are met by all processes alike, and one of them speaks. The others wait before they take the
    // rest down with them, in case they failed alone.
    if (!is_root)
      std::this_thread::sleep_for(std::chrono::seconds(3));
    std::cerr << std::flush << "\nerror: " << message << std::endl;
    if (n_processes > 1)
      MPI_Abort(MPI_COMM_WORLD, 1);
    return 1;
  }
} // namespace

int main(int argc, char **argv)
{
  Squeal::use_native_blas_kernels(argv);

  std::string command;
  for (int i = 0; i < argc; ++i)
    command += (i > 0 ? " " : "") + std::string(argv[i]);

  // deal.II must not start threads of its own beside the processes.
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const bool                               is_root = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  std::ostream                             silence(nullptr);
  std::ostream                            &screen = is_root ? std::cout : silence;
  // mpirun shows every process a terminal, whether there is one behind it or not.
  const bool       live = isatty(STDOUT_FILENO) != 0 && dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1;
  Squeal::Progress progress(screen, live && is_root);
  try
    {
      run(parse(argc, argv), command, screen, progress);
      return 0;
    }
  catch (const std::exception &error)
    {
      return report(error.what(), is_root);
    }
  catch (const int code)
    {
      // Epetra throws its error codes.
      return report("Trilinos failed with code " + std::to_string(code) +
                      "\n  where:  distributed vectors and matrices\n  change: this is a defect of the program; please report it",
                    is_root);
    }
}
