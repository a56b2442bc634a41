#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/stability/krylov_modes.h>
#include <squeal/stability/residual_iteration.h>
#include <squeal/studies/reduction_sets.h>

#include <algorithm>
#include <functional>

namespace Squeal
{
  ReductionSets::ReductionSets(const ReductionPlan     &plan,
                               const Scene             &scene,
                               const Linearisation     &linearisation,
                               const FrictionlessModes &frictionless,
                               const CoupledSystem     &system,
                               Run                     &run)
    : plan(plan)
    , scene(scene)
    , linearisation(linearisation)
    , frictionless(frictionless)
    , system(system)
    , run(run)
  {
    seconds[BasisSource::coupled_factor] = frictionless.factorisation.cpu_seconds;
    seconds[BasisSource::real]           = frictionless.solution.cpu_seconds;
    available.uncoupled                  = &scene.system;
    available.contact                    = &linearisation.contact;
    available.coupled                    = &system;
    available.inverse                    = frictionless.inverse.get();
    available.friction_coefficient       = plan.friction_coefficient;
    compute_real_modes();
    compute_static_modes();
    if (plan.rests_on(BasisSource::snapshots))
      compute_snapshots();
  }

  const BasisIngredients &ReductionSets::ingredients() const
  {
    return available;
  }

  double ReductionSets::cost(const BasisRecipe &recipe) const
  {
    double sum = 0.;
    for (const auto &[source, cost] : seconds)
      if (recipe.rests_on(source))
        sum += cost;
    return sum;
  }

  template <typename Function>
  auto ReductionSets::compute(const BasisSource source, Function &&function)
  {
    const Stopwatch watch;
    auto            result = function();
    seconds[source]        = watch.cost().cpu_seconds;
    return result;
  }

  // ------------------------------------------------------------- for all bases

  void ReductionSets::compute_real_modes()
  {
    const double frequency = run.parameters.reduction.coupled_frequency;
    real                   = frictionless.real.vectors;
    if (frequency > 0.)
      {
        run.progress.begin("Real modes for bases");
        const double            omega   = circular_frequency(frequency);
        const CoupledSystem    &coupled = linearisation.coupled;
        const SolverParameters &solvers = run.parameters.solvers;
        SymmetricModesOptions   options;
        options.solver    = solvers.real_solver;
        options.tolerance = solvers.real_tolerance;
        options.library   = solvers.library;
        options.what      = "real modes of the coupled system for reduced bases";
        options.shift     = frictionless.shift * frictionless.shift;
        const SymmetricModes modes =
          compute(BasisSource::real, [&] { return symmetric_modes(*coupled.stiffness, *coupled.mass, omega * omega, options); });
        if (modes.eigenvalues.empty())
          throw SolverError("no mode of the coupled system lies below " + text(frequency) + " Hz", "parameter Reduction/Coupled frequency",
                            "raise it, or give 0 for the modes of the band");
        real = modes.vectors;
        run.progress.finish(text(real->NumVectors(), " below ", frequency, " Hz"));
      }
    available.real = real.get();
  }

  void ReductionSets::compute_static_modes()
  {
    run.progress.begin("Static modes");
    const FactorizationLibrary library = run.parameters.solvers.library;
    response                           = compute(BasisSource::uncoupled_factor, [&] {
      return std::make_unique<StaticResponse>(*scene.model, scene.system, plan.largest_circular_frequency, library);
    });
    static_modes = std::make_unique<StaticModes>(*scene.model, linearisation.interface, linearisation.contact, scene.system, *response,
                                                 plan.largest_circular_frequency, library);
    const StaticModes                                 &modes  = *static_modes;
    const std::pair<BasisSource, std::function<int()>> sets[] = {
      {BasisSource::normal_attachment, [&] { return modes.normal_attachment().NumVectors(); }},
      {BasisSource::tangential_attachment, [&] { return modes.tangential_attachment().NumVectors(); }},
      {BasisSource::constraint_disc, [&] { return modes.constraint(Component::disc).NumVectors(); }},
      {BasisSource::constraint_pins, [&] { return modes.constraint(Component::pins).NumVectors(); }}};
    for (const auto &[source, set] : sets)
      if (plan.rests_on(source))
        compute(source, set);
    available.static_modes = static_modes.get();
    run.progress.finish(text(modes.n_contact(), " contact nodes"));
  }

