#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/estimates/residual_iteration.h>
#include <squeal/modes/krylov_modes.h>
#include <squeal/studies/reduction_sets.h>

#include <algorithm>
#include <functional>

namespace Squeal
{
  ReductionSets::ReductionSets(const ReductionPlan &plan, const FrictionlessModes &frictionless, const CoupledSystem &system, Run &run)
    : plan(plan)
    , frictionless(frictionless)
    , system(system)
    , run(run)
    , scene(*frictionless.linearisation.scene)
    , linearisation(frictionless.linearisation)
  {
    seconds[BasisSource::coupled_factor] = frictionless.factorisation.cpu_seconds;
    seconds[BasisSource::real]           = frictionless.solution.cpu_seconds;
    available.uncoupled                  = &scene.system;
    available.contact                    = &linearisation.contact;
    available.coupled                    = &system;
    available.inverse                    = frictionless.inverse.get();
    available.friction_coefficient       = plan.friction_coefficient;
    available.sets[BasisSource::real]    = frictionless.real.vectors.get();
    if (run.parameters.reduction.coupled_frequency > 0.)
      compute_real_modes();
    compute_static_modes();
    if (plan.rests_on(BasisSource::snapshots))
      compute_snapshots();
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
  auto ReductionSets::timed(const BasisSource source, Function &&function)
  {
    const Stopwatch watch;
    auto            result = function();
    seconds[source]        = watch.cost().cpu_seconds;
    return result;
  }

  template <typename Function>
  int ReductionSets::compute(const BasisSource source, Function &&function)
  {
    vectors[source].reset();
    vectors[source]        = std::make_unique<MultiVector>(timed(source, function));
    available.sets[source] = vectors[source].get();
    return vectors[source]->n_columns();
  }

  // ------------------------------------------------------------- for all bases

  void ReductionSets::compute_real_modes()
  {
    run.progress.begin("Real modes for bases");
    const double                frequency = run.parameters.reduction.coupled_frequency, omega = circular_frequency(frequency);
    const CoupledSystem        &coupled = linearisation.coupled;
    const SymmetricModesOptions options =
      real_modes_options(run.parameters.solvers, "real modes of the coupled system for reduced bases", frictionless.shift);
    const int n = compute(BasisSource::real, [&] {
      const SymmetricModes modes = symmetric_modes(*coupled.stiffness, *coupled.mass, omega * omega, options);
      if (modes.eigenvalues.empty())
        throw SolverError("no mode of the coupled system lies below " + text(frequency) + " Hz", "parameter Reduction/Coupled frequency",
                          "raise it, or give 0 for the modes of the band");
      return *modes.vectors;
    });
    run.progress.finish(text(n, " below ", frequency, " Hz"));
  }

  void ReductionSets::compute_static_modes()
  {
    run.progress.begin("Static modes");
    const FactorizationLibrary library = run.parameters.solvers.library;
    response                           = timed(BasisSource::uncoupled_factor, [&] {
      return std::make_unique<InertiaRelief>(static_response(*scene.model, scene.system, plan.largest_circular_frequency, library));
    });
    static_modes = std::make_unique<StaticModes>(*scene.model, linearisation.interface, linearisation.contact, scene.system, *response,
                                                 plan.largest_circular_frequency, library);
    const StaticModes                                 &modes  = *static_modes;
    const std::pair<BasisSource, std::function<int()>> sets[] = {
      {BasisSource::normal_attachment, [&] { return modes.normal_attachment().n_columns(); }},
      {BasisSource::tangential_attachment, [&] { return modes.tangential_attachment().n_columns(); }},
      {BasisSource::constraint_disc, [&] { return modes.constraint(Component::disc).n_columns(); }},
      {BasisSource::constraint_pins, [&] { return modes.constraint(Component::pins).n_columns(); }}};
    for (const auto &[source, set] : sets)
      if (plan.rests_on(source))
        timed(source, set);
    available.static_modes = static_modes.get();
    run.progress.finish(text(modes.n_contact(), " contact nodes"));
  }

  void ReductionSets::compute_snapshots()
  {
    run.progress.begin("Snapshots");
    const std::vector<double> &values = run.parameters.reduction.snapshots;
    const int                  n      = compute(BasisSource::snapshots, [&] {
      std::vector<ComplexModes>        sets;
      std::vector<const MultiVector *> parts;
      for (const double value : values)
        {
          run.progress.update(text("mu = ", value));
          sets.push_back(krylov_modes(linearisation.coupled, *frictionless.inverse, frictionless.shift, value,
                                                            plan.largest_circular_frequency, frictionless.real.eigenvalues.size(), run.parameters.solvers,
                                                            run.progress));
          for (const auto &part : {sets.back().real_part, sets.back().imaginary_part})
            parts.push_back(part.get());
        }
      return join(parts);
    });
    run.progress.finish(text(n, " vectors from ", values.size(), " friction coefficients"));
  }

  // ------------------------------------------------------------- for some bases

  void ReductionSets::truncate(const ModeTruncation &truncation)
  {
    run.progress.begin("Component modes for bases");
    const double frequency = truncation.frequency > 0. ? truncation.frequency : run.parameters.discretization.maximum_frequency;
    std::map<BasisSource, int> n;
    const auto compute_if = [&](const bool is_used, const BasisSource source, const Component component, const ContactBoundary boundary,
                                const int count) {
      if (is_used)
        n[source] = compute(source, [&] { return lowest_modes(component, boundary, frequency, count); });
    };
    // The disc has as many sliding as free modes in a basis (Table 3)
    using Source      = BasisSource;
    const bool slides = plan.rests_on(Source::disc_sliding);
    compute_if(slides || plan.rests_on(Source::disc_free), Source::disc_free, Component::disc, ContactBoundary::free, truncation.disc);
    compute_if(slides, Source::disc_sliding, Component::disc, ContactBoundary::sliding, n[Source::disc_free]);
    compute_if(plan.rests_on(Source::pins_free), Source::pins_free, Component::pins, ContactBoundary::free, truncation.pins_free);
    compute_if(plan.rests_on(Source::pins_sliding), Source::pins_sliding, Component::pins, ContactBoundary::sliding,
               truncation.pins_sliding);
    const auto number = [&](const Source source) { return n[source] > 0 ? std::to_string(n[source]) : "-"; };
    run.progress.finish(truncation.text() + ": disc " + number(Source::disc_free) + ", pins free " + number(Source::pins_free) +
                        ", pins sliding " + number(Source::pins_sliding));
  }

  void ReductionSets::grow(const double tolerance)
  {
    run.progress.begin("Growing a basis");
    ResidualIterationOptions iteration;
    iteration.largest_circular_frequency = plan.largest_circular_frequency;
    iteration.tolerance                  = tolerance;
    iteration.maximum_basis              = run.parameters.solvers.maximum_basis;
    const int n                          = compute(BasisSource::residuals, [&] {
      return grow_residual_basis(system, *frictionless.inverse, *frictionless.real.vectors, {plan.friction_coefficient}, iteration,
                                                          run.progress)
        .model.basis();
    });
    run.progress.finish(text(n, " vectors for an estimated error of ", tolerance));
  }

  MultiVector ReductionSets::lowest_modes(const Component       component,
                                          const ContactBoundary boundary,
                                          const double          frequency,
                                          const int             count) const
  {
    const bool            is_disc = component == Component::disc;
    const std::string     what    = std::string("modes of the ") + (is_disc ? "disc" : "pins") + " for reduced bases";
    SymmetricModesOptions options = real_modes_options(run.parameters.solvers, what, is_disc ? frictionless.shift : 0.);
    if (!is_disc)
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
          throw SolverError(what + ": none lies below " + text(frequency) + " Hz", "parameter Reduction/Component modes",
                            "raise the truncation frequency");
        if (count == 0 || found >= count)
          {
            const MultiVector lowest = view(*modes.vectors, 0, count == 0 ? found : count);
            return MultiVector(lowest); // a copy: the modes go
          }
      }
    throw SolverError(what + ": fewer than " + std::to_string(count) + " lie below " + text(band) + " Hz",
                      "parameter Reduction/Component modes", "lower the number of modes");
  }
} // namespace Squeal
