// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/estimates/residual_iteration.h>
#include <squeal/studies/steps/parameter_usage.h>
#include <squeal/studies/steps/reduction_sets.h>

#include <boost/algorithm/string/join.hpp>

namespace Squeal
{
  namespace
  {
    /// Properties of the eigenproblem that decide which bases apply.
    struct Problem
    {
      explicit Problem(const Parameters &p)
        : has_friction(p.has_friction())
        , has_damping(p.system || p.operation.radial_dissipation != RadialDissipation::none || p.operation.friction_slope != 0. ||
                      p.materials.is_damped())
        , has_contact_nodes(!p.system)
      {}

      bool has_friction, has_damping, has_contact_nodes, has_snapshots = true, has_definite_part = true;
    };

    bool fits(const BasisRecipe &recipe, const Problem &problem)
    {
      return (problem.has_friction || !recipe.needs_friction) && (problem.has_damping || !recipe.needs_damping) &&
             (problem.has_contact_nodes || !recipe.needs_contact_nodes()) && (problem.has_snapshots || !recipe.is_pod) &&
             (problem.has_definite_part || recipe.is_pod);
    }

    /// Bases named in the parameters; if none is named, all bases that fit the eigenproblem.
    std::vector<const BasisRecipe *> chosen_recipes(const Parameters &p, const Problem &problem)
    {
      const std::vector<std::string>  &names = p.reduction.bases;
      std::vector<const BasisRecipe *> result;
      for (const BasisRecipe &recipe : basis_recipes())
        if (names.empty() ? fits(recipe, problem) : std::find(names.begin(), names.end(), recipe.name) != names.end())
          result.push_back(&recipe);
      return result;
    }

    void refuse_unknown(const std::vector<std::string> &names)
    {
      std::vector<std::string> known;
      for (const BasisRecipe &recipe : basis_recipes())
        known.emplace_back(recipe.name);
      for (const std::string &name : names)
        if (find_recipe(name) == nullptr)
          throw ParameterError("there is no basis `" + name + "`", "parameter Reduction/Bases",
                               "choose from " + boost::algorithm::join(known, ", "));
    }

    // ---------------------------------------------------------------- in use

    /// True if a basis of the study satisfies @p fits.
    template <typename Predicate>
    bool measures(const Parameters &p, const Predicate &fits)
    {
      const auto recipes = chosen_recipes(p, Problem(p));
      return std::any_of(recipes.begin(), recipes.end(), [&](const BasisRecipe *recipe) { return fits(*recipe); });
    }

    bool measures(const Parameters &p, const BasisSource source)
    {
      return measures(p, [source](const BasisRecipe &recipe) { return recipe.rests_on(source); });
    }

    const auto no_snapshots = [](const Parameters &p) { return unless(measures(p, BasisSource::snapshots), "only for the basis POD"); };
    const auto no_krylov_for_bases = [](const Parameters &p) {
      return unless(measures(p, BasisSource::snapshots) || p.solves_by(ComplexSolver::krylov),
                    "only for the basis POD or the solver Krylov");
    };

    /// Largest frequency, as a multiple of the truncation frequency, in the search for the requested number of component modes [-].
    constexpr double furthest_band = 16.;
  } // namespace

  bool ReductionPlan::rests_on(const BasisSource source) const
  {
    return std::any_of(recipes.begin(), recipes.end(), [source](const BasisRecipe *recipe) { return recipe->rests_on(source); });
  }

  static ReductionPlan plan_for(const Problem &problem, const Parameters &parameters, const double value)
  {
    refuse_unknown(parameters.reduction.bases);
    ReductionPlan plan;
    plan.recipes                    = chosen_recipes(parameters, problem);
    plan.has_friction               = problem.has_friction;
    plan.friction_coefficient       = value;
    plan.largest_circular_frequency = circular_frequency(parameters.discretization.maximum_frequency);
    const auto refuse               = [](const BasisRecipe &recipe, const std::string &what, const std::string &change) {
      throw ParameterError(text("the basis ", in_quotes(recipe.name), " ", what), "parameter Reduction/Bases", change);
    };
    for (const BasisRecipe *recipe : plan.recipes)
      if (!problem.has_contact_nodes && recipe->needs_contact_nodes())
        refuse(*recipe, "needs contact nodes, but a system file has none", "remove the basis");
      else if (!problem.has_friction && recipe->needs_friction)
        refuse(*recipe, "requires friction", "set Reduction/Problem = friction, or remove the basis");
      else if (!problem.has_damping && recipe->needs_damping)
        refuse(*recipe, "needs damping, but there is none", "add damping, or remove the basis");
      else if (!problem.has_definite_part && !recipe->is_pod)
        refuse(*recipe, "needs real modes, but the system has no definite part", "set it to POD");
    if (plan.rests_on(BasisSource::snapshots) && parameters.reduction.snapshots.empty())
      throw ParameterError("the basis POD has no snapshots", "parameter Reduction/Snapshots", "give at least one value");
    return plan;
  }

