// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/geometry/scene_size.h>
#include <squeal/contact/travel.h>
#include <squeal/geometry/generate_mesh.h>
#include <squeal/geometry/mesh_check.h>
#include <squeal/studies/steps/scene.h>

#include <boost/algorithm/string/join.hpp>

namespace Squeal
{
  namespace
  {
    /// Minimum Poisson's ratio at which trilinear elements are reported to lock: relative to quadratic elements, bending frequencies of
    /// pins on the default mesh rise by 1.4 % from a ratio of 0.25 to this value, and by 3.6 % to 0.499.
    constexpr double locking_poisson_ratio = 0.47;

    void warn_of_locking(Run &run)
    {
      for (const auto &[section, material] : run.parameters.materials.all())
        if (run.parameters.discretization.element == Element::trilinear && material.mean_poisson_ratio() >= locking_poisson_ratio)
          run.progress.note(text("  note: trilinear elements lock: the ", material.orthotropy ? "mean " : "", "Poisson ratio in ", section,
                                 " is ", material.mean_poisson_ratio(), ": at ", locking_poisson_ratio,
                                 " and above, bending frequencies may be more than 1 % too high, and growth rates are even less accurate; "
                                 "set Discretization/Element = incompatible modes"));
    }

    void warn_of_linear_cells(const Mesh &mesh, Run &run)
    {
      const auto n =
        std::count_if(mesh.cells.begin(), mesh.cells.end(), [](const Mesh::Cell &cell) { return cell.shape != Shape::hexahedron; });
      if (n > 0 && degree_of(run.parameters.discretization.element) == 1)
        run.progress.note(text("  note: ", n,
                               " tetrahedra, pyramids and wedges of first order are too stiff in bending: frequencies may be too high by "
                               "more than 50 %; set Discretization/Element = quadratic"));
    }

    /// Sum of the mounts with nonzero stiffness, each scaled to a largest entry of one.
    std::shared_ptr<const SparseMatrix> unit_mounts(const std::vector<Term> &bodies)
    {
      std::vector<std::pair<double, std::shared_ptr<const SparseMatrix>>> summands;
      for (const Term &term : bodies)
        if (term.kind == TermKind::mount && term.power == 0)
          if (const double size = max_norm(*term.matrix); size > 0.)
            summands.emplace_back(1. / size, term.matrix);
      return sum(summands);
    }

  } // namespace

  Scene mesh_scene(Run &run)
  {
    const Parameters &parameters = run.parameters;
    Scene             scene;
    warn_of_locking(run);
    run.progress.begin("Mesh");
    GeometryParameters geometry = parameters.geometry;
    if (parameters.discretization.element == Element::quadratic)
      geometry.outlines = Outlines::inscribed; // curved edges already have the area of the circle
    std::vector<std::string> surfaces = parameters.materials.mounted_surfaces();
    if (parameters.needs_steady_sliding())
      for (const std::string &face : parameters.sliding.pressed_faces)
        if (face != PhysicalNames::pin_clamp) // clamped surfaces have no mount
          surfaces.push_back(face);
    scene.mesh                = generate_mesh(geometry, surfaces, run.communicator, parameters.contact);
    const MeshQuality quality = check_mesh(scene.mesh);
    for (const auto *list : {&parameters.materials.volumes, &parameters.materials.orthotropic})
      for (const VolumeMaterial &own : *list)
        if (std::count(scene.mesh.volume_names.begin(), scene.mesh.volume_names.end(), own.volume) == 0)
          throw ParameterError("there is no volume `" + own.volume + "`", "parameter " + parameters.materials.section_of(own.volume),
                               "name one of " + boost::algorithm::join(scene.mesh.volume_names, ", "));
    run.count("elements", scene.mesh.cells.size());
    run.measure("worst scaled Jacobian [-]", quality.worst_scaled_jacobian);
    run.progress.finish(
      text(cell_counts(scene.mesh), ", ", counted(scene.n_pins(), "pin"), ", worst scaled Jacobian ", quality.worst_scaled_jacobian));
    for (const std::string &note : scene.mesh.notes)
      run.progress.note("  note: " + note);
    warn_of_linear_cells(scene.mesh, run);
    summarise_scene(scene.mesh, run);
    // Check after the summary, because an unresolved mesh is often due to lengths or moduli in wrong units
    check_wave_resolution(scene.mesh, parameters.materials, degree_of(parameters.discretization.element),
                          circular_frequency(parameters.discretization.maximum_frequency));
    if (!run.is_dry)
      run.keep_geometry();

    run.progress.begin("Contact");
    scene.model = std::make_unique<Model>(scene.mesh, parameters.discretization.element, run.communicator);
    FoundContact contact =
      contact_nodes(*scene.model, parameters.contact.pairs, parameters.operation, parameters.geometry.pairing_tolerance);
    scene.interface = std::move(contact.interface);
    scene.contact   = contact_operators(*scene.model, scene.interface);
    if (parameters.needs_steady_sliding())
      check_sliding(*scene.model, scene.interface, parameters.operation, parameters.sliding);
    if (parameters.sliding.state == ContactState::equal_load && parameters.has_contact_damping())
      equal_load_shares(*scene.model, scene.interface, parameters.operation); // throws if the load cannot be distributed
    const int n = scene.model->free_map().n(), n_coupled = scene.contact.kernel->n_columns();
    run.count("dofs, clamped included", scene.model->n_dofs());
    run.count("dofs", n);
    run.count("contact nodes", scene.interface.size());
    run.count("coupled dofs", n_coupled);
    run.progress.finish(text(counted(scene.interface.size(), "contact node"), ", ", n, " dofs, ", n_coupled, " coupled"));
    contact.notes.insert(contact.notes.begin(), scene.model->notes().begin(), scene.model->notes().end());
    for (const std::string &note : contact.notes)
      run.progress.note("  note: " + note);
    return scene;
  }

