#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/file_writing.h>
#include <squeal/base/memory_limit.h>
#include <squeal/base/version.h>
#include <squeal/base/worker_process.h>
#include <squeal/geometry/problem_size.h>
#include <squeal/output/chart_checkpoint.h>
#include <squeal/parameters/design_plan.h>
#include <squeal/studies/design_queue.h>
#include <squeal/studies/design_solution.h>
#include <squeal/studies/parameter_usage.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <ostream>
#include <set>
#include <sstream>
#include <thread>

namespace Squeal
{
  extern const Study sweep_study;

  namespace
  {
    namespace fs  = std::filesystem;
    namespace MPI = dealii::Utilities::MPI;

    /// Modes of the scene are found so far beyond the band that those of stiffer and softer designs find their likes [-].
    constexpr double reference_margin = 0.2;

    /// The plan, with the numbers of the designs that this run is to solve.
    struct Work
    {
      DesignPlan       plan;
      std::vector<int> designs; ///< from one on

      const std::vector<std::string> &values(const int design) const
      {
        return plan.designs[design - 1];
      }
    };

    /// Numbers of a list such as "3, 7-9".
    std::vector<int> parse_designs(const std::string &list, const int n)
    {
      const auto refuse = [&](const std::string &what) {
        throw ParameterError(what, "command line, --designs " + legible(list),
                             text("give numbers from 1 to ", n, ", as in --designs 3,7-9"));
      };
      std::set<int> result;
      for (const std::string &part : dealii::Utilities::split_string_list(list, ','))
        {
          const auto          ends = dealii::Utilities::split_string_list(part, '-');
          std::vector<double> numbers;
          for (const std::string &end : ends)
            if (const auto number = parse_number(end); number && *number == std::floor(*number) && *number >= 1. && *number <= n)
              numbers.push_back(*number);
          if (numbers.size() != ends.size() || ends.empty() || ends.size() > 2 || numbers.front() > numbers.back())
            refuse(in_quotes(part) + " names no designs of this study");
          for (int design = static_cast<int>(numbers.front()); design <= static_cast<int>(numbers.back()); ++design)
            result.insert(design);
        }
      if (result.empty())
        refuse("the list names no design");
      return {result.begin(), result.end()};
    }

    Work work_of(const Run &run)
    {
      Work      work{design_plan(run.parameters), {}};
      const int n = static_cast<int>(work.plan.designs.size());
      if (!run.options.designs.empty())
        work.designs = parse_designs(run.options.designs, n);
      else
        for (int design = 1; design <= n; ++design)
          work.designs.push_back(design);
      return work;
    }

    /// Everything on which the results of the study depend.
    std::string key_of(const Run &run, const Scene &scene, const DesignPlan &plan)
    {
      Parameters parameters          = run.parameters;
      parameters.output              = {};
      parameters.designs.n_processes = 0;
      std::ostringstream stream;
      stream << "# squeal " << version << '\n';
      parameters.print(stream, false);
      stream << "# mesh: " << scene.mesh.hexahedra.size() << " hexahedra, nodes " << std::hex << checksum(scene.mesh) << '\n';
      for (const auto &values : plan.designs)
        {
          for (const std::string &value : values)
            stream << value << ", ";
          stream << '\n';
        }
      return stream.str();
    }

    /// Values of the variables in a design, as the scene has them where the design leaves them open.
    std::vector<std::string> shown_values(const Parameters &parameters, const DesignPlan &plan, const std::vector<std::string> &values)
    {
      std::vector<std::string> result = values;
      for (std::size_t v = 0; v < values.size(); ++v)
        if (values[v].empty())
          result[v] = current_value(parameters, plan.names[v]);
      return result;
    }

    DesignResult unfinished(const Run &run, const Work &work, const int design)
    {
      DesignResult result;
      result.number = design;
      result.values = shown_values(run.parameters, work.plan, work.values(design));
      return result;
    }

    std::string in_one_line(const Error &error)
    {
      return error.reason + "; where: " + error.where + "; change: " + error.change;
    }

    /// The parameters of a design, or why it is refused.
    std::optional<Parameters> parameters_of(const Run &run, const Work &work, const int design, std::string &reason)
    {
      try
        {
          Parameters result = with_design(run.parameters, work.plan.names, work.values(design));
          result.study      = &sweep_study;
          result.check();
          return result;
        }
      catch (const ParameterError &error)
        {
          reason = in_one_line(error);
          return {};
        }
    }

    /// Solves a design in this process.
    DesignResult solve_here(Run &run, const Work &work, const int design, const ReferenceModes &reference)
    {
      DesignResult    result = unfinished(run, work, design);
      const Stopwatch stopwatch;
      const auto      parameters = parameters_of(run, work, design, result.reason);
      if (!parameters)
        {
          result.outcome = DesignOutcome::refused;
          return result;
        }
      try
        {
          DesignResult solved = solve_design(*parameters, reference, checkpoint_folder(run.folder().name()), run);
          solved.number       = design;
          solved.values       = result.values;
          return solved;
        }
      catch (const FileError &)
        {
          throw; // nothing that the design is to blame for
        }
      catch (const MeshError &error)
        {
          result.outcome = DesignOutcome::refused;
          result.reason  = in_one_line(error);
        }
      catch (const ParameterError &error)
        {
          result.outcome = DesignOutcome::refused;
          result.reason  = in_one_line(error);
        }
      catch (const Error &error)
        {
          result.reason = in_one_line(error);
        }
      result.seconds = stopwatch.cost().seconds;
      return result;
    }

