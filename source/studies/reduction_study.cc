#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/bases/reduced_basis.h>
#include <squeal/bases/static_modes.h>
#include <squeal/linear_algebra/sparse.h>
#include <squeal/stability/krylov_modes.h>
#include <squeal/stability/reduction_errors.h>
#include <squeal/stability/residual_iteration.h>
#include <squeal/studies/friction_modes.h>
#include <squeal/studies/mode_tables.h>
#include <squeal/studies/parameter_usage.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <ostream>
#include <set>

namespace Squeal
{
  namespace
  {
    /// Solutions of a reduced problem of which the fastest is reported.
    constexpr int n_timed_solutions = 3;

    /// Estimates count as good within this factor of the true error.
    constexpr double good_factor = 3.;

    /// Relative differences of λ below this are rounding errors of the reference and say nothing about an estimate.
    constexpr double reference_accuracy = 1e-11;

    /// Processor seconds since construction.
    class Stopwatch
    {
    public:
      double seconds() const
      {
        return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      }

    private:
      std::clock_t start = std::clock();
    };

    // ------------------------------------------------------------------ choice

    /// A basis of the study with its variant.
    struct Candidate
    {
      BasisKind                     kind;
      std::string                   name;       ///< with the variant where there are several
      std::string                   truncation; ///< of the component modes
      ReducedBasis                  basis;      ///< its vectors go when it has been measured
      int                           n_r           = 0;
      double                        build_seconds = 0., solve_seconds = 0.;
      std::vector<ModeError>        errors = {};
    };

    std::vector<BasisKind> chosen_kinds(const Parameters &parameters, const bool has_damping)
    {
      const bool             friction = parameters.reduction.problem == ReductionProblem::friction;
      std::vector<BasisKind> kinds;
      const auto            &names = parameters.reduction.bases;
      for (const auto &entry : EnumTable<BasisKind>::names)
        {
          const bool fits = (friction || !needs_friction(entry.value)) && (has_damping || entry.value != BasisKind::real_two_sided_damped);
          if (names.empty() ? fits : std::find(names.begin(), names.end(), entry.name) != names.end())
            {
              if (!fits)
                throw ParameterError("the basis `" + std::string(entry.name) + "` " +
                                       (friction ? "needs damping, and there is none" : "belongs to the problem with friction"),
                                     "parameter Reduction/Bases",
                                     friction ? "switch a damping on, or leave the basis out" : "set Reduction/Problem = friction, or leave it out");
              kinds.push_back(entry.value);
            }
        }
      for (const std::string &name : names)
        if (std::none_of(EnumTable<BasisKind>::names.begin(), EnumTable<BasisKind>::names.end(),
                         [&](const auto &entry) { return entry.name == name; }))
          {
            std::string known;
            for (const auto &entry : EnumTable<BasisKind>::names)
              known += (known.empty() ? "" : ", ") + std::string(entry.name);
            throw ParameterError("there is no basis `" + name + "`", "parameter Reduction/Bases", "choose among " + known);
          }
      return kinds;
    }

    // ------------------------------------------------------------- ingredients

    /// Sets of vectors with what it cost to compute each; a basis pays for the sets that it uses.
    class Larder
    {
    public:
      /// Computes a set and books its processor seconds.
      template <typename Function>
      auto compute(const std::string &name, Function &&function)
      {
        const Stopwatch watch;
        auto            result = function();
        seconds[name]          = watch.seconds();
        return result;
      }

      void book(const std::string &name, const double cost)
      {
        seconds[name] = cost;
      }

