// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/memory.h>
#include <squeal/bases/reduced_basis.h>
#include <squeal/estimates/reduction_errors.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/parameters/geometry.h>
#include <squeal/studies/accuracy/accuracy.h>
#include <squeal/studies/steps/mode_results.h>
#include <squeal/studies/steps/reduction_sets.h>

namespace Squeal
{
  namespace
  {
    constexpr const char *full_order = "full order";

    /// Starts measuring the memory used by all processes for one mesh, without memory retained from other meshes [byte].
    std::function<double()> memory_meter(const MPI_Comm communicator, const double resident_before)
    {
      const bool   has_peak       = reset_peak_memory();
      const double left_by_others = resident_memory() - resident_before;
      return [=] {
        double memory = (has_peak ? peak_resident_memory() : resident_memory()) - left_by_others;
        sum_over_processes(communicator, &memory, 1);
        return memory;
      };
    }

    std::vector<double> algebraic_errors(const ComplexModes &modes)
    {
      if (!modes.estimated_errors.empty())
        return modes.estimated_errors;
      std::vector<double> errors;
      for (const double residual : modes.energy_residuals)
        errors.push_back(0.5 * std::sqrt(residual));
      return errors;
    }

    /// Cost of the frictionless modes without factorisation and real modes, which are charged to each basis separately.
    Cost before_modes(const Cost &frictionless, const FrictionlessModes &modes)
    {
      return {frictionless.seconds - modes.factorisation.seconds - modes.solution.seconds,
              frictionless.cpu_seconds - modes.factorisation.cpu_seconds - modes.solution.cpu_seconds, frictionless.peak_memory};
    }

    /// Solves the modes with a reduced basis; @p before: cost of the steps shared by all bases.
    ModesByMethod reduced(const BasisRecipe             &recipe,
                          ReductionSets                 &sets,
                          const ComplexModes            &full,
                          const Cost                    &before,
                          const std::function<double()> &memory)
    {
      const ReductionParameters &reduction = sets.run.parameters.reduction;
      if (recipe.is_connected())
        sets.truncate(reduction.truncations.front());
      if (recipe.rests_on(BasisSource::residuals))
        sets.grow(reduction.grown_tolerances.front());
      BasisOptions options;
      options.tolerance     = reduction.rank_tolerance;
      options.pod_tolerance = reduction.pod_tolerance;
      const Stopwatch    watch;
      const ReducedBasis basis = reduced_basis(recipe, sets.ingredients, options);
      ReducedModel       model(sets.system);
      model.extend(*basis.vectors);
      const ReducedModes modes = reduced_modes(model, sets.plan.friction_coefficient, sets.plan.largest_circular_frequency, BandEnd::open);
      Cost               cost  = watch.cost();
      cost.seconds += before.seconds + sets.cost(recipe);
      cost.cpu_seconds += before.cpu_seconds + sets.cost(recipe);
      cost.peak_memory = std::max(before.peak_memory, memory());

      ModesByMethod result{recipe.name, basis.size(), cost, {}, {}};
      for (const ModeError &error : reduction_errors(sets.system, *sets.frictionless.inverse, model, modes, full))
        result.lambda.push_back(error.reduced);
      result.algebraic_errors.assign(result.lambda.size(), 0.); // dense eigenproblems have rounding errors only
      return result;
    }

    /// All requested meshes and elements, the coarsest meshes first.
    std::vector<MeshAndElement> meshes_and_elements(const Parameters &parameters)
    {
      const AccuracyStudyParameters &study   = parameters.accuracy;
      std::vector<double>            factors = study.factors;
      std::sort(factors.begin(), factors.end());
      std::vector<MeshAndElement> result;
      for (const double factor : factors)
        for (const Element element : study.elements)
          for (const Outlines outlines : study.outlines)
            if (element != Element::quadratic || outlines == study.outlines.front())
              result.push_back({element, outlines, factor});
      return result;
    }