    /// The modes by which designs are named: kept where another process has found them, or those of the scene.
    ReferenceModes reference(Scene &scene, Run &run, const fs::path &file)
    {
      if (fs::exists(file))
        {
          std::ifstream           stream(file, std::ios::binary);
          const std::vector<char> packed{std::istreambuf_iterator<char>(stream), {}};
          return dealii::Utilities::unpack<ReferenceModes>(packed, false);
        }
      run.progress.begin("Reference modes");
      Progress                silent;
      Run                     part(run.parameters, run, silent);
      const FrictionlessModes modes  = frictionless_modes(linearised_scene(scene, part), part, reference_margin);
      ReferenceModes          result = reference_modes(modes, run.parameters.materials);
      run.progress.finish(text(result.names.size(), " modes of the scene as it is, by which those of designs are named"));
      return result;
    }

    /// Designs that one MPI process solves side by side: by cores, and by the memory that each takes.
    unsigned int n_side_by_side(const Scene &scene, const Run &run)
    {
      if (run.parameters.designs.n_processes > 0)
        return run.parameters.designs.n_processes;
      MPI_Comm machine;
      int      n_here = 1;
      MPI_Comm_split_type(run.communicator, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
      MPI_Comm_size(machine, &n_here);
      MPI_Comm_free(&machine);
      const unsigned int degree    = degree_of(run.parameters.discretization.element);
      const double       bytes     = expected_size(scene.mesh, degree).memory(degree, run.parameters.solvers.maximum_modes);
      const double       by_cores  = std::min<double>(n_usable_cores(), static_cast<double>(std::thread::hardware_concurrency()) / n_here);
      const double       by_memory = available_memory() / bytes / n_here;
      return static_cast<unsigned int>(std::max(1., std::floor(std::min(by_cores, by_memory))));
    }

    /// Says how a design went, and how long the others may take.
    class Reporter
    {
    public:
      Reporter(Run &run, const std::size_t n_all, const std::size_t n_known)
        : run(run)
        , n_all(n_all)
        , n_known(n_known)
      {}

      void operator()(const DesignResult &result)
      {
        ++n_done;
        const std::size_t n_left  = n_all - n_known - n_done;
        const double      seconds = stopwatch.cost().seconds / static_cast<double>(n_done) * static_cast<double>(n_left);
        const std::string what =
          result.outcome != DesignOutcome::solved ? to_string(result.outcome) + ": " + result.reason :
          result.weak_onset ? text("beyond ", 100. * weak_divergence, " % from mu = ", result.weak_onset->friction_coefficient, " on (",
                                   result.weak_onset->label, ")") :
                              text("nowhere beyond ", 100. * weak_divergence, " %");
        run.progress.note(text("    design ", result.number, ": ", what, "; ", std::round(result.seconds), " s",
                               n_left > 0 ? text(", ", n_left, " left, some ", std::ceil(seconds / 60.), " min") : ""));
        run.progress.update(text(n_known + n_done, " of ", n_all, " designs"));
      }

    private:
      Run              &run;
      const std::size_t n_all, n_known;
      std::size_t       n_done = 0;
      const Stopwatch   stopwatch;
    };

    /// Solves all designs in processes of their own, beginning with those that an interrupted run has left.
    std::vector<DesignResult> solve_all(Scene &scene, Run &run, const Work &work, const DesignStore &store)
    {
      const fs::path file = store.folder / DesignStore::reference_file;
      {
        const ReferenceModes modes = reference(scene, run, file);
        if (run.is_root && !fs::exists(file))
          {
            const std::vector<char> packed = dealii::Utilities::pack(modes, false);
            replace_file(file, {packed.data(), packed.size()});
          }
      }
      run.progress.begin("Designs");
      // Refused ones need no process
      std::vector<int> left;
      std::size_t      n_known = 0;
      for (const int design : work.designs)
        if (store.find(design))
          ++n_known;
        else
          left.push_back(design);
      MPI_Barrier(run.communicator);
      if (n_known > 0)
        run.progress.note(text("  an interrupted study goes on: ", n_known, " of ", work.designs.size(), " designs are known"));
      const int n_ranks = static_cast<int>(MPI::n_mpi_processes(run.communicator)),
                me      = static_cast<int>(MPI::this_mpi_process(run.communicator));
      std::vector<int> mine;
      for (std::size_t i = 0; i < left.size(); ++i)
        if (static_cast<int>(i) % n_ranks == me)
          mine.push_back(left[i]);
      const unsigned int n_here = n_side_by_side(scene, run);
      Reporter           report(run, n_known + mine.size(), n_known);
      solve_side_by_side(
        mine, n_here, store, [&](const int design) { return unfinished(run, work, design); }, std::ref(report), run);
      MPI_Barrier(run.communicator);
      std::vector<DesignResult> results;
      for (const int design : work.designs)
        if (auto result = store.find(design))
          results.push_back(*std::move(result));
      run.progress.finish(text(results.size(), " designs, ", n_here * n_ranks, " side by side"));
      return results;
    }

    /// A parameter file of each design, so that it can be run by itself.
    void write_parameter_files(const Run &run, const Work &work)
    {
      for (const int design : work.designs)
        {
          std::string reason;
          if (auto parameters = parameters_of(run, work, design, reason))
            {
              parameters->designs       = {};
              const GeometryCopy copy   = copy_of(parameters->geometry.path());
              parameters->geometry.file = (copy.files.empty() ? "" : "../") + copy.name; // shipped geometries are found by their names
              run.folder().write(text("designs/", design, ".prm"), [&](std::ostream &stream) { parameters->print(stream, false); });
            }
        }
    }
  } // namespace

