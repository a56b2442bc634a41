#include <squeal/base/exceptions.h>
#include <squeal/output/chart_checkpoint.h>
#include <squeal/parameters/design_plan.h>
#include <squeal/studies/design_solution.h>
#include <squeal/studies/design_work.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <ostream>
#include <set>

namespace Squeal
{
  namespace
  {
    namespace fs  = std::filesystem;
    namespace MPI = dealii::Utilities::MPI;

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

    DesignWork work_of(const Run &run)
    {
      DesignWork work{design_plan(run.parameters), {}};
      const int  n = static_cast<int>(work.plan.designs.size());
      if (!run.options.designs.empty())
        work.designs = parse_designs(run.options.designs, n);
      else
        for (int design = 1; design <= n; ++design)
          work.designs.push_back(design);
      return work;
    }

    /// Solves a design in this process.
    DesignResult solve_here(Run &run, const DesignWork &work, const int design, const ReferenceModes &reference)
    {
      DesignResult    result = unfinished(run, work.plan, design);
      const Stopwatch stopwatch;
      const auto      parameters = parameters_of(run, work.plan, design, result.reason);
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

  } // namespace

  /**
   * `Study = geometry`: sweeps of many designs, each meshed anew, with their thresholds; modes named by those of the scene that they
   * resemble. Each design is solved in a process of its own, which is this study of one design.
   */
  static void run_design_study(Scene &scene, Run &run)
  {
    const DesignWork           work = work_of(run);
    std::vector<DesignResult>  results;
    const bool                 is_one = work.designs.size() == 1;
    std::optional<DesignStore> store;
    if (is_one)
      {
        const fs::path       folder = fs::path(run.folder().name()).parent_path();
        const ReferenceModes modes  = design_reference(scene, run, folder / DesignStore::reference_file);
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
        store.emplace(checkpoint_folder(run.folder().name()), design_key(run, scene, work.plan), run.communicator);
        results = solve_all(scene, run, work, *store, run.options.again);
        for (const int design : work.designs)
          {
            std::string reason;
            if (const auto parameters = parameters_of(run, work.plan, design, reason))
              write_parameter_file(*parameters, text("designs/", design, ".prm"), run);
          }
      }

    write_designs(work.plan.names, results, run);
    run.finish();
    if (store && run.is_root)
      store->remove();
  }

  extern const Study design_study = [] {
    const auto of_samples = [](const Parameters &p) {
      return unless(p.designs.is_sampled(), "only a Latin hypercube and a Sobol sequence are samples");
    };
    Study study = study_of_designs(
      "geometry", run_design_study,
      {{"Designs/File", [](const Parameters &p) { return unless(p.designs.choice == DesignChoice::file, "Designs/Plan is not file"); }},
       {"Designs/Variables", [](const Parameters &p) { return unless(p.designs.choice != DesignChoice::file, "Designs/Plan = file"); }},
       {"Designs/Number of designs", of_samples},
       {"Designs/Seed", of_samples}});
    study.check = [](const Parameters &p) { check_variables(p, design_plan(p).names); };
    return study;
  }();
} // namespace Squeal
