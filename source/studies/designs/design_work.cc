// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/memory.h>
#include <squeal/base/version.h>
#include <squeal/base/worker_process.h>
#include <squeal/geometry/scene_size.h>
#include <squeal/studies/designs/design_work.h>

#include <deal.II/base/mpi.h>

#include <fstream>
#include <ostream>

namespace Squeal
{
  extern const Study sweep_study;

  namespace fs  = std::filesystem;
  namespace MPI = dealii::Utilities::MPI;

  namespace
  {
    /// Relative margin of the reference modes above the band, for the counterparts of modes of softer designs [-].
    constexpr double reference_margin = 0.2;

    /// Typical number of basis vectors of a family of designs.
    constexpr double usual_family_basis = 500.;

    /// Values of the variables of a design, with the values of the given model for variables that the design does not set.
    std::vector<std::string> shown_values(const Parameters &parameters, const DesignPlan &plan, const std::vector<std::string> &values)
    {
      std::vector<std::string> result = values;
      for (std::size_t v = 0; v < values.size(); ++v)
        if (values[v].empty())
          result[v] = current_value(parameters, plan.names[v]);
      return result;
    }

    /// Number of designs that each MPI process solves concurrently, limited by cores and memory.
    unsigned int n_side_by_side(const Scene &scene, const Run &run, const bool has_families)
    {
      if (run.parameters.designs.n_processes > 0)
        return run.parameters.designs.n_processes;
      const unsigned int n_here = n_processes_here(run.communicator);
      const unsigned int degree = degree_of(run.parameters.discretization.element);
      // The basis of a family is stored twice while it is extended
      const double bytes_of_basis = has_families ? 2. * sizeof(double) * usual_family_basis * scene.model->free_map().n() : 0.;
      const double bytes          = bytes_of_basis + expected_size(scene.mesh, degree).memory(run.parameters.solvers.maximum_modes);
      const double by_cores       = std::min<double>(n_usable_cores(), static_cast<double>(std::thread::hardware_concurrency()) / n_here);
      const double by_memory      = available_memory() / bytes / n_here;
      return static_cast<unsigned int>(std::max(1., std::floor(std::min(by_cores, by_memory))));
    }

    /// Minimum number of designs in a family: for fewer designs, a common basis costs more than it saves.
    constexpr std::size_t least_family = 4;

    /// Maximum number of designs that a process solves in turn; constant, because results must not depend on the number of processes.
    constexpr std::size_t largest_batch = 25;

    /// Assigns designs to worker processes: designs on a common mesh in batches of nearly equal size, other designs individually. Rejected
    /// designs need no process.
    std::vector<std::vector<int>> batches_of(const Run &run, const DesignWork &work)
    {
      std::map<std::string, std::vector<int>> families;
      std::vector<std::vector<int>>           alone, result;
      for (const int design : work.designs)
        if (const auto parameters = parameters_of(run, work.plan, design))
          {
            const std::string key = family_key(sweep_of(*parameters));
            if (key.empty())
              alone.push_back({design});
            else
              families[key].push_back(design);
          }

      for (const auto &[key, designs] : families)
        if (designs.size() < least_family)
          for (const int design : designs)
            alone.push_back({design});
        else
          {
            const std::size_t n = (designs.size() + largest_batch - 1) / largest_batch;
            for (std::size_t i = 0; i < n; ++i)
              result.emplace_back(designs.begin() + static_cast<std::ptrdiff_t>(designs.size() * i / n),
                                  designs.begin() + static_cast<std::ptrdiff_t>(designs.size() * (i + 1) / n));
          }
      std::sort(result.begin(), result.end());
      std::sort(alone.begin(), alone.end());
      result.insert(result.end(), alone.begin(), alone.end());
      return result;
    }
  } // namespace