  /**
   * `Study = geometry`: sweeps of many designs, each meshed anew, with their thresholds; modes named by those of the scene that they
   * resemble. Each design is solved in a process of its own, which is this study of one design.
   */
  static void run_design_study(Scene &scene, Run &run)
  {
    const Work                 work = work_of(run);
    std::vector<DesignResult>  results;
    const bool                 is_one = work.designs.size() == 1;
    std::optional<DesignStore> store;
    if (is_one)
      {
        const fs::path       folder = fs::path(run.folder().name()).parent_path();
        const ReferenceModes modes  = reference(scene, run, folder / DesignStore::reference_file);
        run.progress.begin(text("Design ", work.designs.front()));
        results.push_back(solve_here(run, work, work.designs.front(), modes));
        run.progress.finish();
        // For the study of which this is a part
        if (fs::exists(folder / DesignStore::reference_file))
          {
            const std::vector<char> packed = dealii::Utilities::pack(results.front(), false);
            run.folder().write(DesignStore::result_file,
                               [&](std::ostream &stream) { stream.write(packed.data(), static_cast<std::streamsize>(packed.size())); });
          }
      }
    else
      {
        store.emplace(checkpoint_folder(run.folder().name()), key_of(run, scene, work.plan), run.communicator);
        results = solve_all(scene, run, work, *store);
        write_parameter_files(run, work);
      }

    run.count("designs", results.size());
    run.screen << '\n';
    for (const std::string &line : verdict(work.plan.names, results))
      run.progress.note(line);
    run.screen << "\n  the quietest designs, all in designs.csv\n\n";
    quietest_designs(work.plan.names, results).print(run.screen);
    run.screen << '\n';
    run.store_table("designs", design_table(work.plan.names, results));
    run.store_table("design_thresholds", design_threshold_table(results));
    run.store_table("design_modes", design_mode_table(results));
    run.finish();
    if (store && run.is_root)
      store->remove();
  }

  extern const Study design_study = [] {
    const auto of_samples = [](const Parameters &p) {
      return unless(p.designs.is_sampled(), "only a Latin hypercube and a Sobol sequence are samples");
    };
    const auto of_single_sweeps = [](const Parameters &) { return "designs have no maps, planes and mode shapes; Study = sweep has"; };
    Study      study{"geometry", run_design_study, {"Designs/", "Sweep/"}};
    study.rules = {
      {"Operation/Friction coefficient",
       [](const Parameters &) { return "designs go from Sweep/First to Sweep/Last friction coefficient"; }},
      {"Operation/Rotation speed", no_sliding_speed},
      {"Complex modes/", [](const Parameters &) { return "designs are solved as reduced models"; }},
      {"Designs/File", [](const Parameters &p) { return unless(p.designs.choice == DesignChoice::file, "Designs/Plan is not file"); }},
      {"Designs/Variables", [](const Parameters &p) { return unless(p.designs.choice != DesignChoice::file, "Designs/Plan = file"); }},
      {"Designs/Number of designs", of_samples},
      {"Sweep/Compare dissipation", of_single_sweeps},
      {"Sweep/Mode shapes at", of_single_sweeps},
      {"Sweep/Complex plane at", of_single_sweeps},
      {"Sweep/Count modes at", of_single_sweeps},
      {"Sweep/Map parameter", of_single_sweeps},
      {"Sweep/First map value", of_single_sweeps},
      {"Sweep/Last map value", of_single_sweeps},
      {"Sweep/Number of map values", of_single_sweeps},
      {"Sweep/Map friction coefficients", of_single_sweeps},
      {"Designs/Seed", of_samples}};
    study.no_mode_shapes = [](const Parameters &) { return "the study writes no mode shapes; parameter files of its designs do"; };
    study.check          = [](const Parameters &p) {
      // Names must be right; what a design makes of its values is told in its row
      const DesignPlan plan = design_plan(p);
      for (const std::string &names : plan.names)
        for (const std::string &name : dealii::Utilities::split_string_list(names, '+'))
          current_value(p, name);
    };
    return study;
  }();
} // namespace Squeal
