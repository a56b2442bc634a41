// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/studies/reduction/direct_reduction.h>
#include <squeal/tracking/chart_model.h>

namespace Squeal
{
  namespace
  {
    /// Right and left vectors of unit norm: real parts, then imaginary parts.
    MultiVector snapshot(const ComplexModes &modes)
    {
      MultiVector               left_re = *modes.left_real_part, left_im = *modes.left_imaginary_part;
      const std::vector<double> norms = complex_norms(left_re, left_im);
      for (int j = 0; j < left_re.n_columns(); ++j)
        {
          left_re.col(j) /= norms[j];
          left_im.col(j) /= norms[j];
        }
      return join({modes.real_part.get(), modes.imaginary_part.get(), &left_re, &left_im});
    }

    /// Modes of the reduced model, including modes beyond the band, which may be counterparts of modes in the band.
    ReducedModes modes_of(const ReducedModel &model, const double value, const double omega_max, Run &run)
    {
      constexpr double   margin = 0.3;
      const ComplexModes found =
        direct_modes(model.system(), value, Band((1. + margin) * omega_max, run.parameters.discretization.maximum_rate),
                     run.parameters.solvers, "reduced model", run.progress)
          .modes;
      ReducedModes result;
      result.values    = model.full_order().at(value);
      result.pencil    = model.at(result.values);
      result.mass      = DenseMatrix::Identity(model.size(), model.size());
      result.stiffness = result.mass * (omega_max * omega_max);
      result.lambda    = found.lambda;
      if (!found.lambda.empty())
        {
          result.right = from_halves(append_columns(replicate(*found.real_part), replicate(*found.imaginary_part)));
          result.left  = from_halves(append_columns(replicate(*found.left_real_part), replicate(*found.left_imaginary_part)));
        }
      return result;
    }

    EigenvalueEstimates estimate(const CoupledSystem &system,
                                 const ReducedModel  &model,
                                 const Factorization &factor,
                                 const ReducedModes  &modes)
    {
      const auto   full = [&](const DenseMatrix &coordinates) { return std::make_shared<MultiVector>(model.basis() * coordinates); };
      ComplexModes right, left;
      right.lambda = left.lambda = modes.lambda;
      right.real_part            = full(modes.right.real());
      right.imaginary_part       = full(modes.right.imag());
      left.real_part             = full(modes.left.real());
      left.imaginary_part        = full(modes.left.imag());
      const MultiVector R        = force_residuals(system, modes.values, modes.lambda, *right.real_part, *right.imaginary_part),
                        L        = force_residuals(system, modes.values, modes.lambda, *left.real_part, *left.imaginary_part, true);
      MultiVector displacements(R.map(), R.n_columns());
      factor.apply(R, displacements);
      const std::vector<double> none(modes.lambda.size(), 0.);
      EigenvalueEstimates       result = estimate_eigenvalues(modes, {product_of_halves(gram(L, displacements)), none, none});
      result.energy_residuals          = backward_errors(system, modes.values, right);
      return result;
    }
  } // namespace

  MeasuredBasis direct_pod(const GivenSystem &given, const ReductionPlan &plan, const ComplexModes &reference, Run &run)
  {
    const ReductionParameters &reduction = run.parameters.reduction;
    const double               omega_max = plan.largest_circular_frequency;
    CoupledSystem              system    = given.coupled;
    system.mass                          = inertia_square(system, given.value, omega_max);

    run.progress.begin("POD");
    const Stopwatch          of_basis;
    std::vector<MultiVector> snapshots;
    for (const double value : reduction.snapshots)
      {
        run.progress.update(text(system.varied, " = ", value));
        const ComplexModes modes =
          direct_modes(system, value, Band((1. + band_margin) * omega_max, run.parameters.discretization.maximum_rate),
                       run.parameters.solvers, "file " + given.file.path, run.progress)
            .modes;
        if (!modes.lambda.empty())
          snapshots.push_back(snapshot(modes));
      }
    if (snapshots.empty())
      throw SolverError("there are no modes in the band at any snapshot", "parameter Reduction/Snapshots",
                        "give other values, or raise Band/Maximum frequency");
    std::vector<const MultiVector *> parts;
    for (const MultiVector &part : snapshots)
      parts.push_back(&part);
    const MultiVector set = join(parts);
    BasisIngredients  ingredients;
    ingredients.coupled                      = &system;
    ingredients.sets[BasisSource::snapshots] = &set;
    BasisOptions options;
    options.pod_tolerance = reduction.pod_tolerance;
    MeasuredBasis result{plan.recipes.front(), plan.recipes.front()->name, "", reduced_basis(*plan.recipes.front(), ingredients, options)};
    ReducedModel  model(system);
    model.extend(*result.basis.vectors);
    result.build_seconds = of_basis.cost().cpu_seconds;
    result.n_r           = model.size();

    const Stopwatch    of_solution;
    const ReducedModes modes = modes_of(model, given.value, omega_max, run);
    result.solve_seconds     = of_solution.cost().cpu_seconds;
    const double shift       = omega_max / band_per_stabilizing_shift;
    const auto   factor      = factorize_general(*pencil_at(sparse_matrices(system.terms, modes.values), shift), "Q(s) at a real shift");
    result.errors            = reduction_errors(*system.mass, model, modes, reference,
                                                [&](const ReducedModes &chosen) { return estimate(system, model, *factor, chosen); });
    run.progress.finish(text(counted(result.basis.n_r0, "vector"), " from ", counted(reduction.snapshots.size(), "value"), " of ",
                             system.varied, ", ", result.n_r, " after truncation, largest error of lambda ", largest_error(result)));
    write_reduced_system(model, plan, result, 1, run);
    return result;
  }
} // namespace Squeal