      /// Seconds of all sets that the parts of a basis rest on, each once.
      double cost(const BasisKind kind, const std::string &variant) const
      {
        static const std::map<BasisPart, std::vector<std::string>> rests_on = {
          {BasisPart::disc_free, {"disc free"}},
          {BasisPart::disc_sliding, {"disc sliding"}},
          {BasisPart::pins_free, {"pins free"}},
          {BasisPart::pins_sliding, {"pins sliding"}},
          {BasisPart::normal_attachment, {"factor of K", "normal attachment"}},
          {BasisPart::normal_attachment_disc, {"factor of K", "normal attachment"}},
          {BasisPart::tangential_attachment, {"factor of K", "tangential attachment"}},
          {BasisPart::rubbing_attachment, {"factor of K", "normal attachment", "tangential attachment"}},
          {BasisPart::constraint_disc, {"constraint disc"}},
          {BasisPart::constraint_pins, {"constraint pins"}},
          {BasisPart::real, {"factor of K_c", "real modes"}},
          {BasisPart::coupled_tangential_attachment, {"factor of K_c"}},
          {BasisPart::snapshots, {"factor of K_c", "snapshots"}},
          {BasisPart::residuals, {"factor of K_c", "real modes", "*"}}};
        std::set<std::string> needed;
        for (const BasisPart part : basis_parts(kind))
          if (const auto entry = rests_on.find(part); entry != rests_on.end())
            needed.insert(entry->second.begin(), entry->second.end());
        double sum = 0.;
        for (std::string name : needed)
          {
            if (name == "*")
              name = variant;
            if (const auto entry = seconds.find(name); entry != seconds.end())
              sum += entry->second;
          }
        return sum;
      }

    private:
      std::map<std::string, double> seconds;
    };

    double step_seconds(const Run &run, const std::string &name)
    {
      double sum = 0.;
      for (const StepRecord &step : run.progress.steps())
        if (step.name == name)
          sum += step.cpu_seconds;
      return sum;
    }

    /// Component modes for the bases of one truncation.
    struct ComponentSets
    {
      std::unique_ptr<MultiVector> disc_free, disc_sliding, pins_free, pins_sliding;
    };

    /// The lowest modes of a component: @p count of them, or, where that is zero, all up to @p frequency [Hz].
    std::unique_ptr<MultiVector> lowest_modes(const Scene           &scene,
                                              const Linearisation   &linearisation,
                                              const Component        component,
                                              const ContactBoundary  boundary,
                                              const double           frequency,
                                              const int              count,
                                              const double           shift,
                                              const Run             &run)
    {
      SymmetricModesOptions options;
      options.solver    = run.parameters.solvers.real_solver;
      options.tolerance = run.parameters.solvers.real_tolerance;
      options.library   = run.parameters.solvers.library;
      options.what      = std::string("modes of the ") + (component == Component::disc ? "disc" : "pins") + " for reduced bases";
      options.shift     = component == Component::disc ? shift * shift : 0.;
      if (component == Component::pins)
        options.block_size = std::max<int>(8, 2 * scene.n_pins());

      // Numbers of modes are met by a band that grows
      constexpr double growth   = 1.25;
      constexpr int    attempts = 12;
      double           band     = frequency;
      for (int attempt = 0; attempt < attempts; ++attempt, band *= growth)
        {
          const double         omega = circular_frequency(band);
          const ComponentModes modes =
            component_modes(*scene.model, scene.interface, linearisation.interface, scene.system, component, boundary, omega * omega, options);
          const int found = modes.eigenvalues.size();
          if (count == 0 && found == 0)
            throw SolverError(options.what + ": none lies below " + text(frequency) + " Hz", "parameter Reduction/Component modes",
                              "raise the truncation frequency");
          if (count == 0)
            return std::make_unique<MultiVector>(*modes.vectors);
          if (found >= count)
            {
              const MultiVector lowest = view(*modes.vectors, 0, count);
              return std::make_unique<MultiVector>(lowest);
            }
        }
      throw SolverError(options.what + ": fewer than " + std::to_string(count) + " lie below " + text(band) + " Hz",
                        "parameter Reduction/Component modes", "lower the number of modes");
    }

    // ------------------------------------------------------------------ tables

    Table error_table(const std::vector<Candidate> &candidates, const std::vector<std::string> &groups)
    {
      Table table({{"basis", ""},
                   {"n_r0", "-"},
                   {"n_r", "-"},
                   {"group", ""},
                   {"res", "-", 1, true},
                   {"mac", "-", 1, true},
                   {"frq", "-", 1, true},
                   {"div", "-", 1, true},
                   {"div estimated", "-", 1, true},
                   {"div corrected", "-", 1, true},
                   {"build time", "s", 2},
                   {"solve time", "s", 3},
                   {"subspace", "-", 1, true},
                   {"lambda", "-", 1, true},
                   {"component modes", ""}});
      for (const Candidate &candidate : candidates)
        for (const GroupError &m : largest_errors(candidate.errors, groups))
          table.add_row({candidate.name, static_cast<long>(candidate.basis.n_r0), static_cast<long>(candidate.n_r), m.group, m.residual, m.shape,
                         m.frequency, m.divergence, m.estimated_divergence, m.corrected_divergence, candidate.build_seconds,
                         candidate.solve_seconds, m.subspace, m.eigenvalue, candidate.truncation});
      return table;
    }

