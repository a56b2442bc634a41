// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/studies/reduction/direct_reduction.h>
#include <squeal/studies/reduction/reduction_tables.h>
#include <squeal/studies/steps/imported_modes.h>
#include <squeal/studies/steps/parameter_usage.h>

#include <ostream>

namespace Squeal
{
  namespace
  {
    /// Number of timed solutions of a reduced problem; the shortest time is reported.
    constexpr int n_timed_solutions = 3;

    std::vector<double> disc_shares_of(const FrictionlessModes &frictionless, const ComplexModes &modes)
    {
      const Scene &scene = *frictionless.linearisation.scene;
      return disc_shares(*scene.model, scene.system, *frictionless.linearisation.coupled.kernel, modes);
    }

    /// Labels of real coupled modes by pin modes, even if the disc moves more.
    std::vector<ModeLabel> pin_labels(const FrictionlessModes &frictionless, const ComplexModes &modes)
    {
      const SparseMatrix    &mass = *frictionless.linearisation.scene->system.mass;
      const MultiVector      u    = *frictionless.linearisation.coupled.kernel * *modes.real_part;
      std::vector<ModeLabel> labels;
      for (int j = 0; j < u.n_columns(); ++j)
        labels.push_back(
          identify({&frictionless.pins_sliding}, shape_shares({&frictionless.pins_sliding}, mass, view(u, j, 1), nullptr)).front());
      return labels;
    }

    ReferenceSolution complex_reference(const ReductionPlan &plan, const FrictionlessModes &frictionless, Run &run)
    {
      const FrictionModes full   = friction_modes(frictionless, plan.friction_coefficient, run);
      const auto          shares = disc_shares_of(frictionless, full.modes);
      return {
        full.modes,    full.labels,          shares, friction_groups(shares, full.modes.lambda, full.unstable), {{"disc", "unstable pins"}},
        full.unstable, full.cost.cpu_seconds};
    }

    ReferenceSolution real_reference(const FrictionlessModes &frictionless)
    {
      const ComplexModes           modes = undamped_modes(frictionless.real);
      const std::vector<ModeLabel> labels(frictionless.labels.begin() + frictionless.real.n_rigid_body, frictionless.labels.end());
      const auto                   shares = disc_shares_of(frictionless, modes);
      return {modes,
              labels,
              shares,
              frictionless_groups(shares, pin_labels(frictionless, modes)),
              {{"disc", "F1"}},
              std::vector<bool>(labels.size(), false),
              frictionless.solution.cpu_seconds};
    }

    ReferenceSolution reference_of_system(const FrictionModes &full)
    {
      std::vector<std::string> groups;
      for (const bool grows : full.unstable)
        groups.emplace_back(grows ? "unstable" : "other");
      return {full.modes, full.labels, {}, groups, {{"unstable", "other"}}, full.unstable, full.cost.cpu_seconds};
    }

    /// Modes of a reduced model with the CPU time of the fastest of several solutions [s].
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

    /// Builds a basis and compares its modes with the reference, as a step of the run with this @p name.
    ///
    /// @param number of the basis, counted from one
    MeasuredBasis measured(const ReductionSets     &sets,
                           const ReferenceSolution &reference,
                           const BasisRecipe       &recipe,
                           const std::string       &name,
                           const std::string       &truncation,
                           const int                number)
    {
      Progress                  &progress  = sets.run.progress;
      const ReductionParameters &reduction = sets.run.parameters.reduction;
      progress.begin(name);
      BasisOptions options;
      options.tolerance     = reduction.rank_tolerance;
      options.pod_tolerance = reduction.pod_tolerance;
      const Stopwatch watch;
      MeasuredBasis   candidate{&recipe, name, truncation, reduced_basis(recipe, sets.ingredients, options)};
      ReducedModel    model(sets.system);
      model.extend(*candidate.basis.vectors);
      candidate.build_seconds  = sets.cost(recipe) + watch.cost().cpu_seconds;
      const ReducedModes modes = timed_modes(sets.plan, model, candidate.solve_seconds);
      candidate.errors         = reduction_errors(sets.system, *sets.frictionless.inverse, model, modes, reference.modes);
      progress.finish(text(counted(candidate.basis.n_r0, "vector"), ", ", candidate.basis.size(),
                           " after coupling and rank reduction, largest error of lambda ", largest_error(candidate)));
      write_reduced_system(model, sets.plan, candidate, number, sets.run);
      // Free the vectors, which are no longer needed
      candidate.n_r = candidate.basis.size();
      candidate.basis.vectors.reset();
      return candidate;
    }