  BodyTerms assemble_scene(Scene &scene, Run &run)
  {
    run.progress.begin("Assembly");
    const Parameters &parameters = run.parameters;
    BodyTerms         bodies     = body_terms(*scene.model, parameters.materials);
    if (parameters.operation.rotating_disc && parameters.has_friction())
      {
        const double omega_max = circular_frequency(parameters.discretization.maximum_frequency);
        if (stabilizing_shift(*scene.model, sparse_matrices(bodies.terms, bodies.values), omega_max) > 0.)
          throw ParameterError(
            "the disc is unconstrained or softly mounted, and the convective stiffness -Omega^2 rho N destabilises its rigid-body motions, "
            "because centrifugal prestress, which would cancel this effect, is not in the model",
            "parameter Operation/Gyroscopic forces",
            "hold the disc in all directions by stiff Mounts/Elastic mounts, or set Operation/Gyroscopic forces = false");
        add_rotation(bodies, *scene.model, parameters.operation.angular_velocity());
      }
    scene.mounts = unit_mounts(bodies.terms);
    for (const Term &term : bodies.terms)
      if (term.power == 0 && (term.kind == TermKind::body || term.kind == TermKind::mount))
        scene.elastic.terms.push_back(term);
    scene.elastic.values = bodies.values;
    // Maps over the speed vary the rotation terms, which therefore remain individual terms
    std::vector<Term> fixed = bodies.terms, varied;
    if (parameters.maps_rotation())
      {
        const auto first =
          std::stable_partition(fixed.begin(), fixed.end(), [](const Term &term) { return term.kind != TermKind::rotation; });
        varied.assign(first, fixed.end());
        fixed.erase(first, fixed.end());
      }
    scene.bodies = merged(fixed, bodies.values);
    scene.bodies.insert(scene.bodies.end(), varied.begin(), varied.end());
    scene.system = sparse_matrices(scene.bodies, bodies.values);
    run.progress.finish(text(scene.system.stiffness->n_entries(), " entries in K"));
    return bodies;
  }

  SlidingModel sliding_model(const Scene &scene, const Parameters &parameters)
  {
    return {*scene.model,
            scene.interface,
            scene.contact,
            scene.system,
            circular_frequency(parameters.discretization.maximum_frequency),
            parameters.solvers.library};
  }

  SlidingState solve_sliding(const Scene &scene, const OperationParameters &operation, const SlidingParameters &sliding, Run &run)
  {
    run.progress.begin("Steady sliding");
    SlidingState state  = steady_sliding(sliding_model(scene, run.parameters), operation, sliding);
    const auto   n_open = std::count(state.closed.begin(), state.closed.end(), false);
    run.progress.finish(
      text(n_open, " of ", scene.interface.size(), " contact nodes open, ", counted(state.n_steps, "change"), " of the contact set"));
    return state;
  }

  StateOfContact state_of_contact(const Model                       &model,
                                  const ContactInterface            &interface,
                                  const std::optional<SlidingState> &state,
                                  const OperationParameters         &operation)
  {
    StateOfContact      result;
    std::vector<double> reactions(interface.size(), 0.);
    if (state)
      reactions = state->reactions;
    else if (operation.has_contact_damping())
      reactions = equal_load_shares(model, interface, operation);
    for (unsigned int c = 0; c < interface.size(); ++c)
      if (!state || state->closed[c])
        result.closed.push_back(c);
    result.damping = {radial_dissipation(interface, reactions, operation), sliding_dissipation(interface, reactions, operation)};
    return result;
  }

  ContactDamping selected(const ContactDamping &damping, const std::vector<unsigned int> &chosen)
  {
    const auto select = [&](const std::vector<double> &values) {
      std::vector<double> result;
      for (const unsigned int c : chosen)
        result.push_back(values[c]);
      return result;
    };
    return {select(damping.radial), select(damping.sliding)};
  }

  Linearisation linearise(const Scene &scene, const std::optional<SlidingState> &sliding, const OperationParameters &operation)
  {
    const StateOfContact state = state_of_contact(*scene.model, scene.interface, sliding, operation);
    Linearisation        result;
    result.scene   = &scene;
    result.sliding = sliding;
    result.closed  = state.closed;
    for (const unsigned int c : state.closed)
      result.interface.push_back(scene.interface[c]);
    const bool all = state.closed.size() == scene.interface.size();
    result.contact = all ? scene.contact : contact_operators(*scene.model, result.interface);
    result.damping = selected(state.damping, state.closed);
    result.coupled = couple(scene.bodies, result.contact, result.damping, scene.elastic.values);
    return result;
  }

  Linearisation linearised_scene(Scene &scene, Run &run)
  {
    const Parameters &parameters = run.parameters;
    assemble_scene(scene, run);
    std::optional<SlidingState> sliding;
    if (parameters.sliding.state == ContactState::steady_sliding)
      sliding = solve_sliding(scene, parameters.operation, parameters.sliding, run);
    return linearise(scene, sliding, parameters.operation);
  }
} // namespace Squeal