    Table basis_table(const std::vector<Candidate> &candidates, const int n, const double full_seconds)
    {
      Table table({{"basis", ""},
                   {"columns", ""},
                   {"component modes", ""},
                   {"n_r0", "-"},
                   {"n_r by formula", "-"},
                   {"n_r", "-"},
                   {"dropped", "-"},
                   {"rank tolerance", "-", 0, true},
                   {"condition", "-", 1, true},
                   {"orthonormality", "-", 1, true},
                   {"rank of P_n T_r0", "-"},
                   {"smallest kept", "-", 1, true},
                   {"largest dropped", "-", 1, true},
                   {"G_n", "-", 1},
                   {"build time", "s", 2},
                   {"solve time", "s", 3},
                   {"G_t", "-", 2}});
      for (const Candidate &candidate : candidates)
        {
          const ReducedBasis &b = candidate.basis;
          // A Gram matrix can be singular to rounding: its condition is then not a number to be printed.
          table.add_row({candidate.name, basis_columns(candidate.kind), candidate.truncation, static_cast<long>(b.n_r0),
                         static_cast<long>(b.n_nominal), static_cast<long>(candidate.n_r), static_cast<long>(b.n_dropped), b.tolerance,
                         std::isfinite(b.condition) ? Cell(b.condition) : Cell(), b.orthonormality, static_cast<long>(b.connection.rank),
                         b.connection.smallest_kept, b.connection.largest_dropped, static_cast<double>(n) / candidate.n_r, candidate.build_seconds,
                         candidate.solve_seconds, full_seconds / (candidate.build_seconds + candidate.solve_seconds)});
        }
      return table;
    }

    Table mode_table(const std::vector<Candidate> &candidates, const std::vector<std::string> &labels, const std::vector<std::string> &groups)
    {
      Table table({{"basis", ""},
                   {"component modes", ""},
                   {"label", ""},
                   {"group", ""},
                   {"frequency", "Hz", 3},
                   {"divergence rate", "%", 4},
                   {"error bar of frequency", "Hz", 1, true},
                   {"error bar of divergence rate", "%", 1, true},
                   {"verdict", ""},
                   {"reference frequency", "Hz", 3},
                   {"reference divergence rate", "%", 4},
                   {"eps_res", "-", 1, true},
                   {"eps_mac", "-", 1, true},
                   {"eps_frq", "-", 1, true},
                   {"eps_div", "-", 1, true},
                   {"error of lambda", "-", 1, true},
                   {"estimated error of lambda", "-", 1, true},
                   {"error of corrected lambda", "-", 1, true},
                   {"condition", "-", 1, true},
                   {"estimate claimed", ""},
                   {"cluster", "-"},
                   {"subspace", "-", 1, true}});
      for (const Candidate &candidate : candidates)
        for (std::size_t j = 0; j < labels.size(); ++j)
          {
            const ModeError      &e    = candidate.errors[j];
            const ModalQuantities mode = modal_quantities(e.reduced), reference = modal_quantities(e.reference), better = modal_quantities(e.corrected);
            table.add_row({candidate.name, candidate.truncation, labels[j], groups[j], mode.frequency, 100. * mode.divergence_rate,
                           std::abs(better.frequency - mode.frequency), 100. * std::abs(better.divergence_rate - mode.divergence_rate),
                           to_string(e.verdict), reference.frequency, 100. * reference.divergence_rate, e.residual, e.shape, e.frequency,
                           e.divergence, e.eigenvalue, e.estimated_error, e.corrected_error, std::isfinite(e.condition) ? Cell(e.condition) : Cell(),
                           std::string(e.claimed ? "yes" : "no"), static_cast<long>(e.cluster_size), e.subspace});
          }
      return table;
    }