  ReductionPlan reduction_plan(const Parameters &parameters)
  {
    ReductionPlan result =
      plan_for(Problem(parameters), parameters, parameters.has_friction() ? parameters.operation.friction_coefficient : 0.);
    const FileParameter mu = friction_parameter(parameters);
    result.parameters      = fixed({mu}, {{mu.name, {result.friction_coefficient}}});
    return result;
  }

  ReductionPlan reduction_plan(const Parameters &parameters, const SystemFile &file, const CoupledSystem &system, const double value)
  {
    const FileParameter *varied = file.find(system.varied);
    Problem              problem(parameters);
    problem.has_damping       = system.has_damping();
    problem.has_definite_part = system.stiffness != nullptr;
    const auto &snapshots     = parameters.reduction.snapshots;
    problem.has_snapshots     = varied != nullptr && std::all_of(snapshots.begin(), snapshots.end(), [&](const double snapshot) {
                              return varied->lower <= snapshot && snapshot <= varied->upper;
                            });
    ReductionPlan plan        = plan_for(problem, parameters, value);
    plan.parameters           = fixed(file.parameters, system.at(value));
    if (!problem.has_snapshots && (plan.rests_on(BasisSource::snapshots) || !problem.has_definite_part))
      throw ParameterError(
        varied == nullptr ? "the basis POD needs a parameter, but the system has none" :
                            text("at least one snapshot is outside the range of ", varied->name, " from ", exact_text(varied->lower),
                                 " to ", exact_text(varied->upper)),
        "parameter Reduction/Snapshots",
        "give values within the range of a parameter of the file or, if the system has a definite part, remove the basis POD");
    return plan;
  }

  std::vector<UsageRule> reduction_usage()
  {
    return {
      {"Operation/Rotation speed", no_sliding_speed},
      {"Reduction/Component modes",
       [](const Parameters &p) {
         const auto is_connected = [](const BasisRecipe &recipe) { return recipe.is_connected(); };
         return unless(measures(p, is_connected), "only for bases of component modes");
       }},
      {"Reduction/Coupled frequency",
       [](const Parameters &p) { return unless(measures(p, std::mem_fn(&BasisRecipe::has_real_modes)), "only for bases of real modes"); }},
      {"Reduction/Grown tolerances",
       [](const Parameters &p) { return unless(measures(p, BasisSource::residuals), "only for residual-grown bases"); }},
      {"Reduction/Snapshots", no_snapshots},
      {"Reduction/POD tolerance", no_snapshots},
      {"Complex modes/Shift inverse", no_krylov_for_bases},
      {"Complex modes/Tolerance", no_krylov_for_bases},
      {"Complex modes/Maximum basis", [](const Parameters &p) {
         return unless(measures(p, BasisSource::residuals) || p.solves_by(ComplexSolver::residual_iteration),
                       "only for residual-grown bases or the solver residual iteration");
       }}};
  }