  void ReductionSets::compute_snapshots()
  {
    run.progress.begin("Snapshots");
    const std::vector<double>       &values = run.parameters.reduction.snapshots;
    const auto                       parts  = compute(BasisSource::snapshots, [&] {
      std::vector<MultiVector> result;
      for (const double value : values)
        {
          run.progress.update(text("mu = ", value));
          const ComplexModes modes =
            krylov_modes(linearisation.coupled, *frictionless.inverse, frictionless.shift, value, plan.largest_circular_frequency,
                                                frictionless.real.eigenvalues.size(), run.parameters.solvers, run.progress);
          result.push_back(*modes.real_part);
          result.push_back(*modes.imaginary_part);
        }
      return result;
    });
    std::vector<const MultiVector *> pointers;
    for (const MultiVector &part : parts)
      pointers.push_back(&part);
    snapshots           = std::make_unique<MultiVector>(join(pointers));
    available.snapshots = snapshots.get();
    run.progress.finish(text(snapshots->NumVectors(), " vectors from ", values.size(), " friction coefficients"));
  }

  // ------------------------------------------------------------- for some bases

  void ReductionSets::truncate(const ModeTruncation &truncation)
  {
    run.progress.begin("Component modes for bases");
    for (auto *set : {&disc_free, &disc_sliding, &pins_free, &pins_sliding})
      set->reset();
    const double frequency = truncation.frequency > 0. ? truncation.frequency : run.parameters.discretization.maximum_frequency;
    const auto   set       = [&](const BasisSource source, const Component component, const ContactBoundary boundary, const int count) {
      return compute(source, [&] { return lowest_modes(component, boundary, frequency, count); });
    };
    // The disc has as many sliding as free modes in a basis (Table 3)
    const bool slides = plan.rests_on(BasisSource::disc_sliding);
    if (plan.rests_on(BasisSource::disc_free) || slides)
      disc_free = set(BasisSource::disc_free, Component::disc, ContactBoundary::free, truncation.disc);
    if (slides)
      disc_sliding = set(BasisSource::disc_sliding, Component::disc, ContactBoundary::sliding, disc_free->NumVectors());
    if (plan.rests_on(BasisSource::pins_free))
      pins_free = set(BasisSource::pins_free, Component::pins, ContactBoundary::free, truncation.pins_free);
    if (plan.rests_on(BasisSource::pins_sliding))
      pins_sliding = set(BasisSource::pins_sliding, Component::pins, ContactBoundary::sliding, truncation.pins_sliding);
    available.disc_free    = disc_free.get();
    available.disc_sliding = disc_sliding.get();
    available.pins_free    = pins_free.get();
    available.pins_sliding = pins_sliding.get();
    const auto number      = [](const std::unique_ptr<MultiVector> &modes) { return modes ? std::to_string(modes->NumVectors()) : "-"; };
    run.progress.finish(truncation.text() + ": disc " + number(disc_free) + ", pins free " + number(pins_free) + ", pins sliding " +
                        number(pins_sliding));
  }

  void ReductionSets::grow(const double tolerance)
  {
    run.progress.begin("Growing a basis");
    ResidualIterationOptions iteration;
    iteration.largest_frequency = plan.largest_circular_frequency;
    iteration.tolerance         = tolerance;
    iteration.maximum_basis     = run.parameters.solvers.maximum_basis;
    residuals                   = compute(BasisSource::residuals, [&] {
      const auto grown = grow_residual_basis(system, *frictionless.inverse, *frictionless.real.vectors, {plan.friction_coefficient},
                                                               iteration, run.progress);
      return std::make_unique<MultiVector>(grown.model.basis());
    });
    available.residuals         = residuals.get();
    run.progress.finish(text(residuals->NumVectors(), " vectors for an estimated error of ", tolerance));
  }

  std::unique_ptr<MultiVector> ReductionSets::lowest_modes(const Component       component,
                                                           const ContactBoundary boundary,
                                                           const double          frequency,
                                                           const int             count) const
  {
    SymmetricModesOptions options;
    options.solver    = run.parameters.solvers.real_solver;
    options.tolerance = run.parameters.solvers.real_tolerance;
    options.library   = run.parameters.solvers.library;
    options.what      = std::string("modes of the ") + (component == Component::disc ? "disc" : "pins") + " for reduced bases";
    options.shift     = component == Component::disc ? frictionless.shift * frictionless.shift : 0.;
    if (component == Component::pins)
      options.block_size = std::max<int>(8, 2 * scene.n_pins());

    // Numbers of modes are met by a band that grows
    constexpr double growth   = 1.25;
    constexpr int    attempts = 12;
    double           band     = frequency;
    for (int attempt = 0; attempt < attempts; ++attempt, band *= growth)
      {
        const double         omega = circular_frequency(band);
        const ComponentModes modes = component_modes(*scene.model, scene.interface, linearisation.interface, scene.system, component,
                                                     boundary, omega * omega, options);
        const int            found = modes.eigenvalues.size();
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
} // namespace Squeal
