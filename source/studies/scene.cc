#include <squeal/assembly/rotation.h>
#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/bases/mode_count_estimate.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/geometry/generate_mesh.h>
#include <squeal/geometry/mesh_check.h>
#include <squeal/linear_algebra/sparse.h>
#include <squeal/studies/scene.h>
#include <squeal/studies/scene_summary.h>

#include <algorithm>
#include <numeric>

namespace Squeal
{
  unsigned int Scene::n_pins() const
  {
    return mesh.volume_names.size() - 1;
  }

  namespace
  {
    /**
     * Poisson's ratio from which trilinear elements lock: bending frequencies of pins on the default mesh are 1 % higher beside
     * those of quadratic elements than at 0.25, at 0.499 it is 2.7 %.
     */
    constexpr double locking_poisson_ratio = 0.47;

    void warn_of_locking(Run &run)
    {
      const MaterialParameters &materials = run.parameters.materials;
      for (const auto &[section, material] :
           {std::make_pair("Disc material", materials.disc), std::make_pair("Pin material", materials.pin)})
        if (run.parameters.discretization.degree == 1 && material.poisson_ratio >= locking_poisson_ratio)
          run.progress.note(text("  note: trilinear elements lock at ", section, "/Poisson ratio = ", material.poisson_ratio, ": from ",
                                 locking_poisson_ratio,
                                 " on bending frequencies are more than 1 % too high, growth rates less accurate "
                                 "still; set Discretization/Degree = 2"));
    }

    bool is_free_disc(const Scene &scene, const SecondOrderSystem &system, const Parameters &parameters)
    {
      return stabilizing_shift(*scene.model, system, circular_frequency(parameters.discretization.maximum_frequency)) > 0.;
    }
  } // namespace

  Scene mesh_scene(Run &run)
  {
    const Parameters &parameters = run.parameters;
    Scene             scene;
    warn_of_locking(run);
    run.progress.begin("Mesh");
    scene.mesh                = generate_mesh(parameters.geometry, parameters.materials.mounted_surfaces(), run.communicator);
    const MeshQuality quality = check_mesh(scene.mesh);
    run.count("elements", scene.mesh.hexahedra.size());
    run.measure("worst scaled Jacobian [-]", quality.worst_scaled_jacobian);
    run.progress.finish(
      text(scene.mesh.hexahedra.size(), " hexahedra, ", scene.n_pins(), " pins, worst scaled Jacobian ", quality.worst_scaled_jacobian));
    summarise_scene(scene.mesh, run);
    // After the summary: what the mesh does not resolve is often a length or a modulus in other units.
    check_wave_resolution(scene.mesh, parameters.materials, parameters.discretization.degree,
                          circular_frequency(parameters.discretization.maximum_frequency));
    if (!run.is_dry)
      run.keep_geometry();

    run.progress.begin("Contact");
    scene.model     = std::make_unique<Model>(scene.mesh, parameters.discretization.degree, run.communicator);
    scene.interface = pair_contact_nodes(*scene.model, parameters.operation.rotation, parameters.geometry.pairing_tolerance);
    scene.contact   = contact_operators(*scene.model, scene.interface);
    if (parameters.needs_steady_sliding())
      check_sliding(*scene.model, scene.interface, parameters.operation, parameters.sliding);
    const int n = scene.model->free_map().NumGlobalElements(), n_coupled = scene.contact.kernel->NumGlobalCols();
    run.count("dofs, clamped included", scene.model->n_dofs());
    run.count("dofs", n);
    run.count("contact nodes", scene.interface.size());
    run.count("coupled dofs", n_coupled);
    run.progress.finish(text(scene.interface.size(), " contact nodes, ", n, " dofs, ", n_coupled, " coupled"));
    return scene;
  }

  void assemble_scene(Scene &scene, Run &run)
  {
    run.progress.begin("Assembly");
    const Parameters &parameters = run.parameters;
    BodyTerms         bodies     = body_terms(*scene.model, parameters.materials);
    if (parameters.operation.rotating_disc && parameters.has_friction())
      {
        if (is_free_disc(scene, sparse_matrices(bodies.terms, bodies.values), parameters))
          throw ParameterError("the disc is free or held softly: its motions as a rigid body are not stable in the fixed frame",
                               "parameter Operation/Gyroscopic forces",
                               "hold the disc by Mounts/Elastic mounts, or set Operation/Gyroscopic forces = false");
        add_rotation(bodies, *scene.model, parameters.operation.angular_velocity());
      }
    scene.bodies = merged(bodies.terms, bodies.values);
    scene.system = sparse_matrices(scene.bodies, bodies.values);
    run.progress.finish(text(scene.system.stiffness->NumGlobalNonzeros(), " entries in K"));
  }

  SlidingState solve_sliding(const Scene &scene, const OperationParameters &operation, const SlidingParameters &sliding, Run &run)
  {
    run.progress.begin("Steady sliding");
    const StaticResponse response(*scene.model, scene.system, circular_frequency(run.parameters.discretization.maximum_frequency),
                                  run.parameters.solvers.library);
    SlidingState         state  = steady_sliding(*scene.model, scene.interface, scene.contact, scene.system, response, operation, sliding);
    const auto           n_open = std::count(state.closed.begin(), state.closed.end(), false);
    run.progress.finish(
      text(n_open, " of ", scene.interface.size(), " contact nodes open, ", state.n_steps, " changes of the contact set"));
    return state;
  }

  Linearisation linearise(const Scene &scene, const SlidingState *state, const OperationParameters &operation)
  {
    Linearisation result;
    if (state)
      {
        result.sliding   = *state;
        result.reactions = state->reactions;
        for (unsigned int c = 0; c < scene.interface.size(); ++c)
          if (state->closed[c])
            result.closed.push_back(c);
      }
    else
      {
        result.reactions = equal_load_shares(scene.interface, operation.load_per_side);
        result.closed.resize(scene.interface.size());
        std::iota(result.closed.begin(), result.closed.end(), 0u);
      }
    std::vector<double> reactions;
    for (const unsigned int c : result.closed)
      {
        result.interface.push_back(scene.interface[c]);
        reactions.push_back(result.reactions[c]);
      }
    const bool all = result.closed.size() == scene.interface.size();
    result.contact = all ? scene.contact : contact_operators(*scene.model, result.interface);
    result.damping = {radial_dissipation(result.interface, reactions, operation), sliding_dissipation(reactions, operation)};
    result.coupled = couple(scene.bodies, result.contact, result.damping);
    return result;
  }

  Linearisation linearised_scene(Scene &scene, Run &run)
  {
    const Parameters &parameters = run.parameters;
    assemble_scene(scene, run);
    std::optional<SlidingState> sliding;
    if (parameters.sliding.state == ContactState::steady_sliding)
      sliding = solve_sliding(scene, parameters.operation, parameters.sliding, run);
    return linearise(scene, sliding ? &*sliding : nullptr, parameters.operation);
  }
} // namespace Squeal
