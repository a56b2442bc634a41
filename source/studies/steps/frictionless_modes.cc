// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/studies/steps/friction_modes.h>

namespace Squeal
{
  namespace
  {
    /// Component modes are computed up to this multiple of the end of the band, to label the coupled modes near its end [-].
    constexpr double label_band = 1.2;

    /// Work of a mount during a zero-frequency motion, relative to its stiffness and displacements, below which it counts as a rounding
    /// error [-].
    constexpr double no_work = 1e-12;

    /// Warns if a motion counts as a free rigid-body motion although a mount resists it.
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
                      " Hz. Increase Mounts/Elastic mounts, or remove these directions if the body is unconstrained"));
    }

    /// Rejects supercritical speeds, at which K − Ω² ρ N has eigenvalues ≤ 0 and no Cholesky factor.
    void check_speed(CoupledSystem coupled, const Parameters &parameters)
    {
      if (!parameters.operation.rotating_disc || !parameters.has_friction())
        return;
      const double speed = parameters.operation.rotation_speed, last = parameters.sweep.map_values.last;
      const bool   is_in_map = parameters.maps_rotation() && last > speed;
      if (is_in_map)
        {
          coupled.values[BodyParameter::angular_velocity] = {last};
          set_frictionless_matrices(coupled);
        }
      int       n_null = 0;
      const int n      = count_negative_eigenvalues(*coupled.stiffness, "stiffness of the rotating disc", &n_null);
      if (n + n_null > 0)
        throw ParameterError(
          text("the rotation speed of ", exact_text(is_in_map ? last : speed),
               " rad/s exceeds a critical speed: ", "the stiffness K - Omega^2 rho N has ", counted(n + n_null, "non-positive eigenvalue"),
               ". The model does not contain centrifugal prestress, which is of the same order Omega^2 and stiffens the disc"),
          is_in_map ? "parameter Sweep/Last map value" : "parameter Operation/Rotation speed",
          "lower it, or set Operation/Gyroscopic forces = false");
    }

    /// Modes of the disc and of the pins alone, as a step of the run.
    void find_component_modes(const Linearisation &linearisation, FrictionlessModes &result, Run &run)
    {
      const Scene &scene     = *linearisation.scene;
      const double omega_max = circular_frequency(run.parameters.discretization.maximum_frequency);
      run.progress.begin("Component modes");
      double pins_shift = 0.; // shift for bodies that mounts do not constrain
      for (unsigned int body = 1; body < scene.model->component_names().size(); ++body)
        if (free_motions(*scene.model, scene.system, body))
          pins_shift = omega_max / band_per_stabilizing_shift;
      const auto modes = [&](const Component component, const ContactBoundary boundary, const double band, const char *name) {
        const bool            is_disc = component == Component::disc;
        SymmetricModesOptions options =
          real_modes_options(run.parameters.solvers, name, is_disc ? stabilizing_shift(*scene.model, scene.system, omega_max) : pins_shift);
        // Solve pins individually, because equal pins would cause clusters, in which every mode occurs once per pin, and bending modes
        // twice per pin
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

  MultiVector FrictionlessModes::on_bodies(const MultiVector &vectors) const
  {
    return linearisation.scene != nullptr ? *linearisation.coupled.kernel * vectors : vectors;
  }

  const SparseMatrix &FrictionlessModes::mass_of_bodies() const
  {
    return linearisation.scene != nullptr ? *linearisation.scene->system.mass : *linearisation.coupled.mass;
  }

  std::vector<ShapeShares> FrictionlessModes::shape_shares(const MultiVector &real_part, const MultiVector *imaginary_part) const
  {
    std::vector<ShapeShares> result;
    for_column_blocks(real_part.n_columns(), [&](const int first, const int n) {
      const MultiVector                u_re = on_bodies(view(real_part, first, n));
      const std::optional<MultiVector> u_im = imaginary_part ? std::optional(on_bodies(view(*imaginary_part, first, n))) : std::nullopt;
      const auto                       some = Squeal::shape_shares(references(), mass_of_bodies(), u_re, u_im ? &*u_im : nullptr);
      result.insert(result.end(), some.begin(), some.end());
    });
    return result;
  }

  std::vector<DenseMatrix> FrictionlessModes::reference_products(const MultiVector &vectors) const
  {
    std::vector<DenseMatrix> result(references().size());
    for_column_blocks(vectors.n_columns(), [&](const int first, const int n) {
      const auto some = products_with(references(), mass_of_bodies(), on_bodies(view(vectors, first, n)));
      for (std::size_t i = 0; i < some.size(); ++i)
        result[i] = append_columns(result[i], some[i]);
    });
    return result;
  }

  std::vector<ModeLabel> FrictionlessModes::identify(const MultiVector &real_part, const MultiVector *imaginary_part) const
  {
    return Squeal::identify(references(), shape_shares(real_part, imaginary_part));
  }

  FrictionlessModes frictionless_modes(const Linearisation &linearisation, Run &run, const double margin)
  {
    const Scene         &scene      = *linearisation.scene;
    const Parameters    &parameters = run.parameters;
    const CoupledSystem &coupled    = linearisation.coupled;
    const double         omega_max  = circular_frequency(parameters.discretization.maximum_frequency);
    FrictionlessModes    result;
    result.linearisation = linearisation;

    check_speed(coupled, parameters);
    const ModeCount count = number_of_modes(coupled, (1. + margin) * omega_max, parameters.solvers, run.progress);
    find_component_modes(linearisation, result, run);

    // Equal pins cause clusters that contain as many modes as there are pins
    const int block_size               = std::clamp(static_cast<int>(scene.n_pins()), 8, 16);
    static_cast<SystemModes &>(result) = system_modes(coupled, stabilizing_shift(*scene.model, coupled, omega_max), omega_max, count,
                                                      block_size, parameters.solvers, run.progress);
    run.measure("entries of the Cholesky factor", result.inverse->frictionless().n_factor_entries());
    run.count("real modes", n_in_band(result.real.eigenvalues, omega_max * omega_max));
    run.count("rigid-body modes", result.real.n_rigid_body);

    warn_of_hidden_mounts(result, run);
    result.labels = result.identify(*result.real.vectors, nullptr);
    for (int j = 0; j < result.real.n_rigid_body; ++j)
      result.labels[j] = {ModeFamily::rigid_body, 0, 0, 0, DoubletSign::none, result.labels[j].participation};
    mark_doublets(result.labels);
    return result;
  }

  FrictionlessModes damped_modes(Scene &scene, Run &run)
  {
    FrictionlessModes result = frictionless_modes(linearised_scene(scene, run), run);
    add_modal_damping(result, run.parameters);
    return result;
  }
} // namespace Squeal