    /// Parameters for a mesh and element, with the requested reduced bases.
    Parameters with(const MeshAndElement &mesh, const Parameters &given)
    {
      Parameters result                       = given;
      result.geometry                         = refined(result.geometry, mesh.factor);
      result.geometry.outlines                = mesh.outlines;
      result.discretization.element           = mesh.element;
      result.discretization.maximum_frequency = (1. + result.accuracy.margin) * result.discretization.maximum_frequency;
      result.reduction                        = {}; // settings of the reduction study must not affect the accuracy study
      result.reduction.problem                = ReductionProblem::friction;
      result.reduction.bases                  = result.accuracy.bases;
      result.reduction.grown_tolerances       = {result.accuracy.grown_tolerance};
      return result;
    }

    /// Solves the model on one mesh; @p resident_before: memory of this process before the first mesh [byte].
    SolvedMesh solved(const MeshAndElement &mesh, const double resident_before, std::optional<CommonPoints> &points, Run &run)
    {
      const Parameters parameters = with(mesh, run.parameters);
      Progress         silent;
      Run              part(parameters, run, silent);
      const auto       memory = memory_meter(run.communicator, resident_before);

      Stopwatch watch;
      Scene     scene  = mesh_scene(part);
      const int n_dofs = scene.model->n_dofs();
      if (n_dofs > parameters.accuracy.largest_dofs)
        throw MeshError(Squeal::text("the mesh has ", n_dofs, " dofs, more than Accuracy study/Largest number of dofs"), mesh.text(),
                        "raise this limit");
      FrictionlessModes frictionless  = damped_modes(scene, part);
      Cost              to_real_modes = watch.cost();
      to_real_modes.peak_memory       = memory();
      const FrictionModes full        = friction_modes(frictionless, parameters.operation.friction_coefficient, part);
      Cost                cost        = watch.cost();
      cost.peak_memory                = memory();

      if (!points)
        points = common_points(*scene.model, parameters.materials);
      SolvedMesh result{
        mesh, n_dofs, static_cast<int>(scene.interface.size()), modes_at(*points, frictionless, full), full.labels, full.n_unstable(), {}};
      const int n_coupled = frictionless.linearisation.coupled.kernel->n_columns();
      result.methods.push_back({full_order, n_coupled, cost, full.modes.lambda, algebraic_errors(full.modes)});

      if (!parameters.accuracy.bases.empty())
        {
          const ReductionPlan plan = reduction_plan(parameters);
          ReductionSets       sets(plan, frictionless, frictionless.linearisation.coupled, part);
          for (const BasisRecipe *recipe : plan.recipes)
            {
              const auto of_basis = memory_meter(run.communicator, resident_before);
              result.methods.push_back(reduced(*recipe, sets, full.modes, before_modes(to_real_modes, frictionless), of_basis));
            }
        }
      run.progress.finish(Squeal::text(n_dofs, " dofs, ", result.n_contact_nodes, " contact nodes, ", full.modes.lambda.size(), " modes, ",
                                       result.n_unstable, " unstable, ", cost.peak_memory / 1e9, " GB"));
      return result;
    }
  } // namespace

  std::string MeshAndElement::family() const
  {
    return to_string(element) + (element == Element::quadratic ? "" : ", " + to_string(outlines));
  }

  std::string MeshAndElement::text() const
  {
    return family() + ", x " + exact_text(factor);
  }

  SolvedMeshes solve_meshes(Run &run)
  {
    const double                resident_before = resident_memory();
    std::optional<CommonPoints> points;
    SolvedMeshes                result;
    for (const MeshAndElement &mesh : meshes_and_elements(run.parameters))
      {
        const auto leave_out = [&](const std::string &reason) {
          run.progress.finish("skipped: " + reason);
          result.left_out.push_back({mesh, reason});
        };
        run.progress.begin(mesh.text());
        try
          {
            result.meshes.push_back(solved(mesh, resident_before, points, run));
          }
        catch (const Error &error)
          {
            leave_out(error.reason);
          }
        catch (const std::runtime_error &error) // thrown for an error on another process
          {
            leave_out(error.what());
          }
      }
    return result;
  }
} // namespace Squeal
