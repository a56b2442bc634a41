// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/bases/reduced_basis.h>
#include <squeal/estimates/eigenvalue_estimates.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/studies/ingredients/ingredients.h>

namespace Squeal
{
  namespace
  {
    /// Runs an action and records its cost.
    template <typename Function>
    auto timed(Cost &cost, Function &&function)
    {
      const Stopwatch watch;
      auto            result = function();
      cost                   = watch.cost();
      return result;
    }

    /// Broadcasts costs, because decisions that depend on times must agree on all processes.
    void agree(MPI_Comm communicator, StepCosts &costs)
    {
      for (Cost StepCosts::*step : {&StepCosts::mesh, &StepCosts::assembly, &StepCosts::sliding, &StepCosts::modes, &StepCosts::friction})
        for (double Cost::*quantity : {&Cost::seconds, &Cost::cpu_seconds})
          Squeal::agree(communicator, &(costs.*step.*quantity), 1);
    }

    /// Steady sliding state; empty for other contact states.
    std::optional<SlidingState> sliding_state(const Scene &scene, StepCosts &costs, Run &run)
    {
      costs.sliding = {};
      if (run.parameters.sliding.state != ContactState::steady_sliding)
        return std::nullopt;
      return timed(costs.sliding, [&] { return solve_sliding(scene, run.parameters.operation, run.parameters.sliding, run); });
    }

    /// Complex modes of a reduced model, with friction and all damping.
    ComplexModes reduced_complex_modes(const FrictionlessModes &frictionless, const std::string &basis, const Parameters &parameters)
    {
      const CoupledSystem &coupled = frictionless.linearisation.coupled;
      const double         mu      = parameters.operation.friction_coefficient;
      BasisIngredients     ingredients;
      ingredients.sets[BasisSource::real] = frictionless.real.vectors.get();
      ingredients.coupled                 = &coupled;
      ingredients.inverse                 = frictionless.inverse.get();
      ingredients.friction_coefficient    = mu;
      ReducedModel model(coupled);
      model.extend(*reduced_basis(*find_recipe(basis), ingredients).vectors);
      const double omega_max = circular_frequency(parameters.discretization.maximum_frequency);
      ComplexModes modes     = full_order_modes(coupled, *frictionless.inverse, model, reduced_modes(model, mu, omega_max), nullptr);
      modes.real_values      = real_eigenvalue_modes(model, mu, omega_max).real_values;
      modes.summary          = counted(model.size(), "vector");
      return modes;
    }

    /// Solves the steps that depend on friction and damping.
    void solve_with_friction(SolvedModel &model, FrictionlessModes &frictionless, const std::string &basis, Run &run)
    {
      const Parameters &parameters = model.parameters;
      model.friction               = timed(model.costs.friction, [&] {
        add_modal_damping(frictionless, parameters);
        return basis.empty() ? friction_modes(frictionless, parameters.operation.friction_coefficient, run) :
                                             named_modes(frictionless, judged_modes(frictionless.linearisation.coupled, frictionless,
                                                                                    reduced_complex_modes(frictionless, basis, parameters)));
      });
    }

    std::shared_ptr<ModesAtPoints> shapes_of(const SolvedModel       &model,
                                             const SparseMatrix      &displacements,
                                             const FrictionlessModes &frictionless)
    {
      return std::make_shared<ModesAtPoints>(at_points(displacements, *frictionless.linearisation.coupled.kernel, model.friction.modes));
    }
  } // namespace

  ReferenceModel solve_reference(Scene &&meshed, Run &run)
  {
    ReferenceModel result;
    result.parameters = run.parameters;
    for (const StepRecord &step : run.progress.steps()) // all steps so far belong to the mesh
      {
        result.costs.mesh.seconds += step.seconds;
        result.costs.mesh.cpu_seconds += step.cpu_seconds;
      }
    const auto scene = std::make_shared<Scene>(std::move(meshed));
    result.scene     = scene;

    timed(result.costs.assembly, [&] { return assemble_scene(*scene, run); });
    const Linearisation linearisation = linearise(*scene, sliding_state(*scene, result.costs, run), run.parameters.operation);
    result.frictionless               = timed(result.costs.modes, [&] { return frictionless_modes(linearisation, run); });
    solve_with_friction(result, result.frictionless, "", run);
    result.points        = common_points(*scene->model, run.parameters.materials);
    result.displacements = displacements_at(result.points, *scene->model);
    result.shapes        = shapes_of(result, *result.displacements, result.frictionless);
    agree(run.communicator, result.costs);
    return result;
  }

  SolvedModel solve_variant(const ReferenceModel &reference, const Variation &variation, const Run &whole)
  {
    Progress          silent;
    const Parameters &parameters = variation.parameters;
    Run               run(parameters, whole, silent);
    parameters.check();

    SolvedModel                 result;
    std::optional<SlidingState> sliding = reference.frictionless.linearisation.sliding;
    result.parameters                   = parameters;
    result.scene                        = reference.scene;
    result.costs                        = reference.costs;

    // ------------------------------------------------------------- mesh, contact
    if (variation.departure == Departure::mesh)
      {
        const auto scene = std::make_shared<Scene>(timed(result.costs.mesh, [&] { return mesh_scene(run); }));
        timed(result.costs.assembly, [&] { return assemble_scene(*scene, run); });
        result.scene = scene;
      }
    if (variation.departure == Departure::contact && parameters.sliding.state == ContactState::steady_sliding)
      check_sliding(*result.scene->model, result.scene->interface, parameters.operation, parameters.sliding);
    if (variation.departure == Departure::mesh || (variation.departure == Departure::contact && !variation.without_lift_off))
      sliding = sliding_state(*result.scene, result.costs, run);
    if (variation.without_lift_off)
      sliding->closed.assign(sliding->closed.size(), true);
    const Linearisation linearisation = linearise(*result.scene, sliding, parameters.operation);

    // ---------------------------------------------------------------------- modes
    const bool shares_modes = variation.departure != Departure::mesh && variation.departure != Departure::modes &&
                              // A shifted inverse includes the damping
                              reference.frictionless.shift == 0. && linearisation.closed == reference.frictionless.linearisation.closed &&
                              variation.margin == 0.;
    FrictionlessModes frictionless = shares_modes ?
                                       reference.frictionless :
                                       timed(result.costs.modes, [&] { return frictionless_modes(linearisation, run, variation.margin); });
    frictionless.linearisation     = linearisation;
    solve_with_friction(result, frictionless, variation.basis, run);
    const auto displacements =
      variation.departure == Departure::mesh ? displacements_at(reference.points, *result.scene->model) : reference.displacements;
    result.shapes = shapes_of(result, *displacements, frictionless);
    agree(run.communicator, result.costs);
    return result;
  }
} // namespace Squeal