    /// Compares all bases with the reference: bases of component modes for every truncation, of real coupled modes for every frequency, of
    /// snapshots, and bases grown from the real modes of the band.
    std::vector<MeasuredBasis> all_measured(ReductionSets               &sets,
                                            const ReferenceSolution     &reference,
                                            std::vector<TruncatedModes> &truncations)
    {
      const ReductionParameters &reduction = sets.run.parameters.reduction;
      std::vector<MeasuredBasis> result;
      const auto                 measure = [&](const BasisRecipe *recipe, const std::string &variant, const std::string &truncation = "") {
        const int number = static_cast<int>(result.size()) + 1;
        result.push_back(measured(sets, reference, *recipe, recipe->name + variant, truncation, number));
      };
      const auto those = [&](bool (BasisRecipe::*property)() const) {
        std::vector<const BasisRecipe *> list;
        std::copy_if(sets.plan.recipes.begin(), sets.plan.recipes.end(), std::back_inserter(list), std::mem_fn(property));
        return list;
      };
      if (const auto connected = those(&BasisRecipe::is_connected); !connected.empty())
        for (const ModeTruncation &truncation : reduction.truncations)
          {
            truncations.push_back({truncation, sets.truncate(truncation)});
            for (const BasisRecipe *recipe : connected)
              measure(recipe, "", truncation.text());
          }
      if (const auto real = those(&BasisRecipe::has_real_modes); !real.empty())
        for (const double frequency : reduction.coupled_frequencies)
          {
            sets.take_real_modes(frequency);
            for (const BasisRecipe *recipe : real)
              measure(recipe, frequency > 0. ? " (" + exact_text(frequency) + " Hz)" : "");
          }
      sets.take_real_modes(0.);
      for (const BasisRecipe *recipe : sets.plan.recipes)
        if (recipe->rests_on(BasisSource::residuals))
          for (const double tolerance : reduction.grown_tolerances)
            {
              sets.grow(tolerance);
              measure(recipe, text(" ", tolerance));
            }
        else if (!recipe->is_connected() && !recipe->has_real_modes())
          measure(recipe, "");
      return result;
    }

    /// Writes the tables; @p n: number of uncoupled dofs.
    void write_tables(const std::vector<MeasuredBasis> &candidates, const ReferenceSolution &reference, const int n, Run &run)
    {
      run.write_table("reduction_bases", reduction_basis_table(candidates, n, reference.seconds));
      run.write_table("reduction_errors", reduction_error_table(candidates, reference));
      run.write_table("reduction_estimates", reduction_estimate_table(candidates, reference));
      run.store_table("reduction_modes", reduction_mode_table(candidates, reference));
      run.screen << '\n';
      run.progress.note(text("  full order: ", reference.seconds, " s of CPU time for ", counted(reference.labels.size(), "mode")));
      run.finish();
    }

    /// Compares all bases and writes the tables; @p n: number of uncoupled dofs.
    void measure_bases(const ReductionPlan     &plan,
                       const FrictionlessModes &frictionless,
                       const CoupledSystem     &system,
                       ReferenceSolution        reference,
                       const int                n,
                       Run                     &run)
    {
      ReductionSets               sets(plan, frictionless, system, run);
      std::vector<TruncatedModes> truncations;
      reference.seconds += sets.full_order_factorisation();
      const std::vector<MeasuredBasis> candidates = all_measured(sets, reference, truncations);
      if (!truncations.empty())
        run.write_table("reduction_truncations", reduction_truncation_table(truncations));
      run.write_table("reduction_costs", sets.cost_table());
      write_tables(candidates, reference, n, run);
    }
  } // namespace

  /// `Study = reduction`: compares modes of reduced bases, for example those of Tables 2, 4 and 5 of the paper, with full-order modes.
  /// Reports sizes, ranks, errors by groups of modes, error estimates with their verdicts, and costs.
  static void run_reduction_study(Scene &scene, Run &run)
  {
    const ReductionPlan     plan         = reduction_plan(run.parameters);
    const FrictionlessModes frictionless = damped_modes(scene, run);
    const CoupledSystem    &coupled      = frictionless.linearisation.coupled;
    write_scene_system(frictionless.linearisation, friction_parameter(run.parameters), "system/", run);
    measure_bases(plan, frictionless, plan.has_friction ? coupled : undamped(coupled),
                  plan.has_friction ? complex_reference(plan, frictionless, run) : real_reference(frictionless),
                  scene.model->free_map().n(), run);
  }

  /// `Study = reduction` for a system file, without bases of component modes.
  static void run_reduction_of_system(Run &run)
  {
    const GivenSystem   given = given_system(run);
    const ReductionPlan plan  = reduction_plan(run.parameters, given.file, given.coupled, given.value);
    write_system_again(given.file, "system/", run);
    if (!given.coupled.stiffness)
      {
        const ReferenceSolution reference = reference_of_system(direct_solution(given, run));
        write_tables({direct_pod(given, plan, reference.modes, run)}, reference, given.file.map.n(), run);
        return;
      }
    const FrictionlessModes frictionless = imported_modes(given.coupled, given.coupled, run);
    measure_bases(plan, frictionless, given.coupled, reference_of_system(friction_modes(frictionless, given.value, run)),
                  given.file.map.n(), run);
  }

  extern const Study reduction_study = [] {
    Study study{"reduction", run_reduction_study, {"Reduction/", "Output/Write system"}, reduction_usage()};
    study.rules.push_back({"Output/Write system", is_used});
    study.rules.push_back({"Output/", [](const Parameters &) { return "not written by Study = reduction"; }});
    study.has_reduced_model = true;
    study.check             = [](const Parameters &p) {
      const auto &pairs = p.contact.pairs;
      if (std::any_of(pairs.begin(), pairs.end(), [](const ContactPair &pair) { return pair.normal_stiffness > 0.; }))
        throw ParameterError("reduced bases require rigid contact, but a pair has a normal stiffness", "parameter Contact/Pairs",
                                         "remove the normal stiffness, or set Study = stability or sweep");
      reduction_plan(p);
    };
    study.run_of_system = run_reduction_of_system;
    return study;
  }();
} // namespace Squeal