    /// How far the estimates are to be trusted: they know nothing of the reference.
    Table estimate_table(const std::vector<Candidate> &candidates, const std::vector<bool> &unstable)
    {
      Table table({{"basis", ""},
                   {"component modes", ""},
                   {"modes", "-"},
                   {"claimed", "-"},
                   {"judged", "-"},
                   {"median ratio to the true error", "-", 2},
                   {"within a factor of 3", "%", 0},
                   {"median gain of the correction", "-", 1},
                   {"undecided", "-"},
                   {"wrong verdicts", "-"}});
      for (const Candidate &candidate : candidates)
        {
          std::vector<double> ratios, gains;
          long                n_claimed = 0, n_good = 0, n_undecided = 0, n_wrong = 0;
          for (std::size_t j = 0; j < candidate.errors.size(); ++j)
            {
              const ModeError &e = candidate.errors[j];
              n_undecided += e.verdict == Verdict::undecided;
              n_wrong += e.verdict == (unstable[j] ? Verdict::stable : Verdict::unstable);
              n_claimed += e.claimed;
              if (!e.claimed || !(e.eigenvalue > reference_accuracy))
                continue;
              ratios.push_back(e.estimate_ratio);
              n_good += e.estimate_ratio > 1. / good_factor && e.estimate_ratio < good_factor;
              if (e.corrected_error > 0.)
                gains.push_back(e.eigenvalue / e.corrected_error);
            }
          const auto median = [](std::vector<double> values) {
            if (values.empty())
              return Cell();
            std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
            return Cell(values[values.size() / 2]);
          };
          table.add_row({candidate.name, candidate.truncation, static_cast<long>(candidate.errors.size()), n_claimed,
                         static_cast<long>(ratios.size()), median(ratios), ratios.empty() ? Cell() : Cell(100. * n_good / ratios.size()), median(gains), n_undecided, n_wrong});
        }
      return table;
    }

    // ------------------------------------------------------ parameters in use

    /// Whether a basis is measured for which @p fits holds.
    bool measures(const Parameters &p, bool (*fits)(BasisKind))
    {
      const auto &names = p.reduction.bases;
      return std::any_of(EnumTable<BasisKind>::names.begin(), EnumTable<BasisKind>::names.end(), [&](const auto &entry) {
        const bool is_chosen = names.empty() ? p.has_friction() || !needs_friction(entry.value) :
                                               std::find(names.begin(), names.end(), entry.name) != names.end();
        return is_chosen && fits(entry.value);
      });
    }

    bool has_real_modes(const BasisKind kind)
    {
      const auto parts = basis_parts(kind);
      return std::find(parts.begin(), parts.end(), BasisPart::real) != parts.end();
    }

    bool is_grown(const BasisKind kind)
    {
      return kind == BasisKind::residual_grown;
    }

    bool is_pod(const BasisKind kind)
    {
      return kind == BasisKind::pod;
    }

    Reason no_snapshots(const Parameters &p)
    {
      return unless(measures(p, is_pod), "the basis POD is not measured");
    }

    Reason no_krylov(const Parameters &p)
    {
      return unless(measures(p, is_pod) || p.solves_by(ComplexSolver::krylov), "of the solver Krylov");
    }
  } // namespace

