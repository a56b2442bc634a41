// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/tasks.h>
#include <squeal/linear_algebra/blas_threads.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/parameters/csv_file.h>
#include <squeal/parameters/design_plan.h>
#include <squeal/studies/steps/run.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <ostream>

namespace Squeal
{
  unsigned int n_processes_here(const MPI_Comm communicator)
  {
    MPI_Comm machine;
    int      result = 1;
    MPI_Comm_split_type(communicator, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    MPI_Comm_size(machine, &result);
    MPI_Comm_free(&machine);
    return result;
  }

  Run::Run(const Parameters &parameters, const RunOptions &options, MPI_Comm communicator, Progress &progress, std::ostream &screen)
    : RunContext{parameters, communicator, progress, screen, options.dry_run, this_process(communicator) == 0, options}
  {
    record.command      = options.command;
    record.revision     = options.revision;
    record.n_processes  = n_processes(communicator);
    record.n_threads    = usable_threads(parameters.solvers.n_threads, n_processes_here(communicator));
    record.blas_threads = set_blas_threads(parameters.solvers.blas_threads);
    set_task_threads(record.n_threads);
    if (!is_dry)
      place = std::make_unique<ResultFolder>(options.output, is_root);
  }

  Run::Run(const Parameters &parameters, const RunContext &whole, Progress &progress)
    : RunContext{parameters, whole.communicator, progress, whole.screen, true, whole.is_root, whole.options}
  {}

  void Run::keep_geometry()
  {
    for (const GeometryCopy::File &file : copy_of(parameters.geometry.path()).files)
      place->write(file.to, [&](std::ostream &stream) { stream << std::ifstream(file.from, std::ios::binary).rdbuf(); });
  }

  void Run::warn(const std::string &text)
  {
    progress.note("    warning: " + text);
    record.warnings.push_back(text);
  }

  void RunResults::store_table(const std::string &name, const Table &table)
  {
    place->write(name + ".csv", [&](std::ostream &stream) { table.write_csv(stream); });
    tables.push_back(name + ".csv");
  }

  void Run::write_table(const std::string &name, const Table &table)
  {
    screen << "\n  " << name << ".csv\n\n";
    table.print(screen);
    store_table(name, table);
  }

  void Run::finish(const std::function<void()> &afterwards)
  {
    Parameters repeated = parameters;
    if (parameters.system)
      repeated.system.file = std::filesystem::absolute(parameters.system.path()).string();
    else
      repeated.geometry.file = copy_of(parameters.geometry.path()).name;
    if (parameters.discretization.coarser_mesh_is_file())
      repeated.discretization.coarser_mesh = with_coarser_mesh(parameters).geometry.path();
    if (const std::string designs = designs_file(parameters); !designs.empty())
      {
        repeated.designs.file = "designs/given.csv";
        place->write(repeated.designs.file, [&](std::ostream &stream) { stream << std::ifstream(designs, std::ios::binary).rdbuf(); });
      }
    if (parameters.study->has("Updating/Measured modes"))
      for (const auto &[file, copy] : {std::make_pair(&UpdatingParameters::measured_modes, "measured_modes.csv"),
                                       std::make_pair(&UpdatingParameters::sensors, "sensors.csv")})
        if (std::string &name = repeated.updating.*file; !name.empty())
          {
            const std::ifstream content(input_path(name, parameters.geometry.directory), std::ios::binary);
            place->write(copy, [&](std::ostream &stream) { stream << content.rdbuf(); });
            name = copy;
          }
    place->write("parameters.prm", [&](std::ostream &stream) { repeated.print(stream, false); });
    record.files = place->files();
    place->write(ResultFolder::run_record, [&](std::ostream &stream) { write_run_record(stream, record, progress); });
    for (const std::string &remark : place->commit(afterwards))
      progress.note("  note: " + remark);
    std::string names;
    for (const std::string &name : tables)
      names += (names.empty() ? "" : ", ") + name;
    progress.note("  tables: " + names);
    progress.note(text("  results in ", place->name(), ", ", std::round(10. * progress.elapsed()) / 10., " s"));
  }
} // namespace Squeal
