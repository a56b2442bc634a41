#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/linear_algebra/weighted_gram.h>
#include <squeal/studies/steps/frictionless_modes.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    /// Component modes are found somewhat beyond the band: they label the coupled modes at its end.
    constexpr double label_band = 1.2;

    /// Work of a mount, in its units, over the displacements of a motion of zero frequency, up to which it is a rounding error.
    constexpr double no_work = 1e-12;

    /// Warns where motions count as those of a free body although a mount holds them.
    void warn_of_hidden_mounts(const FrictionlessModes &modes, Run &run)
    {
      const CoupledSystem &coupled = modes.linearisation.coupled;
      const int            n       = modes.real.n_rigid_body;
      const auto          &mounts  = modes.linearisation.scene->mounts;
      if (n == 0 || mounts == nullptr)
        return;
      const MultiVector U      = *coupled.kernel * view(*modes.real.vectors, 0, n);
      const auto        work   = symmetric_eigenpairs(gram(U, *mounts * U), gram(U, U)).values;
      const auto        n_held = std::count_if(work.begin(), work.end(), [](const double value) { return value > no_work; });
      if (n_held > 0)
        run.warn(text(n_held, " of the ", n, " modes of zero frequency ", n_held == 1 ? "is" : "are",
                      " held by mounts that are too soft: rounding errors of the stiffness hide frequencies below ",
                      decimal_text(hertz(std::sqrt(coupled.hidden_square))),
                      " Hz. Raise Mounts/Elastic mounts, or leave the directions out if the body is meant to be free"));
    }

    /**
     * Refuses a speed beyond a critical one, at which K − Ω² ρ N has negative eigenvalues: the disc cannot keep its shape in the fixed
     * frame, and no Cholesky factor exists.
     */
    void check_speed(const CoupledSystem &coupled, const Parameters &parameters)
    {
      if (!parameters.operation.rotating_disc || !parameters.has_friction())
        return;
      int       n_null = 0;
      const int n      = count_negative_eigenvalues(*coupled.stiffness, "stiffness of the turning disc", &n_null);
      if (n + n_null > 0)
        throw ParameterError(text("at ", exact_text(parameters.operation.rotation_speed), " rad/s the disc turns beyond a critical speed: ",
                                  n + n_null, n + n_null == 1 ? " motion has" : " motions have", " no positive stiffness"),
                             "parameter Operation/Rotation speed", "lower it, or set Operation/Gyroscopic forces = false");
    }

    /// Counts the modes of the band, and refuses more than allowed before any is computed: counting them takes one factorisation.
    ModeCount number_of_modes(const CoupledSystem &coupled, const double largest_circular_frequency, Run &run)
    {
      run.progress.begin("Mode count");
      const ModeCount    count     = count_below(*coupled.stiffness, *coupled.mass, largest_circular_frequency * largest_circular_frequency,
                                                 "real modes of the coupled system");
      const unsigned int allowed   = run.parameters.solvers.maximum_modes;
      const double       frequency = hertz(largest_circular_frequency);
      if (count.n_modes > static_cast<int>(allowed))
        throw ParameterError(text(count.n_modes, " modes lie below ", frequency, " Hz, more than the ", allowed, " allowed"),
                             "parameter Real modes/Maximum number of modes",
                             "lower Band/Maximum frequency, or raise Real modes/Maximum number of modes; time grows up to its cube");
      run.progress.finish(text(count.n_modes, " below ", frequency, " Hz by inertia"));
      return count;
    }
  } // namespace

  std::size_t n_in_band(const std::vector<double> &eigenvalues, const double largest_eigenvalue)
  {
    return std::upper_bound(eigenvalues.begin(), eigenvalues.end(), largest_eigenvalue) - eigenvalues.begin();
  }

  double ListedComponentMode::frequency() const
  {
    return hertz(std::sqrt(set->eigenvalues[number]));
  }

  std::vector<ListedComponentMode> listed_component_modes(const FrictionlessModes &modes, const double largest_eigenvalue)
  {
    std::vector<ListedComponentMode> result;
    const auto                       add = [&](const char *component, const char *contact, const ComponentModes &set) {
      const std::size_t      n = n_in_band(set.eigenvalues, largest_eigenvalue);
      std::vector<ModeLabel> labels(set.labels.begin(), set.labels.begin() + static_cast<std::ptrdiff_t>(n));
      mark_doublets(labels);
      for (std::size_t j = 0; j < n; ++j)
        result.push_back({component, contact, &set, static_cast<int>(j), labels[j]});
    };
    add("disc", "free", modes.disc);
    add("pins", "sliding", modes.pins_sliding);
    add("pins", "free", modes.pins_free);
    return result;
  }

  void add_modal_damping(FrictionlessModes &modes, const Parameters &parameters)
  {
    if (parameters.damping.modal_ratios.empty())
      return;
    const double        omega_max   = circular_frequency(parameters.discretization.maximum_frequency);
    std::vector<double> eigenvalues = modes.real.eigenvalues, ratios;
    eigenvalues.resize(n_in_band(eigenvalues, omega_max * omega_max));
    for (const double eigenvalue : eigenvalues)
      ratios.push_back(parameters.damping.modal_ratio(hertz(std::sqrt(eigenvalue))));
    const MultiVector vectors = view(*modes.real.vectors, 0, static_cast<int>(eigenvalues.size()));
    add_modal_damping(modes.linearisation.coupled, vectors, eigenvalues, ratios);
  }

  std::vector<ShapeShares> FrictionlessModes::shape_shares(const MultiVector &real_part, const MultiVector *imaginary_part) const
  {
    const SparseMatrix      &T_c = *linearisation.coupled.kernel;
    std::vector<ShapeShares> result;
    for_column_blocks(real_part.n_columns(), [&](const int first, const int n) {
      const MultiVector                u_re = T_c * view(real_part, first, n);
      const std::optional<MultiVector> u_im = imaginary_part ? std::optional(T_c * view(*imaginary_part, first, n)) : std::nullopt;
      const auto some = Squeal::shape_shares(references(), *linearisation.scene->system.mass, u_re, u_im ? &*u_im : nullptr);
      result.insert(result.end(), some.begin(), some.end());
    });
    return result;
  }

  std::vector<DenseMatrix> FrictionlessModes::reference_products(const MultiVector &vectors) const
  {
    std::vector<DenseMatrix> result(references().size());
    for_column_blocks(vectors.n_columns(), [&](const int first, const int n) {
      const auto some =
        products_with(references(), *linearisation.scene->system.mass, *linearisation.coupled.kernel * view(vectors, first, n));
      for (std::size_t i = 0; i < some.size(); ++i)
        result[i] = append_columns(result[i], some[i]);
    });
    return result;
  }

  std::vector<ModeLabel> FrictionlessModes::identify(const MultiVector &real_part, const MultiVector *imaginary_part) const
  {
    return Squeal::identify(references(), shape_shares(real_part, imaginary_part));
  }

  SymmetricModesOptions real_modes_options(const SolverParameters &solvers, const std::string &what, const double shift)
  {
    SymmetricModesOptions options;
    options.solver    = solvers.real_solver;
    options.tolerance = solvers.real_tolerance;
    options.library   = solvers.library;
    options.what      = what;
    options.shift     = shift * shift;
    return options;
  }

  namespace
  {
    /// Modes of the disc and of the pins alone, as a step of the run.
    void find_component_modes(const Linearisation &linearisation, FrictionlessModes &result, Run &run)
    {
      const Scene &scene     = *linearisation.scene;
      const double omega_max = circular_frequency(run.parameters.discretization.maximum_frequency);
      run.progress.begin("Component modes");
      const auto modes = [&](const Component component, const ContactBoundary boundary, const double band, const char *name) {
        const bool            is_disc = component == Component::disc;
        SymmetricModesOptions options =
          real_modes_options(run.parameters.solvers, name, is_disc ? stabilizing_shift(*scene.model, scene.system, omega_max) : 0.);
        // Pins are alike: every mode of one comes once for each of them, bending modes twice. One by one there are no such clusters.
        options.by_parts = !is_disc;
        run.progress.update(name);
        return component_modes(*scene.model, scene.interface, linearisation.interface, scene.system, component, boundary,
                               band * band * omega_max * omega_max, options);
      };
      result.pins_free    = modes(Component::pins, ContactBoundary::free, 1., "modes of the free pins");
      result.pins_sliding = modes(Component::pins, ContactBoundary::sliding, label_band, "modes of the sliding pins");
      result.disc         = modes(Component::disc, ContactBoundary::free, label_band, "modes of the disc");

      const auto n_in_band = [&](const ComponentModes &modes) { return Squeal::n_in_band(modes.eigenvalues, omega_max * omega_max); };
      const auto n_disc = n_in_band(result.disc), n_free = n_in_band(result.pins_free), n_sliding = n_in_band(result.pins_sliding);
      run.count("disc modes", n_disc);
      run.count("free pin modes", n_free);
      run.count("sliding pin modes", n_sliding);
      run.progress.finish(text("disc ", n_disc, ", pins free ", n_free, ", pins sliding ", n_sliding, " below ",
                               run.parameters.discretization.maximum_frequency, " Hz"));
    }
  } // namespace

  FrictionlessModes frictionless_modes(const Linearisation &linearisation, Run &run, const double margin)
  {
    const Scene         &scene      = *linearisation.scene;
    const Parameters    &parameters = run.parameters;
    const CoupledSystem &coupled    = linearisation.coupled;
    const double         omega_max  = circular_frequency(parameters.discretization.maximum_frequency);
    const double         limit      = omega_max * omega_max;
    FrictionlessModes    result;
    result.linearisation = linearisation;
    result.shift         = stabilizing_shift(*scene.model, coupled, omega_max);

    check_speed(coupled, parameters);
    const ModeCount count = number_of_modes(coupled, (1. + margin) * omega_max, run);
    find_component_modes(linearisation, result, run);

    run.progress.begin("Factorisation");
    const AttachmentModes attachment = !may_keep_attachment_modes(coupled)                     ? AttachmentModes::not_kept :
                                       parameters.solves_by(ComplexSolver::residual_iteration) ? AttachmentModes::when_needed :
                                                                                                 AttachmentModes::at_once;
    result.inverse = std::make_shared<UpdatedInverse>(result.linearisation.coupled, result.shift, parameters.solvers.library, attachment);
    run.measure("entries of the Cholesky factor", result.inverse->frictionless().n_factor_entries());
    result.factorisation = run.progress.finish(text(result.inverse->frictionless().n_factor_entries() / 1e6, " million entries",
                                                    result.shift > 0. ? ", shifted: the disc is free or held softly" : ""));

    run.progress.begin("Real modes");
    SymmetricModesOptions options = real_modes_options(parameters.solvers, "real modes of the coupled system", result.shift);
    options.count                 = count;
    // As many modes as there are pins that are alike may have one frequency
    options.block_size = std::clamp(static_cast<int>(scene.n_pins()), 8, 16);
    // The factor serves here too, unless the shift brought damping into it.
    if (result.shift == 0. || !coupled.has_damping())
      options.inverse = result.inverse.get();
    result.real              = symmetric_modes(*coupled.stiffness, *coupled.mass, count.limit, options);
    const std::size_t n_real = n_in_band(result.real.eigenvalues, limit);
    if (n_real == 0)
      throw SolverError("no mode of the coupled system lies in the band", "real modes", "raise Band/Maximum frequency");
    run.count("real modes", n_real);
    run.count("rigid-body modes", result.real.n_rigid_body);
    result.solution =
      run.progress.finish(text(result.real.eigenvalues.size(), " found, ", result.real.n_counted, " counted by inertia",
                               n_real < result.real.eigenvalues.size() ? text(", ", n_real, " in the band") : "",
                               result.real.n_rigid_body > 0 ? text(", ", result.real.n_rigid_body, " of a rigid body") : ""));

    warn_of_hidden_mounts(result, run);
    result.labels = result.identify(*result.real.vectors, nullptr);
    for (int j = 0; j < result.real.n_rigid_body; ++j)
      result.labels[j] = {ModeFamily::rigid_body, 0, 0, 0, DoubletSign::none, result.labels[j].participation};
    mark_doublets(result.labels);
    return result;
  }
} // namespace Squeal