  std::string study_key(const Run &run, const std::string &model)
  {
    Parameters parameters          = run.parameters;
    parameters.designs.n_processes = 0;
    parameters.solvers.n_threads   = SolverParameters().n_threads;
    parameters.output              = {};
    std::ostringstream stream;
    stream << "# squeal " << version << '\n';
    parameters.print(stream, false);
    stream << "# " << model << '\n';
    return stream.str();
  }

  std::string model_key(const Scene &scene)
  {
    std::ostringstream stream;
    stream << "mesh: " << cell_counts(scene.mesh) << ", nodes " << std::hex << checksum(scene.mesh);
    return stream.str();
  }

  std::string design_key(const Run &run, const Scene &scene, const DesignPlan &plan)
  {
    std::ostringstream stream;
    stream << study_key(run, model_key(scene));
    for (const auto &values : plan.designs)
      {
        for (const std::string &value : values)
          stream << value << ", ";
        stream << '\n';
      }
    return stream.str();
  }

  DesignResult unfinished(const Run &run, const DesignPlan &plan, const int design)
  {
    DesignResult result;
    result.number = design;
    result.values = shown_values(run.parameters, plan, plan.designs[design - 1]);
    return result;
  }

  std::string in_one_line(const Error &error)
  {
    return error.reason + "; where: " + error.where + "; change: " + error.change;
  }

  std::optional<Parameters> parameters_of(const Run &run, const DesignPlan &plan, const int design, std::string *reason)
  {
    try
      {
        Parameters result = with_design(run.parameters, plan.names, plan.designs[design - 1], plan.where_is(design - 1));
        result.study      = &sweep_study;
        result.check();
        return result;
      }
    catch (const ParameterError &error)
      {
        if (reason)
          *reason = in_one_line(error);
        return {};
      }
  }

  ReferenceModes design_reference(Scene &scene, Run &run, const fs::path &file)
  {
    if (auto known = Checkpoint(file.parent_path()).find<ReferenceModes>(file.filename()))
      return *std::move(known);
    run.progress.begin("Reference modes");
    Progress   silent;
    Parameters parameters             = sweep_of(run.parameters);          // designs have no maps
    parameters.solvers.complex_solver = ComplexSolver::residual_iteration; // this solver needs no attachment modes in advance
    Run                     part(parameters, run, silent);
    const FrictionlessModes modes  = frictionless_modes(linearised_scene(scene, part), part, reference_margin);
    ReferenceModes          result = reference_modes(modes, run.parameters.materials);
    run.progress.finish(text(counted(result.names.size(), "mode"), " of the given model, to label the modes of designs"));
    return result;
  }