  ReductionSets::ReductionSets(const ReductionPlan &plan, const FrictionlessModes &frictionless, const CoupledSystem &system, Run &run)
    : plan(plan)
    , frictionless(frictionless)
    , system(system)
    , run(run)
    , linearisation(frictionless.linearisation)
  {
    ingredients.contact              = &linearisation.contact;
    ingredients.coupled              = &system;
    ingredients.inverse              = frictionless.inverse.get();
    ingredients.friction_coefficient = plan.friction_coefficient;
    charge_coupled_factor();
    take_real_modes(0.);
    if (std::any_of(plan.recipes.begin(), plan.recipes.end(), std::mem_fn(&BasisRecipe::is_connected)))
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

  double ReductionSets::full_order_factorisation() const
  {
    return seconds.at(BasisSource::coupled_factor) + (plan.has_friction ? seconds.at(BasisSource::coupled_attachment) : 0.);
  }

  void ReductionSets::book(const Charge &charge)
  {
    seconds[charge.source] = charge.seconds;
    const auto is_same     = [&](const Charge &other) { return other.source == charge.source && other.variant == charge.variant; };
    if (plan.rests_on(charge.source) && std::none_of(charges.begin(), charges.end(), is_same))
      charges.push_back(charge);
  }

  int ReductionSets::keep(Charge charge, MultiVector set)
  {
    const int n      = set.n_columns();
    charge.n_vectors = n;
    book(charge);
    vectors[charge.source]          = std::make_unique<MultiVector>(std::move(set));
    ingredients.sets[charge.source] = vectors[charge.source].get();
    return n;
  }

  // ------------------------------------------------------------- for all bases

  void ReductionSets::charge_coupled_factor()
  {
    // Separate the times of the factor of K_c and of K_c⁻¹ A, because not every basis needs K_c⁻¹ A
    if (system.n_contact() == 0)
      {
        book({BasisSource::coupled_factor, "", {}, {}, {}, frictionless.factorisation.cpu_seconds});
        seconds[BasisSource::coupled_attachment] = 0.;
        return;
      }
    const Stopwatch   watch;
    const MultiVector attachment = frictionless.inverse->solve_frictionless(system.friction_forces->columns(0, system.n_contact()));
    const double      share      = std::min(watch.cost().cpu_seconds, frictionless.factorisation.cpu_seconds);
    book({BasisSource::coupled_factor, "", {}, {}, {}, frictionless.factorisation.cpu_seconds - share});
    book({BasisSource::coupled_attachment, "", attachment.n_columns(), {}, {}, share});
  }

  void ReductionSets::take_real_modes(const double frequency)
  {
    if (frequency == 0.)
      {
        const SymmetricModes &real = frictionless.real;
        const int             n    = real.vectors->n_columns();
        book({BasisSource::real, "", n, run.parameters.discretization.maximum_frequency, n, frictionless.solution.cpu_seconds});
        ingredients.sets[BasisSource::real] = real.vectors.get();
        return;
      }
    run.progress.begin("Real modes for bases");
    const double                omega   = circular_frequency(frequency);
    const CoupledSystem        &coupled = linearisation.coupled;
    const SymmetricModesOptions options =
      real_modes_options(run.parameters.solvers, "real modes of the coupled system for reduced bases", frictionless.shift);
    const Stopwatch      watch;
    const SymmetricModes modes   = symmetric_modes(*coupled.stiffness, *coupled.mass, omega * omega, options);
    const double         seconds = watch.cost().cpu_seconds;
    if (modes.eigenvalues.empty())
      throw SolverError("there are no modes of the coupled system below " + text(frequency) + " Hz",
                        "parameter Reduction/Coupled frequency", "raise it, or give 0 for the modes of the band");
    const int n =
      keep({BasisSource::real, exact_text(frequency) + " Hz", {}, frequency, modes.vectors->n_columns(), seconds}, *modes.vectors);

    run.progress.finish(text(n, " below ", frequency, " Hz"));
  }

  void ReductionSets::compute_static_modes()
  {
    run.progress.begin("Static modes");
    const Scene               &scene   = *linearisation.scene;
    const FactorizationLibrary library = run.parameters.solvers.library;
    ingredients.uncoupled              = &scene.system;
    const Stopwatch of_factor;
    response = std::make_unique<InertiaRelief>(static_response(*scene.model, scene.system, plan.largest_circular_frequency, library));
    book({BasisSource::uncoupled_factor, "", {}, {}, {}, of_factor.cost().cpu_seconds});

    static_modes = std::make_unique<StaticModes>(*scene.model, linearisation.interface, linearisation.contact, scene.system, *response,
                                                 plan.largest_circular_frequency, library);
    const StaticModes &modes = *static_modes;

    using Set                                = std::function<const MultiVector &()>;
    const std::pair<BasisSource, Set> sets[] = {
      {BasisSource::normal_attachment, [&]() -> const MultiVector & { return modes.normal_attachment(); }},
      {BasisSource::tangential_attachment, [&]() -> const MultiVector & { return modes.tangential_attachment(); }},
      {BasisSource::constraint_disc, [&]() -> const MultiVector & { return modes.constraint(Component::disc); }},
      {BasisSource::constraint_pins, [&]() -> const MultiVector & { return modes.constraint(Component::pins); }}};
    for (const auto &[source, set] : sets)
      if (plan.rests_on(source))
        {
          const Stopwatch watch;
          const int       n = set().n_columns();
          book({source, "", n, {}, {}, watch.cost().cpu_seconds});
        }
    ingredients.static_modes = static_modes.get();
    run.progress.finish(counted(linearisation.interface.size(), "contact node"));
  }

  void ReductionSets::compute_snapshots()
  {
    run.progress.begin("Snapshots");
    const std::vector<double>       &values = run.parameters.reduction.snapshots;
    const Stopwatch                  watch;
    std::vector<ComplexModes>        modes;
    std::vector<const MultiVector *> parts;
    for (const double value : values)
      {
        run.progress.update(text(linearisation.coupled.varied, " = ", value));
        modes.push_back(krylov_modes(linearisation.coupled, *frictionless.inverse, frictionless.shift, value,
                                     plan.largest_circular_frequency, frictionless.real.eigenvalues.size(), run.parameters.solvers,
                                     run.progress, frictionless.real.vectors.get()));
        for (const auto &part : {modes.back().real_part, modes.back().imaginary_part})
          parts.push_back(part.get());
      }
    MultiVector set = join(parts);
    const int   n   = keep({BasisSource::snapshots, "", {}, {}, {}, watch.cost().cpu_seconds}, std::move(set));
    run.progress.finish(text(counted(n, "vector"), " from ", counted(values.size(), "value"), " of ", linearisation.coupled.varied));
  }

  // ------------------------------------------------------------- for some bases

  std::map<BasisSource, int> ReductionSets::truncate(const ModeTruncation &truncation)
  {
    run.progress.begin("Component modes for bases");
    const double frequency = truncation.frequency > 0. ? truncation.frequency : run.parameters.discretization.maximum_frequency;
    std::map<BasisSource, int> n;
    const auto compute_if = [&](const bool is_used, const BasisSource source, const Component component, const ContactBoundary boundary,
                                const int count) {
      if (is_used)
        n[source] = keep_lowest({source, truncation.text(), {}, {}, {}}, component, boundary, frequency, count);
    };

    // Use as many sliding as free modes of the disc in a basis (Table 3 of the paper)
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
    return n;
  }

  void ReductionSets::grow(const double tolerance)
  {
    run.progress.begin("Growing a basis");
    ResidualIterationOptions iteration;
    iteration.band          = plan.largest_circular_frequency;
    iteration.tolerance     = tolerance;
    iteration.maximum_basis = run.parameters.solvers.maximum_basis;
    const Stopwatch watch;
    MultiVector     basis =
      grow_residual_basis(system, *frictionless.inverse, *frictionless.real.vectors, {plan.friction_coefficient}, iteration, run.progress)
        .model.basis();
    const int n = keep({BasisSource::residuals, exact_text(tolerance), {}, {}, {}, watch.cost().cpu_seconds}, std::move(basis));
    run.progress.finish(text(counted(n, "vector"), " for an estimated error of ", tolerance));
  }

  int ReductionSets::keep_lowest(Charge                charge,
                                 const Component       component,
                                 const ContactBoundary boundary,
                                 const double          frequency,
                                 const int             count)
  {
    const bool            is_disc = component == Component::disc;
    const std::string     what    = std::string("modes of the ") + (is_disc ? "disc" : "pins") + " for reduced bases";
    const Scene          &scene   = *linearisation.scene;
    SymmetricModesOptions options = real_modes_options(
      run.parameters.solvers, what, is_disc ? stabilizing_shift(*scene.model, scene.system, plan.largest_circular_frequency) : 0.);
    options.by_parts = !is_disc; // solve equal pins individually to avoid multiple eigenvalues

    const auto   T = component_kernel(*scene.model, linearisation.interface, component, boundary);
    const auto   K = congruence(*scene.system.stiffness, *T), M = congruence(*scene.system.mass, *T);
    const double omega = circular_frequency(frequency);
    const double end   = count > 0 ? end_of_lowest(*K, *M, count, omega * omega, std::pow(furthest_band * omega, 2), what) : omega * omega;

    const Stopwatch      watch;
    const SymmetricModes modes    = symmetric_modes(*K, *M, end, options);
    const int            n_solved = modes.eigenvalues.size();
    if (n_solved == 0)
      throw SolverError("there are no " + what + " below " + text(frequency) + " Hz", "parameter Reduction/Component modes",
                        "raise the truncation frequency");
    MultiVector set    = *T * view(*modes.vectors, 0, count > 0 ? count : n_solved);
    charge.seconds     = watch.cost().cpu_seconds;
    charge.end_of_band = hertz(std::sqrt(end));
    charge.n_solved    = n_solved;
    return keep(charge, std::move(set));
  }

  Table ReductionSets::cost_table() const
  {
    return Table(Columns<Charge>{{"set", "", [](const Charge &charge) { return to_string(charge.source); }},
                                 {"variant", "", &Charge::variant},
                                 {"vectors", "-", &Charge::n_vectors},
                                 {"end of the band", "Hz", &Charge::end_of_band, 1},
                                 {"modes in the band", "-", &Charge::n_solved},
                                 {"time", "s", &Charge::seconds, 2}},
                 charges);
  }
} // namespace Squeal
