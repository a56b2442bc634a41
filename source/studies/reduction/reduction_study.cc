#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/bases/reduced_basis.h>
#include <squeal/estimates/mode_groups.h>
#include <squeal/estimates/reduction_errors.h>
#include <squeal/studies/steps/parameter_usage.h>
#include <squeal/studies/steps/reduction_sets.h>

#include <ostream>

namespace Squeal
{
  namespace
  {
    /// A basis of a study with what was measured of it.
    struct Candidate
    {
      const BasisRecipe     *recipe;
      std::string            name;       ///< with the variant where there are several
      std::string            truncation; ///< of the component modes
      ReducedBasis           basis;      ///< its vectors go when it has been measured
      int                    n_r           = 0;
      double                 build_seconds = 0., solve_seconds = 0.;
      std::vector<ModeError> errors = {};
    };

    /// The modes of full order that bases are measured against.
    struct Reference
    {
      ComplexModes                          modes;
      std::vector<ModeLabel>                labels;      ///< of the modes
      std::vector<double>                   disc_shares; ///< of their energy [-]
      std::vector<std::string>              groups;
      std::vector<std::vector<std::string>> joined; ///< groups whose maxima the paper takes together
      std::vector<bool>                     unstable;
      double                                seconds; ///< of the processor for the solution, its factorisation included
    };

    /// Numbers of component modes that a truncation has led to.
    struct TruncatedModes
    {
      ModeTruncation             truncation;
      std::map<BasisSource, int> n;
    };

    /// Estimates count as good within this factor of the true error.
    constexpr double good_factor = 3.;

    /// Relative differences of λ below this are rounding errors of the reference and say nothing about an estimate.
    constexpr double reference_accuracy = 1e-11;

    /// A condition number; nothing where the matrix is singular to rounding.
    Entry condition_cell(const double condition)
    {
      return std::isfinite(condition) ? Entry(condition) : Entry();
    }

    /// Largest errors in each group of modes, and times.
    Table reduction_error_table(const std::vector<Candidate> &candidates, const Reference &reference)
    {
      struct Row : GroupError
      {
        const Candidate &candidate;
      };
      std::vector<Row> rows;
      for (const Candidate &candidate : candidates)
        for (const GroupError &largest : largest_errors(candidate.errors, reference.groups, reference.joined))
          rows.push_back({largest, candidate});
      return Table(Columns<Row>{{"basis", "", [](const Row &row) { return row.candidate.name; }},
                                {"n_r0", "-", [](const Row &row) { return row.candidate.basis.n_r0; }},
                                {"n_r", "-", [](const Row &row) { return row.candidate.n_r; }},
                                {"group", "", &Row::group},
                                {"res", "-", &Row::residual, 1, true},
                                {"mac", "-", &Row::shape, 1, true},
                                {"frq", "-", &Row::frequency, 1, true},
                                {"div", "-", &Row::divergence, 1, true},
                                {"div estimated", "-", &Row::estimated_divergence, 1, true},
                                {"div corrected", "-", &Row::corrected_divergence, 1, true},
                                {"build time", "s", [](const Row &row) { return row.candidate.build_seconds; }, 2},
                                {"solve time", "s", [](const Row &row) { return row.candidate.solve_seconds; }, 3},
                                {"subspace", "-", &Row::subspace, 1, true},
                                {"lambda", "-", &Row::eigenvalue, 1, true},
                                {"component modes", "", [](const Row &row) { return row.candidate.truncation; }},
                                {"modes", "-", &Row::n_modes},
                                {"mac by eq. 17", "-", &Row::closest_shape, 1, true},
                                {"frq by eq. 17", "-", &Row::closest_frequency, 1, true},
                                {"div by eq. 17", "-", &Row::closest_divergence, 1, true},
                                {"other by eq. 17", "-", &Row::n_other}},
                   rows);
    }

