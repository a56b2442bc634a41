// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/bases/static_modes.h>
#include <squeal/estimates/residual_iteration.h>
#include <squeal/linear_algebra/mass_orthonormal.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace Squeal
{
  namespace
  {
    /// Directions with M-norms below this fraction of the largest are rounding errors [-].
    constexpr double dependence_tolerance = 1e-8;
    /// Principal axes of the residuals below this fraction of the largest are postponed to the next step [-].
    constexpr double compression_tolerance = 0.02;

    /// Dominant principal axes, in the M-norm, of the components of X outside the basis.
    MultiVector compress(const SparseMatrix &M, const ReducedModel &model, MultiVector X)
    {
      remove_basis(M, model, X);
      const auto [squares, axes] = symmetric_eigenpairs(gram(X, M * X)); // ascending
      const int    k             = squares.size();
      const double limit         = compression_tolerance * compression_tolerance * squares.back();
      const int    first         = std::lower_bound(squares.begin(), squares.end(), limit) - squares.begin();
      return X * axes.rightCols(k - first);
    }

    /// Modes of one type at one friction coefficient with their estimates.
    struct AssessedModes
    {
      AssessedModes(const CoupledSystem &system, const UpdatedInverse &inverse, const ReducedModel &model, ReducedModes found)
        : modes(std::move(found))
        , residuals(residual_vectors(system, inverse, model, modes))
        , estimates(estimate_eigenvalues(modes, residuals.products()))
      {}

      ReducedModes        modes;
      ResidualVectors     residuals;
      EigenvalueEstimates estimates;
    };

    /// Eigenvalues in the band (Band::lists()) at one friction coefficient: oscillating modes, then modes with real eigenvalues.
    using State = std::vector<AssessedModes>;

    /// Largest estimated error; NaN if any is NaN.
    double worst_error(const State &state)
    {
      std::vector<double> errors;
      for (const AssessedModes &kind : state)
        errors.insert(errors.end(), kind.estimates.errors.begin(), kind.estimates.errors.end());
      return max_norm(as_column(errors));
    }

    /// Residuals of the modes whose errors exceed the tolerance.
    std::vector<MultiVector> inaccurate_directions(const State &state, const double tolerance)
    {
      std::vector<MultiVector> parts;
      for (const AssessedModes &kind : state)
        {
          std::vector<int> inaccurate;
          for (std::size_t j = 0; j < kind.modes.lambda.size(); ++j)
            if (!(kind.estimates.errors[j] <= tolerance))
              inaccurate.push_back(static_cast<int>(j));
          if (!inaccurate.empty())
            parts.push_back(residual_directions(kind.residuals, kind.modes, inaccurate));
        }
      return parts;
    }

    ReducedModes modes_in_band(const ReducedModel &model, const double mu, const Band &band)
    {
      const ReducedModes modes = reduced_modes(model, mu, band.end);
      std::vector<int>   inside;
      for (std::size_t j = 0; j < modes.lambda.size(); ++j)
        if (band.lists(modes.lambda[j]))
          inside.push_back(static_cast<int>(j));
      if (inside.empty())
        throw SolverError("no oscillating mode lies in the band", "complex modes", "raise Band/Maximum frequency");
      return inside.size() == modes.lambda.size() ? modes : selected(modes, inside);
    }

    /// State at the friction coefficient with the largest error.
    State worst_state(const CoupledSystem       &system,
                      const UpdatedInverse      &inverse,
                      const ReducedModel        &model,
                      const std::vector<double> &friction_coefficients,
                      const Band                &band)
    {
      std::optional<State> result;
      for (const double mu : friction_coefficients)
        {
          State state;
          state.reserve(2);
          state.emplace_back(system, inverse, model, modes_in_band(model, mu, band));
          const auto &values = state.front().modes.real_values;
          if (std::any_of(values.begin(), values.end(), [&band](const double l) { return band.lists(l); }))
            state.emplace_back(system, inverse, model, real_eigenvalue_modes(model, mu, band));
          if (!result || !(worst_error(state) <= worst_error(*result)))
            result.emplace(std::move(state));
        }
      return std::move(*result);
    }
  } // namespace

  void remove_basis(const SparseMatrix &M, const ReducedModel &model, MultiVector &X)
  {
    for (unsigned int pass = 0; pass < 2; ++pass)
      X -= model.basis() * gram(model.basis(), M * X);
  }

  ReducedModel starting_model(const CoupledSystem  &system,
                              const UpdatedInverse &inverse,
                              const MultiVector    &real_modes,
                              const bool            friction)
  {
    // Friction forces due to damping, μ A V_C, are omitted because they are of second order
    const int   k = real_modes.n_columns();
    MultiVector vectors(real_modes.map(), k * (1 + (friction ? 2 : 0) + (system.has_damping() ? 1 : 0)), false);
    int         column = 0;
    const auto  add    = [&](const MultiVector &some) {
      MultiVector place = view(vectors, column, k);
      place             = some;
      column += k;
    };
    add(real_modes);
    if (friction)
      for (const Side side : {Side::right, Side::left})
        add(friction_response(system, inverse, real_modes, side));
    if (system.has_damping())
      add(damping_response(system, inverse, real_modes));
    ReducedModel model(system);
    model.extend(orthonormalize(*system.mass, nullptr, std::move(vectors), dependence_tolerance));
    return model;
  }

  MultiVector residual_directions(const ResidualVectors &residuals, const ReducedModes &modes, const std::vector<int> &chosen)
  {
    const int   k = modes.lambda.size();
    MultiVector X(residuals.right_forces.map(), 4 * static_cast<int>(chosen.size()));
    int         column = 0;
    for (const int j : chosen)
      {
        // The basis is M-orthonormal: the norm of the coefficients is the M-norm of the mode
        const double right = modes.right.col(j).norm(), left = modes.left.col(j).norm();
        X.col(column++) = residuals.right_displacements.col(j) / right;
        X.col(column++) = residuals.right_displacements.col(k + j) / right;
        X.col(column++) = residuals.left_displacements.col(j) / left;
        X.col(column++) = residuals.left_displacements.col(k + j) / left;
      }
    return X;
  }

  std::optional<MultiVector> new_vectors(const CoupledSystem &system, const ReducedModel &model, const std::vector<MultiVector> &directions)
  {
    const SparseMatrix &M = *system.mass;
    if (directions.empty())
      return {};
    const MultiVector      all     = join_all(directions);
    const std::vector<int> columns = nonzero_columns(all); // skip zero columns, for example the imaginary parts of neutral modes
    if (columns.empty())
      return {};
    MultiVector X = compress(M, model, selected(all, columns));
    return orthonormalize_if_any(M, &model.basis(), std::move(X), dependence_tolerance, nullptr, FirstProjection::done);
  }

  GrownBasis grow_residual_basis(const CoupledSystem            &system,
                                 const UpdatedInverse           &inverse,
                                 const MultiVector              &real_modes,
                                 const std::vector<double>      &friction_coefficients,
                                 const ResidualIterationOptions &options,
                                 Progress                       &progress)
  {
    if (friction_coefficients.empty())
      throw SolverError("the list of friction coefficients is empty", "residual iteration", "give at least one");
    const bool friction = std::any_of(friction_coefficients.begin(), friction_coefficients.end(), [](const double mu) { return mu != 0.; });
    ReducedModel model  = starting_model(system, inverse, real_modes, friction);

    for (int step = 0;; ++step)
      {
        State        state = worst_state(system, inverse, model, friction_coefficients, options.band);
        const double worst = worst_error(state);

        progress.update(text(counted(model.size(), "vector"), ", estimated error ", worst));
        if (worst <= options.tolerance)
          return {std::move(model), std::move(state.front().modes), std::move(state.front().estimates), worst, step};

        const auto fresh = new_vectors(system, model, inaccurate_directions(state, options.tolerance));
        if (!fresh || step == options.maximum_steps || model.size() + fresh->n_columns() > options.maximum_basis)
          throw SolverError(
            text("the residual iteration ended with an estimated relative error of lambda of ", worst, ", above the tolerance of ",
                 options.tolerance, " (", counted(model.size(), "vector"), ", ", counted(step, "extension"), ")"),
            "complex modes", "raise Complex modes/Maximum basis or Complex modes/Iteration tolerance, or choose the Krylov solver");
        model.extend(*fresh);
      }
  }

  ComplexModes residual_iteration(const CoupledSystem            &system,
                                  const UpdatedInverse           &inverse,
                                  const MultiVector              &real_modes,
                                  const double                    mu,
                                  const ResidualIterationOptions &options,
                                  Progress                       &progress)
  {
    const GrownBasis grown = grow_residual_basis(system, inverse, real_modes, {mu}, options, progress);
    ComplexModes     modes = full_order_modes(system, inverse, grown.model, grown.modes, &grown.estimates);
    for (const double l : grown.modes.real_values)
      if (options.band.lists(l))
        modes.real_values.push_back(l);
    modes.summary =
      text(counted(grown.model.size(), "vector"), ", estimated error ", grown.worst_error, ", ", counted(grown.n_growths, "extension"));
    return modes;
  }
} // namespace Squeal
