// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/studies/designs/design_work.h>
#include <squeal/studies/robustness/robustness.h>

#include <deal.II/base/utilities.h>

#include <new>
#include <regex>
#include <ostream>

namespace Squeal
{
  namespace
  {
    namespace fs = std::filesystem;

    /// Numbers in a list such as "3, 7-9".
    std::vector<int> parse_designs(const std::string &list, const int n)
    {
      const auto refuse = [&](const std::string &what) {
        throw ParameterError(what, "command line, --designs " + legible(list),
                             text("list numbers or ranges from 1 to ", n, ", separated by commas"));
      };
      std::set<int> result;
      for (const std::string &part : dealii::Utilities::split_string_list(list, ','))
        {
          static const std::regex pattern(R"((\d{1,9})(?:\s*-\s*(\d{1,9}))?)");
          std::smatch             ends;
          const bool              is_range = std::regex_match(part, ends, pattern);
          const int first = is_range ? std::stoi(ends[1]) : 0, last = is_range && ends[2].matched ? std::stoi(ends[2]) : first;
          if (first < 1 || last < first || last > n)
            refuse(in_quotes(part) + " is neither the number of a design nor an ascending range of such numbers");
          for (int design = first; design <= last; ++design)
            result.insert(design);
        }

      if (result.empty())
        refuse("the list is empty");
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
      const auto      parameters = parameters_of(run, work.plan, design, &result.reason);
      if (!parameters)
        {
          result.outcome = DesignOutcome::refused;
          return result;
        }
      try
        {
          DesignResult solved = solve_design(*parameters, reference, run);
          solved.number       = design;
          solved.values       = result.values;
          return solved;
        }
      catch (const FileError &)
        {
          throw; // not caused by the design
        }
      catch (const Error &error)
        {
          const bool makes_no_sense = dynamic_cast<const MeshError *>(&error) || dynamic_cast<const ParameterError *>(&error);
          result.outcome            = makes_no_sense ? DesignOutcome::refused : DesignOutcome::failed;
          result.reason             = in_one_line(error);
        }
      catch (const std::bad_alloc &)
        {
          result.outcome = DesignOutcome::failed;
          result.reason  = "out of memory";
        }
      result.seconds = stopwatch.cost().seconds;
      return result;
    }

    /// Solves the designs of a worker process: one design, or several on a common mesh with one growing basis.
    void solve_part(Run &run, const DesignWork &work, const ReferenceModes &reference, const DesignStore &store)
    {
      const auto              alone = [&](const int design) { return solve_here(run, work, design, reference); };
      std::vector<Parameters> designs;
      for (const int design : work.designs)
        designs.push_back(sweep_of(*parameters_of(run, work.plan, design)));
      Run                         part(designs.front(), run, run.progress);
      std::optional<DesignFamily> family;
      try
        {
          if (designs.size() > 1)
            family.emplace(designs, part);
        }
      catch (const FileError &)
        {
          throw;
        }
      catch (const Error &)
        {} // errors are reported in the rows of the designs
      if (!family)
        {
          for (const int design : work.designs)
            if (!store.find(design))
              store.keep(alone(design));
          return;
        }

      for (std::size_t i = 0; i < designs.size(); ++i)
        {
          // Solve finished designs again to rebuild the basis
          const int  design = work.designs[i];
          const auto known  = store.find(design);
          if (known && known->outcome != DesignOutcome::solved)
            continue;
          DesignResult result;
          try
            {
              result = solve_member(*family, i, reference);
            }
          catch (const FileError &)
            {
              throw;
            }
          catch (const Error &error)
            {
              run.progress.note(text("  design ", design, " is solved individually: ", in_one_line(error)));
              result = alone(design);
            }
          result.number = design;
          result.values = unfinished(run, work.plan, design).values;
          if (!known)
            store.keep(result);
        }
    }
  } // namespace

  /// `Study = geometry`: sweeps and thresholds of many designs. Modes are labelled by the most similar modes of the given model. Each worker
  /// process runs this study for one design, or for several designs on a common mesh.
  static void run_design_study(Scene &scene, Run &run)
  {
    const DesignWork           work = work_of(run);
    std::vector<DesignResult>  results;
    std::optional<DesignStore> store;
    const fs::path             above   = fs::path(run.folder().name()).parent_path();
    const bool                 is_part = fs::exists(above / DesignStore::reference_file); // the study has stored its reference modes there
    if (is_part)
      {
        solve_part(run, work, design_reference(scene, run, above / DesignStore::reference_file), DesignStore(above));
        run.finish();
        return;
      }
    for (const UnusedParameter &variable : unused_variables(run.parameters, work.plan))
      run.progress.note(text("  note: ", variable.path, " has no effect on the designs: ", variable.why));

    if (work.designs.size() == 1)
      {
        const ReferenceModes modes = design_reference(scene, run, above / DesignStore::reference_file);
        run.progress.begin(text("Design ", work.designs.front()));
        results.push_back(solve_here(run, work, work.designs.front(), modes));
        run.progress.finish();
      }
    else
      {
        store.emplace(checkpoint_folder(run.folder().name()), design_key(run, scene, work.plan), run.communicator);
        if (const std::size_t n_known = store->n_known(work.designs); n_known > 0)
          run.progress.note(text("  continuing an interrupted study: ", n_known, " of ", work.designs.size(), " designs are finished"));
        results = solve_all(scene, run, work, *store, run.options.again);
      }
    for (const int design : work.designs)
      if (const auto parameters = parameters_of(run, work.plan, design))
        write_parameter_file(*parameters, text("designs/", design, ".prm"), run);

    write_designs(work.plan.names, results, run);
    run.finish([&] {
      if (store && run.is_root)
        fs::remove_all(store->folder);
    });
  }

  /// `Study = geometry` for a system file: modes for the parameter values of each design.
  static void run_designs_of_system(Run &run)
  {
    SystemFile       file = read_system(run);
    const SamplePlan designs =
      listed_samples(design_plan(run.parameters), [&](const std::string &name) { return value_in(file, name, run.parameters); });
    const auto systems = sampled_file(std::move(file), designs, run);
    const auto found   = solve_samples(systems, designs.n(), run.parameters.sweep.tolerance, run).samples;
    run.write_table("samples", sample_table(designs, found));
    run.store_table("sample_modes", cloud_table(designs, found));
    run.finish();
  }

  extern const Study design_study = [] {
    const auto of_samples = [](const Parameters &p) {
      return unless(p.designs.is_sampled(), "only for Designs/Plan = Latin hypercube or Sobol sequence");
    };
    Study study = study_of_designs(
      "geometry", run_design_study,
      {{"Designs/File", [](const Parameters &p) { return unless(p.designs.choice == DesignChoice::file, "Designs/Plan is not file"); }},
       {"Designs/Variables", [](const Parameters &p) { return unless(p.designs.choice != DesignChoice::file, "Designs/Plan = file"); }},
       {"Designs/Number of designs", of_samples},
       {"Designs/Seed", of_samples}});
    study.check         = [](const Parameters &p) { check_designs(p, design_plan(p)); };
    study.run_of_system = run_designs_of_system;
    return study;
  }();
} // namespace Squeal