    /// Columns, sizes, decisions on rank, gains and times beside @p n dofs of the uncoupled structure and @p full_seconds at full order.
    Table reduction_basis_table(const std::vector<Candidate> &candidates, const int n, const double full_seconds)
    {
      using Row = Candidate;
      return Table(
        Columns<Row>{{"basis", "", &Row::name},
                     {"columns", "", [](const Row &row) { return row.recipe->columns(); }},
                     {"component modes", "", &Row::truncation},
                     {"n_r0", "-", [](const Row &row) { return row.basis.n_r0; }},
                     {"n_r by formula", "-", [](const Row &row) { return row.basis.n_nominal; }},
                     {"n_r", "-", &Row::n_r},
                     {"dropped", "-", [](const Row &row) { return row.basis.n_dropped; }},
                     {"rank tolerance", "-", [](const Row &row) { return row.basis.tolerance; }, 0, true},
                     {"condition", "-", [](const Row &row) { return condition_cell(row.basis.condition); }, 1, true},
                     {"orthonormality", "-", [](const Row &row) { return row.basis.orthonormality; }, 1, true},
                     {"rank of P_n T_r0", "-", [](const Row &row) { return row.basis.connection.rank; }},
                     {"smallest kept", "-", [](const Row &row) { return row.basis.connection.smallest_kept; }, 1, true},
                     {"largest dropped", "-", [](const Row &row) { return row.basis.connection.largest_dropped; }, 1, true},
                     {"G_n", "-", [n](const Row &row) { return static_cast<double>(n) / row.n_r; }, 1},
                     {"build time", "s", &Row::build_seconds, 2},
                     {"solve time", "s", &Row::solve_seconds, 3},
                     {"G_t", "-", [full_seconds](const Row &row) { return full_seconds / (row.build_seconds + row.solve_seconds); }, 2}},
        candidates);
    }

    /// Every mode of every basis beside the reference.
    Table reduction_mode_table(const std::vector<Candidate> &candidates, const Reference &reference)
    {
      struct Row : ModeError
      {
        const Candidate &candidate;
        ModeLabel        label;
        std::string      group;
        double           disc_share;
        ModalQuantities  mode, exact, better;
      };
      std::vector<Row> rows;
      for (const Candidate &candidate : candidates)
        for (std::size_t j = 0; j < reference.labels.size(); ++j)
          {
            const ModeError &e = candidate.errors[j];
            rows.push_back({e, candidate, reference.labels[j], reference.groups[j], reference.disc_shares[j], modal_quantities(e.reduced),
                            modal_quantities(e.reference), modal_quantities(e.corrected)});
          }
      const auto frequency_bar  = [](const Row &row) { return std::abs(row.better.frequency - row.mode.frequency); };
      const auto divergence_bar = [](const Row &row) { return 100. * std::abs(row.better.divergence_rate - row.mode.divergence_rate); };
      return Table(Columns<Row>{{"basis", "", [](const Row &row) { return row.candidate.name; }},
                                {"component modes", "", [](const Row &row) { return row.candidate.truncation; }},
                                {"label", "", &Row::label},
                                {"group", "", &Row::group},
                                {"frequency", "Hz", [](const Row &row) { return row.mode.frequency; }, 3},
                                {"divergence rate", "%", [](const Row &row) { return 100. * row.mode.divergence_rate; }, 4},
                                {"error bar of frequency", "Hz", frequency_bar, 1, true},
                                {"error bar of divergence rate", "%", divergence_bar, 1, true},
                                {"verdict", "", &Row::verdict},
                                {"reference frequency", "Hz", [](const Row &row) { return row.exact.frequency; }, 3},
                                {"reference divergence rate", "%", [](const Row &row) { return 100. * row.exact.divergence_rate; }, 4},
                                {"eps_res", "-", &Row::residual, 1, true},
                                {"eps_mac", "-", &Row::shape, 1, true},
                                {"eps_frq", "-", &Row::frequency, 1, true},
                                {"eps_div", "-", &Row::divergence, 1, true},
                                {"error of lambda", "-", &Row::eigenvalue, 1, true},
                                {"estimated error of lambda", "-", &Row::estimated_error, 1, true},
                                {"error of corrected lambda", "-", &Row::corrected_error, 1, true},
                                {"condition", "-", [](const Row &row) { return condition_cell(row.condition); }, 1, true},
                                {"estimate claimed", "", [](const Row &row) { return row.claimed ? "yes" : "no"; }},
                                {"cluster", "-", &Row::cluster_size},
                                {"subspace", "-", &Row::subspace, 1, true},
                                {"share of the disc", "-", &Row::disc_share, 3},
                                {"reduced mode", "-", [](const Row &row) { return row.match + 1; }},
                                {"reduced mode by eq. 17", "-", [](const Row &row) { return row.closest + 1; }},
                                {"eps_mac by eq. 17", "-", &Row::closest_shape, 1, true},
                                {"eps_frq by eq. 17", "-", &Row::closest_frequency, 1, true},
                                {"eps_div by eq. 17", "-", &Row::closest_divergence, 1, true}},
                   rows);
    }