  std::vector<DesignResult> solve_all(Scene                          &scene,
                                      Run                            &run,
                                      const DesignWork               &work,
                                      const DesignStore              &store,
                                      const std::vector<std::string> &arguments)
  {
    const fs::path file = store.folder / DesignStore::reference_file;
    if (!MPI::broadcast(run.communicator, run.is_root && fs::exists(file), 0))
      {
        const ReferenceModes modes = design_reference(scene, run, file);
        if (run.is_root)
          store.Checkpoint::keep(DesignStore::reference_file, modes);
      }
    run.progress.begin("Designs");
    const std::size_t                   n_known = store.n_known(work.designs);
    const std::vector<std::vector<int>> batches = batches_of(run, work);
    MPI_Barrier(run.communicator);
    const int n_ranks = static_cast<int>(MPI::n_mpi_processes(run.communicator)),
              me      = static_cast<int>(MPI::this_mpi_process(run.communicator));
    std::vector<std::vector<int>> mine;
    std::size_t                   n_mine = 0;
    for (std::size_t i = 0; i < batches.size(); ++i)
      if (static_cast<int>(i) % n_ranks == me)
        {
          mine.push_back(batches[i]);
          n_mine += std::count_if(batches[i].begin(), batches[i].end(), [&](const int design) { return !store.find(design); });
        }
    std::vector<DesignResult> refused; // designs with rejected parameters
    if (run.is_root)
      for (const int design : work.designs)
        if (DesignResult result = unfinished(run, work.plan, design);
            !store.find(design) && !parameters_of(run, work.plan, design, &result.reason))
          {
            result.outcome = DesignOutcome::refused;
            refused.push_back(result);
          }
    n_mine += refused.size();

    const bool has_families   = std::any_of(batches.begin(), batches.end(), [](const std::vector<int> &batch) { return batch.size() > 1; });
    const unsigned int n_here = n_side_by_side(scene, run, has_families);
    std::size_t        n_done = 0;
    const Stopwatch    stopwatch;
    const auto         report = [&](const DesignResult &result) {
      ++n_done;
      const std::size_t n_left  = n_mine - n_done;
      const double      seconds = stopwatch.cost().seconds / static_cast<double>(n_done) * static_cast<double>(n_left);
      run.progress.note(text("    design ", result.number, ": ", outcome_of(result), "; ", std::round(result.seconds), " s",
                             n_left > 0 ? text(", ", n_left, " left, about ", std::ceil(seconds / 60.), " min") : ""));
      run.progress.update(text(n_known + n_done, " of ", n_known + n_mine, " designs"));
    };
    for (const DesignResult &design : refused)
      {
        store.keep(design);
        report(design);
      }
    solve_side_by_side(
      mine, n_here, store, [&](const int design) { return unfinished(run, work.plan, design); }, report, arguments);
    MPI_Barrier(run.communicator);
    std::vector<DesignResult> results;
    for (const int design : work.designs)
      if (auto result = store.find(design))
        results.push_back(*std::move(result));
    run.progress.finish(text(counted(results.size(), "design"), ", ", n_here * n_ranks, " concurrently"));
    return results;
  }

  void write_designs(const std::vector<std::string> &names, const std::vector<DesignResult> &results, Run &run)
  {
    run.count("designs", results.size());
    run.screen << '\n';
    for (const std::string &line : verdict(names, results))
      run.progress.note(line);
    run.screen << "\n  quietest designs (all designs: designs.csv)\n\n";
    quietest_designs(names, results).print(run.screen);
    run.screen << '\n';
    run.store_table("designs", design_table(names, results));
    run.store_table("design_thresholds", design_threshold_table(results));
    run.store_table("design_modes", design_mode_table(results));
  }

  void write_parameter_file(Parameters design, const std::string &name, const Run &run)
  {
    const GeometryCopy copy = copy_of(design.geometry.path());
    // Refer to a copied geometry by its path relative to the parameter file
    const bool is_below  = name.find('/') != std::string::npos;
    design.geometry.file = (is_below && !copy.files.empty() ? "../" : "") + copy.name;
    design.designs       = {};
    design.search        = {};
    run.folder().write(name, [&](std::ostream &stream) { design.print(stream, false); });
  }

  Study study_of_designs(const char *name, void (*run)(Scene &, Run &), std::vector<UsageRule> own_rules)
  {
    Study study{name, run, {"Designs/", "Sweep/"}};
    study.rules = std::move(own_rules);
    study.rules.push_back(
      {"Operation/Friction coefficient", [](const Parameters &) { return "designs use the friction coefficients of Sweep"; }});
    study.rules.push_back({"Operation/Rotation speed", no_sliding_speed});
    study.rules.push_back({"Complex modes/", [](const Parameters &) { return "designs are solved with reduced models"; }});
    for (const char *path : {"Sweep/Parameter", "Sweep/Second parameter", "Sweep/Compare dissipation", "Sweep/Mode shapes at",
                             "Sweep/Complex plane at", "Sweep/Count modes at", "Sweep/Map parameter", "Sweep/First map value",
                             "Sweep/Last map value", "Sweep/Number of map values", "Sweep/Map friction coefficients"})
      study.rules.push_back({path, [](const Parameters &) { return "not evaluated for designs; use Study = sweep"; }});
    study.rules.push_back({"Output/", [](const Parameters &) { return "only for runs with the parameter file of a design"; }});
    return study;
  }
} // namespace Squeal
