#include <squeal/base/conventions.h>
#include <squeal/studies/friction_modes.h>
#include <squeal/studies/reduction_plan.h>
#include <squeal/studies/reduction_sets.h>
#include <squeal/studies/reduction_tables.h>

#include <algorithm>
#include <ostream>

namespace Squeal
{
  namespace
  {
    /// Solutions of a reduced problem of which the fastest is reported.
    constexpr int n_timed_solutions = 3;

    /// What bases are measured against.
    struct Reference
    {
      ComplexModes             modes;
      std::vector<ModeLabel>   labels; ///< of the modes
      std::vector<std::string> groups;
      std::vector<bool>        unstable;
      double                   seconds; ///< of the processor for the solution, its factorisation included
    };

    Reference reference_modes(const ReductionPlan     &plan,
                              const Scene             &scene,
                              const Linearisation     &linearisation,
                              const FrictionlessModes &frictionless,
                              Run                     &run)
    {
      const double factorisation = frictionless.factorisation.cpu_seconds;
      if (plan.has_friction)
        {
          const FrictionModes full = friction_modes(scene, linearisation, frictionless, plan.friction_coefficient, run);
          return {full.modes, full.labels, friction_groups(full.labels, full.unstable), full.unstable,
                  factorisation + full.cost.cpu_seconds};
        }
      const std::vector<ModeLabel> labels(frictionless.labels.begin() + frictionless.real.n_rigid_body, frictionless.labels.end());
      return {undamped_modes(frictionless.real), labels, frictionless_groups(labels), std::vector<bool>(labels.size(), false),
              factorisation + frictionless.solution.cpu_seconds};
    }

    /// Modes of a reduced model with the processor seconds of the fastest of several solutions.
    ReducedModes timed_modes(const ReductionPlan &plan, const ReducedModel &model, double &seconds)
    {
      ReducedModes modes;
      for (int solution = 0; solution < n_timed_solutions; ++solution)
        {
          const Stopwatch watch;
          modes = plan.has_friction ? reduced_modes(model, plan.friction_coefficient, plan.largest_circular_frequency, BandEnd::open) :
                                      reduced_real_modes(model, plan.largest_circular_frequency, BandEnd::open);
          const double latest = watch.cost().cpu_seconds;
          seconds             = solution == 0 ? latest : std::min(seconds, latest);
        }
      return modes;
    }

    /// Builds a basis and holds it against the reference, as a step of the run called @p name.
    Candidate measured(const ReductionPlan &plan,
                       const CoupledSystem &system,
                       const Reference     &reference,
                       const ReductionSets &sets,
                       const BasisRecipe   &recipe,
                       const std::string   &name,
                       const std::string   &truncation,
                       Run                 &run)
    {
      run.progress.begin(name);
      BasisOptions options;
      options.tolerance     = run.parameters.reduction.rank_tolerance;
      options.pod_tolerance = run.parameters.reduction.pod_tolerance;
      const Stopwatch watch;
      Candidate       candidate{&recipe, name, truncation, reduced_basis(recipe.kind, sets.ingredients(), options)};
      ReducedModel    model(system);
      model.extend(*candidate.basis.vectors);
      candidate.build_seconds  = sets.cost(recipe) + watch.cost().cpu_seconds;
      const ReducedModes modes = timed_modes(plan, model, candidate.solve_seconds);
      candidate.errors         = reduction_errors(system, *sets.ingredients().inverse, model, modes, reference.modes);
      double largest           = 0.;
      for (const ModeError &e : candidate.errors)
        largest = std::max(largest, e.eigenvalue);
      run.progress.finish(
        text(candidate.basis.n_r0, " vectors, ", candidate.basis.size(), " after connection and rank, largest error of lambda ", largest));
      // Hundreds of vectors each: they are not needed any more
      candidate.n_r = candidate.basis.size();
      candidate.basis.vectors.reset();
      return candidate;
    }

    /// Bases of component modes of every truncation, then the others.
    std::vector<Candidate> candidates_of(const ReductionPlan &plan,
                                         const CoupledSystem &system,
                                         const Reference     &reference,
                                         ReductionSets       &sets,
                                         Run                 &run)
    {
      const ReductionParameters &reduction = run.parameters.reduction;
      std::vector<Candidate>     result;
      const auto                 measure = [&](const BasisRecipe &recipe, const std::string &name, const std::string &truncation) {
        result.push_back(measured(plan, system, reference, sets, recipe, name, truncation, run));
      };
      std::vector<const BasisRecipe *> connected, others;
      std::partition_copy(plan.recipes.begin(), plan.recipes.end(), std::back_inserter(connected), std::back_inserter(others),
                          [](const BasisRecipe *recipe) { return recipe->is_connected(); });
      if (!connected.empty())
        for (const ModeTruncation &truncation : reduction.truncations)
          {
            sets.truncate(truncation);
            for (const BasisRecipe *recipe : connected)
              measure(*recipe, recipe->name, truncation.text());
          }
      for (const BasisRecipe *recipe : others)
        if (!recipe->rests_on(BasisSource::residuals))
          measure(*recipe, recipe->name, "");
        else
          for (const double tolerance : reduction.grown_tolerances)
            {
              sets.grow(tolerance);
              measure(*recipe, text(recipe->name, " ", tolerance), "");
            }
      return result;
    }
  } // namespace

  /**
   * `Study = reduction`: reduced bases measured against full-order modes, those
   * of Tables 2, 4 and 5 of the paper and better ones: sizes, rank decisions,
   * errors by groups of modes, error estimates with their verdicts, and what
   * building and solving cost.
   */
  static void run_reduction_study(Scene &scene, Run &run)
  {
    const ReductionPlan     plan          = reduction_plan(run.parameters);
    Linearisation           linearisation = linearised_scene(scene, run);
    const FrictionlessModes frictionless  = frictionless_modes(scene, linearisation, run);
    add_modal_damping(frictionless, run.parameters, linearisation);
    const CoupledSystem &coupled = linearisation.coupled;
    const CoupledSystem  system  = plan.has_friction ? coupled : undamped(coupled);

    const Reference              reference = reference_modes(plan, scene, linearisation, frictionless, run);
    ReductionSets                sets(plan, scene, linearisation, frictionless, system, run);
    const std::vector<Candidate> candidates = candidates_of(plan, system, reference, sets, run);

    // ----------------------------------------------------------------- results
    run.write_table("reduction_bases", reduction_basis_table(candidates, coupled.map().NumGlobalElements(), reference.seconds));
    run.write_table("reduction_errors", reduction_error_table(candidates, reference.groups));
    run.write_table("reduction_estimates", reduction_estimate_table(candidates, reference.unstable));
    run.store_table("reduction_modes", reduction_mode_table(candidates, reference.labels, reference.groups));
    run.screen << '\n';
    run.progress.note(text("  full order: ", reference.seconds, " s of CPU for ", reference.labels.size(), " modes"));
    run.finish();
  }

  extern const Study reduction_study = [] {
    Study study{"reduction", run_reduction_study, {"Reduction/"}, reduction_usage()};
    study.no_mode_shapes = [](const Parameters &) { return "the study writes no mode shapes"; };
    study.check          = [](const Parameters &p) { reduction_plan(p); };
    study.has_friction   = [](const Parameters &p) { return p.reduction.problem == ReductionProblem::friction; };
    return study;
  }();
} // namespace Squeal