    /// How far the estimates are to be trusted: they know nothing of the reference.
    Table reduction_estimate_table(const std::vector<Candidate> &candidates, const Reference &reference)
    {
      struct Row
      {
        const Candidate    &candidate;
        int                 n_claimed = 0, n_good = 0, n_undecided = 0, n_wrong = 0;
        std::vector<double> ratios = {}, gains = {};
      };
      std::vector<Row> rows;
      for (const Candidate &candidate : candidates)
        {
          rows.push_back({candidate});
          Row &row = rows.back();
          for (std::size_t j = 0; j < candidate.errors.size(); ++j)
            {
              const ModeError &e = candidate.errors[j];
              row.n_undecided += e.verdict == Verdict::undecided;
              row.n_wrong += e.verdict != Verdict::undecided && (e.verdict == Verdict::unstable) != reference.unstable[j];
              row.n_claimed += e.claimed;
              if (!e.claimed || !(e.eigenvalue > reference_accuracy))
                continue;
              row.ratios.push_back(e.estimate_ratio);
              row.n_good += e.estimate_ratio > 1. / good_factor && e.estimate_ratio < good_factor;
              if (e.corrected_error > 0.)
                row.gains.push_back(e.eigenvalue / e.corrected_error);
            }
        }
      const auto median = [](std::vector<double> values) {
        std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
        return values.empty() ? Entry() : Entry(values[values.size() / 2]);
      };
      const auto good_share = [](const Row &row) { return row.ratios.empty() ? Entry() : Entry(100. * row.n_good / row.ratios.size()); };
      return Table(Columns<Row>{{"basis", "", [](const Row &row) { return row.candidate.name; }},
                                {"component modes", "", [](const Row &row) { return row.candidate.truncation; }},
                                {"modes", "-", [](const Row &row) { return row.candidate.errors.size(); }},
                                {"claimed", "-", &Row::n_claimed},
                                {"judged", "-", [](const Row &row) { return row.ratios.size(); }},
                                {"median ratio to the true error", "-", [&](const Row &row) { return median(row.ratios); }, 2},
                                {"within a factor of 3", "%", good_share, 0},
                                {"median gain of the correction", "-", [&](const Row &row) { return median(row.gains); }, 1},
                                {"undecided", "-", &Row::n_undecided},
                                {"wrong verdicts", "-", &Row::n_wrong}},
                   rows);
    }

    /// Numbers of component modes below each truncation.
    Table reduction_truncation_table(const std::vector<TruncatedModes> &truncations)
    {
      using Row          = TruncatedModes;
      const auto n_modes = [](const BasisSource source, const BasisSource other) {
        return [=](const Row &row) {
          for (const BasisSource asked : {source, other})
            if (const auto found = row.n.find(asked); found != row.n.end() && found->second > 0)
              return Entry(found->second);
          return Entry();
        };
      };
      using Source = BasisSource;
      return Table(Columns<Row>{{"component modes", "", [](const Row &row) { return row.truncation.text(); }},
                                {"disc", "-", n_modes(Source::disc_free, Source::disc_sliding)},
                                {"pins free", "-", n_modes(Source::pins_free, Source::pins_free)},
                                {"pins sliding", "-", n_modes(Source::pins_sliding, Source::pins_sliding)}},
                   truncations);
    }

    /// Solutions of a reduced problem of which the fastest is reported.
    constexpr int n_timed_solutions = 3;

    std::vector<double> disc_shares_of(const FrictionlessModes &frictionless, const ComplexModes &modes)
    {
      const Scene &scene = *frictionless.linearisation.scene;
      return disc_shares(*scene.model, scene.system, *frictionless.linearisation.coupled.kernel, modes);
    }

    /// What each of some real coupled modes is called among the modes of the pins, whether the disc moves more or not.
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

    Reference complex_reference(const ReductionPlan &plan, const FrictionlessModes &frictionless, Run &run)
    {
      const FrictionModes full   = friction_modes(frictionless, plan.friction_coefficient, run);
      const auto          shares = disc_shares_of(frictionless, full.modes);
      return {
        full.modes,    full.labels,          shares, friction_groups(shares, full.modes.lambda, full.unstable), {{"disc", "unstable pins"}},
        full.unstable, full.cost.cpu_seconds};
    }

    Reference real_reference(const FrictionlessModes &frictionless)
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