  /**
   * `Study = reduction`: reduced bases measured against full-order modes, those
   * of Tables 2, 4 and 5 of the paper and better ones: sizes, rank decisions,
   * errors by groups of modes, error estimates with their verdicts, and what
   * building and solving cost.
   */
  static void run_reduction_study(Run &run)
  {
    const Parameters          &parameters = run.parameters;
    const ReductionParameters &reduction  = parameters.reduction;
    const OperationParameters &operation  = parameters.operation;
    const bool                 friction   = reduction.problem == ReductionProblem::friction;
    const double               mu         = friction ? operation.friction_coefficient : 0.;
    const double               omega_max  = circular_frequency(parameters.discretization.maximum_frequency);
    const bool has_damping = operation.radial_dissipation != RadialDissipation::none || operation.friction_slope != 0. ||
                             parameters.materials.disc.is_damped() || parameters.materials.pin.is_damped();
    const std::vector<BasisKind> kinds = chosen_kinds(parameters, has_damping);

    // -------------------------------------------------------- full-order modes
    Scene scene = mesh_scene(run);
    if (run.is_dry)
      {
        run.progress.note("  dry run: nothing was computed or written");
        return;
      }
    Linearisation           linearisation = linearised_scene(scene, run);
    const FrictionlessModes frictionless  = frictionless_modes(scene, linearisation, run);
    add_modal_damping(frictionless, parameters, linearisation);
    const CoupledSystem  &coupled = linearisation.coupled;
    const CoupledSystem   system  = friction ? coupled : undamped(coupled);
    const UpdatedInverse &inverse = *frictionless.inverse;
    const int             n_rigid = frictionless.real.n_rigid_body;

    ComplexModes             reference;
    std::vector<std::string> labels, groups;
    std::vector<bool>        unstable;
    double                   full_seconds = step_seconds(run, "Factorisation");
    if (friction)
      {
        FrictionModes full = friction_modes(scene, linearisation, frictionless, mu, run);
        reference          = full.modes;
        labels             = full.labels;
        unstable           = full.unstable;
        groups             = friction_groups(labels, unstable);
        full_seconds += step_seconds(run, "Complex modes");
      }
    else
      {
        reference = undamped_modes(frictionless.real);
        labels.assign(frictionless.labels.begin() + n_rigid, frictionless.labels.end());
        unstable.assign(labels.size(), false);
        groups = frictionless_groups(labels);
        full_seconds += step_seconds(run, "Real modes");
      }

    // ------------------------------------------------------------- ingredients
    Larder larder;
    larder.book("factor of K_c", step_seconds(run, "Factorisation"));
    larder.book("real modes", step_seconds(run, "Real modes"));
    const auto uses = [&](const BasisPart part) {
      return std::any_of(kinds.begin(), kinds.end(), [&](const BasisKind kind) {
        const auto parts = basis_parts(kind);
        return std::find(parts.begin(), parts.end(), part) != parts.end();
      });
    };

    BasisIngredients ingredients;
    ingredients.uncoupled            = &scene.system;
    ingredients.contact              = &linearisation.contact;
    ingredients.coupled              = &system;
    ingredients.inverse              = &inverse;
    ingredients.friction_coefficient = mu;

    // Real coupled modes, to another frequency where that is asked for
    std::shared_ptr<MultiVector> real = frictionless.real.vectors;
    if (reduction.coupled_frequency > 0.)
      {
        run.progress.begin("Real modes for bases");
        const double          omega = circular_frequency(reduction.coupled_frequency);
        SymmetricModesOptions options;
        options.solver    = parameters.solvers.real_solver;
        options.tolerance = parameters.solvers.real_tolerance;
        options.library   = parameters.solvers.library;
        options.what      = "real modes of the coupled system for reduced bases";
        options.shift     = frictionless.shift * frictionless.shift;
        const SymmetricModes modes =
          larder.compute("real modes", [&] { return symmetric_modes(*coupled.stiffness, *coupled.mass, omega * omega, options); });
        if (modes.eigenvalues.empty())
          throw SolverError("no mode of the coupled system lies below " + text(reduction.coupled_frequency) + " Hz",
                            "parameter Reduction/Coupled frequency", "raise it, or give 0 for the modes of the band");
        real = modes.vectors;
        run.progress.finish(text(real->NumVectors(), " below ", reduction.coupled_frequency, " Hz"));
      }
    ingredients.real = real.get();

    run.progress.begin("Static modes");
    const auto response = larder.compute("factor of K", [&] {
      return std::make_unique<StaticResponse>(*scene.model, scene.system, omega_max, parameters.solvers.library);
    });
    const StaticModes static_modes(*scene.model, linearisation.interface, linearisation.contact, scene.system, *response, omega_max,
                                   parameters.solvers.library);
    ingredients.static_modes = &static_modes;
    if (uses(BasisPart::normal_attachment) || uses(BasisPart::normal_attachment_disc) || uses(BasisPart::rubbing_attachment))
      larder.compute("normal attachment", [&] { return static_modes.normal_attachment().NumVectors(); });
    if (uses(BasisPart::tangential_attachment) || uses(BasisPart::rubbing_attachment))
      larder.compute("tangential attachment", [&] { return static_modes.tangential_attachment().NumVectors(); });
    if (uses(BasisPart::constraint_disc))
      larder.compute("constraint disc", [&] { return static_modes.constraint(Component::disc).NumVectors(); });
    if (uses(BasisPart::constraint_pins))
      larder.compute("constraint pins", [&] { return static_modes.constraint(Component::pins).NumVectors(); });
    run.progress.finish(text(static_modes.n_contact(), " contact nodes"));

    std::unique_ptr<MultiVector> snapshots;
    if (uses(BasisPart::snapshots))
      {
        run.progress.begin("Snapshots");
        std::vector<MultiVector> parts;
        larder.compute("snapshots", [&] {
          for (const double value : reduction.snapshots)
            {
              run.progress.update(text("mu = ", value));
              const ComplexModes modes = krylov_modes(coupled, *frictionless.inverse, frictionless.shift, value, omega_max,
                                                      frictionless.real.eigenvalues.size(), parameters.solvers, run.progress);
              parts.push_back(*modes.real_part);
              parts.push_back(*modes.imaginary_part);
            }
          return 0;
        });
        std::vector<const MultiVector *> pointers;
        for (const MultiVector &part : parts)
          pointers.push_back(&part);
        if (pointers.empty())
          throw ParameterError("the basis POD has no snapshots", "parameter Reduction/Snapshots", "give at least one friction coefficient");
        snapshots             = std::make_unique<MultiVector>(join(pointers));
        ingredients.snapshots = snapshots.get();
        run.progress.finish(text(snapshots->NumVectors(), " vectors from ", reduction.snapshots.size(), " friction coefficients"));
      }

    // ------------------------------------------------------------------- bases
    std::vector<Candidate> candidates;
    BasisOptions           options;
    options.tolerance     = reduction.rank_tolerance;
    options.pod_tolerance = reduction.pod_tolerance;
    const auto measure    = [&](const BasisKind kind, const std::string &name, const std::string &truncation) {
      run.progress.begin(name);
      Stopwatch watch;
      Candidate candidate{kind, name, truncation, reduced_basis(kind, ingredients, options)};
      ReducedModel model(system);
      model.extend(*candidate.basis.vectors);
      candidate.build_seconds = larder.cost(kind, name) + watch.seconds();
      ReducedModes modes;
      for (int solution = 0; solution < n_timed_solutions; ++solution)
        {
          const Stopwatch solving;
          modes                   = friction ? reduced_modes(model, mu, omega_max, BandEnd::open) : reduced_real_modes(model, omega_max, BandEnd::open);
          const double seconds    = solving.seconds();
          candidate.solve_seconds = solution == 0 ? seconds : std::min(candidate.solve_seconds, seconds);
        }
      candidate.errors = reduction_errors(system, inverse, model, modes, reference);
      double largest   = 0.;
      for (const ModeError &e : candidate.errors)
        largest = std::max(largest, e.eigenvalue);
      run.progress.finish(text(candidate.basis.n_r0, " vectors, ", candidate.basis.size(), " after connection and rank, largest error of lambda ", largest));
      // Hundreds of vectors each: they are not needed any more
      candidate.n_r = candidate.basis.size();
      candidate.basis.vectors.reset();
      candidates.push_back(std::move(candidate));
    };

    const bool any_component = std::any_of(kinds.begin(), kinds.end(), is_connected);
    for (const ModeTruncation &truncation : reduction.truncations)
      if (any_component)
        {
          const auto part = [&](const char *name, const Component component, const ContactBoundary boundary, const int count) {
            return larder.compute(name, [&] {
              const double frequency = truncation.frequency > 0. ? truncation.frequency : parameters.discretization.maximum_frequency;
              return lowest_modes(scene, linearisation, component, boundary, frequency, count, frictionless.shift, run);
            });
          };
          run.progress.begin("Component modes for bases");
          ComponentSets sets;
          // The disc has as many sliding as free modes in a basis (Table 3)
          if (uses(BasisPart::disc_free) || uses(BasisPart::disc_sliding))
            sets.disc_free = part("disc free", Component::disc, ContactBoundary::free, truncation.disc);
          if (uses(BasisPart::disc_sliding))
            sets.disc_sliding = part("disc sliding", Component::disc, ContactBoundary::sliding, sets.disc_free->NumVectors());
          if (uses(BasisPart::pins_free))
            sets.pins_free = part("pins free", Component::pins, ContactBoundary::free, truncation.pins_free);
          if (uses(BasisPart::pins_sliding))
            sets.pins_sliding = part("pins sliding", Component::pins, ContactBoundary::sliding, truncation.pins_sliding);
          const auto number = [](const std::unique_ptr<MultiVector> &set) { return set ? std::to_string(set->NumVectors()) : "-"; };
          run.progress.finish(truncation.text() + ": disc " + number(sets.disc_free) + ", pins free " + number(sets.pins_free) + ", pins sliding " +
                              number(sets.pins_sliding));
          ingredients.disc_free    = sets.disc_free.get();
          ingredients.disc_sliding = sets.disc_sliding.get();
          ingredients.pins_free    = sets.pins_free.get();
          ingredients.pins_sliding = sets.pins_sliding.get();
          for (const BasisKind kind : kinds)
            if (is_connected(kind))
              measure(kind, to_string(kind), truncation.text());
        }
    for (const BasisKind kind : kinds)
      if (kind == BasisKind::residual_grown)
        for (const double tolerance : reduction.grown_tolerances)
          {
            const std::string name = text("residual-grown ", tolerance);
            run.progress.begin("Growing a basis");
            ResidualIterationOptions iteration;
            iteration.largest_frequency = omega_max;
            iteration.tolerance         = tolerance;
            iteration.maximum_basis     = parameters.solvers.maximum_basis;
            const auto grown            = larder.compute(name, [&] {
              return std::make_unique<MultiVector>(
                grow_residual_basis(system, inverse, *frictionless.real.vectors, {mu}, iteration, run.progress).model.basis());
            });
            run.progress.finish(text(grown->NumVectors(), " vectors for an estimated error of ", tolerance));
            ingredients.residuals = grown.get();
            measure(kind, name, "");
          }
      else if (!is_connected(kind))
        measure(kind, to_string(kind), "");

    // ----------------------------------------------------------------- results
    run.write_table("reduction_bases", basis_table(candidates, coupled.map().NumGlobalElements(), full_seconds));
    run.write_table("reduction_errors", error_table(candidates, groups));
    run.write_table("reduction_estimates", estimate_table(candidates, unstable));
    run.store_table("reduction_modes", mode_table(candidates, labels, groups));
    run.screen << '\n';
    run.progress.note(text("  full order: ", full_seconds, " s of CPU for ", labels.size(), " modes"));
    run.finish();
  }

  extern const Study reduction_study = [] {
    Study study{"reduction", run_reduction_study, {"Reduction/"}};
    study.rules = {
      {"Operation/Rotation speed", no_sliding_speed},
      {"Reduction/Component modes", [](const Parameters &p) { return unless(measures(p, is_connected), "no basis of component modes is measured"); }},
      {"Reduction/Coupled frequency", [](const Parameters &p) { return unless(measures(p, has_real_modes), "no basis of real modes is measured"); }},
      {"Reduction/Grown tolerances", [](const Parameters &p) { return unless(measures(p, is_grown), "no residual-grown basis is measured"); }},
      {"Reduction/Snapshots", no_snapshots},
      {"Reduction/POD tolerance", no_snapshots},
      {"Complex modes/Shift inverse", no_krylov},
      {"Complex modes/Tolerance", no_krylov},
      {"Complex modes/Maximum basis", [](const Parameters &p) {
         return unless(measures(p, is_grown) || p.solves_by(ComplexSolver::residual_iteration), "of the solver residual iteration");
       }}};
    study.no_mode_shapes = [](const Parameters &) { return "the study writes no mode shapes"; };
    study.has_friction   = [](const Parameters &p) { return p.reduction.problem == ReductionProblem::friction; };
    return study;
  }();
} // namespace Squeal