    /// Builds a basis and compares its modes with the reference, as a step of the run called @p name.
    Candidate measured(const ReductionSets &sets,
                       const Reference     &reference,
                       const BasisRecipe   &recipe,
                       const std::string   &name,
                       const std::string   &truncation = "")
    {
      Progress                  &progress  = sets.run.progress;
      const ReductionParameters &reduction = sets.run.parameters.reduction;
      progress.begin(name);
      BasisOptions options;
      options.tolerance     = reduction.rank_tolerance;
      options.pod_tolerance = reduction.pod_tolerance;
      const Stopwatch watch;
      Candidate       candidate{&recipe, name, truncation, reduced_basis(recipe, sets.ingredients, options)};
      ReducedModel    model(sets.system);
      model.extend(*candidate.basis.vectors);
      candidate.build_seconds  = sets.cost(recipe) + watch.cost().cpu_seconds;
      const ReducedModes modes = timed_modes(sets.plan, model, candidate.solve_seconds);
      candidate.errors         = reduction_errors(sets.system, *sets.frictionless.inverse, model, modes, reference.modes);
      double largest           = 0.;
      for (const ModeError &e : candidate.errors)
        largest = std::max(largest, e.eigenvalue);
      progress.finish(
        text(candidate.basis.n_r0, " vectors, ", candidate.basis.size(), " after connection and rank, largest error of lambda ", largest));
      // Hundreds of vectors each: they are not needed any more
      candidate.n_r = candidate.basis.size();
      candidate.basis.vectors.reset();
      return candidate;
    }

    /// Measures all bases: those of component modes with every truncation, those of real coupled modes up to every frequency, those that grow
    /// from the real modes of the band, and those of snapshots.
    std::vector<Candidate> all_measured(ReductionSets &sets, const Reference &reference, std::vector<TruncatedModes> &truncations)
    {
      const ReductionParameters &reduction = sets.run.parameters.reduction;
      std::vector<Candidate>     result;
      const auto                 measure = [&](const BasisRecipe *recipe, const std::string &variant, const std::string &truncation = "") {
        result.push_back(measured(sets, reference, *recipe, recipe->name + variant, truncation));
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
  } // namespace

  /// `Study = reduction`: reduced bases measured against full-order modes, those of Tables 2, 4 and 5 of the paper and better ones: sizes,
  /// rank decisions, errors by groups of modes, error estimates with their verdicts, and what building and solving cost.
  static void run_reduction_study(Scene &scene, Run &run)
  {
    const ReductionPlan     plan         = reduction_plan(run.parameters);
    const FrictionlessModes frictionless = damped_modes(scene, run);
    const CoupledSystem    &coupled      = frictionless.linearisation.coupled;
    const CoupledSystem     system       = plan.has_friction ? coupled : undamped(coupled);

    Reference                   reference = plan.has_friction ? complex_reference(plan, frictionless, run) : real_reference(frictionless);
    ReductionSets               sets(plan, frictionless, system, run);
    std::vector<TruncatedModes> truncations;
    reference.seconds += sets.full_order_factorisation();
    const std::vector<Candidate> candidates = all_measured(sets, reference, truncations);

    // ----------------------------------------------------------------- results
    run.write_table("reduction_bases", reduction_basis_table(candidates, scene.model->free_map().n(), reference.seconds));
    if (!truncations.empty())
      run.write_table("reduction_truncations", reduction_truncation_table(truncations));
    run.write_table("reduction_costs", sets.cost_table());
    run.write_table("reduction_errors", reduction_error_table(candidates, reference));
    run.write_table("reduction_estimates", reduction_estimate_table(candidates, reference));
    run.store_table("reduction_modes", reduction_mode_table(candidates, reference));
    run.screen << '\n';
    run.progress.note(text("  full order: ", reference.seconds, " s of CPU for ", reference.labels.size(), " modes"));
    run.finish();
  }

  extern const Study reduction_study = [] {
    Study study{"reduction", run_reduction_study, {"Reduction/"}, reduction_usage()};
    study.rules.push_back({"Output/", [](const Parameters &) { return "the study writes no mode shapes"; }});
    study.check = [](const Parameters &p) {
      const auto &pairs = p.contact.pairs;
      if (std::any_of(pairs.begin(), pairs.end(), [](const ContactPair &pair) { return pair.normal_stiffness > 0.; }))
        throw ParameterError("the bases of section Reduction are those of rigid contact", "parameter Contact/Pairs",
                             "leave out the normal stiffness, or choose Study = stability or sweep");
      reduction_plan(p);
    };
    return study;
  }();
} // namespace Squeal
