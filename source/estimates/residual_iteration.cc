#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/bases/static_modes.h>
#include <squeal/estimates/residual_iteration.h>

#include <Epetra_Vector.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace Squeal
{
  namespace
  {
    /// Directions whose M-norm is below this part of the largest are taken for rounding errors.
    constexpr double dependence_tolerance = 1e-8;
    /// Principal axes of the residuals below this part of the largest are left to the next step.
    constexpr double compression_tolerance = 0.02;

    /// Φ_R with its static responses to friction and damping of first order. That to
    /// friction from the reactions to damping, μ A V_C, is of second order.
    MultiVector starting_vectors(const CoupledSystem &system, const UpdatedInverse &inverse, const MultiVector &Phi, const bool friction)
    {
      // Epetra vectors cannot be assigned in another size: parts are collected first.
      std::vector<MultiVector> parts = {Phi};
      if (friction)
        for (const Side side : {Side::right, Side::left})
          parts.push_back(friction_response(system, inverse, Phi, side));
      if (system.has_damping())
        parts.push_back(damping_response(system, inverse, Phi));

      std::vector<const MultiVector *> pointers;
      for (const MultiVector &part : parts)
        pointers.push_back(&part);
      return join(pointers);
    }

    /// Principal axes in the M-norm of the columns of X outside of the basis, the small ones left out.
    MultiVector compress(const SparseMatrix &M, const MultiVector &basis, MultiVector X)
    {
      for (unsigned int pass = 0; pass < 2; ++pass)
        multiply_add(-1., basis, gram(basis, M * X), 1., X);
      const auto [squares, axes] = symmetric_eigenpairs(gram(X, M * X)); // ascending
      const int    k             = squares.size();
      const double limit         = compression_tolerance * compression_tolerance * squares.back();
      const int    first         = std::lower_bound(squares.begin(), squares.end(), limit) - squares.begin();
      return X * axes.rightCols(k - first);
    }

    /// Modes of one kind at one friction coefficient with their estimates.
    struct AssessedModes
    {
      AssessedModes(const CoupledSystem &system, const UpdatedInverse &inverse, const ReducedModel &model, ReducedModes found)
        : modes(std::move(found))
        , residuals(residual_vectors(system, inverse, model, modes))
        , estimates(estimate_eigenvalues(modes, residuals.products()))
      {}

      /// Largest estimated error.
      double worst() const
      {
        return *std::max_element(estimates.errors.begin(), estimates.errors.end());
      }

      /// Residuals of the modes that miss the tolerance; nothing if none does.
      std::optional<MultiVector> directions(const double tolerance) const
      {
        std::vector<int> inaccurate;
        for (std::size_t j = 0; j < modes.lambda.size(); ++j)
          if (!(estimates.errors[j] <= tolerance))
            inaccurate.push_back(static_cast<int>(j));
        if (inaccurate.empty())
          return {};
        return residual_directions(residuals, modes, inaccurate);
      }

      ReducedModes        modes;
      ResidualVectors     residuals;
      EigenvalueEstimates estimates;
    };

    /// Everything inside the radius of the band at one friction coefficient.
    struct State
    {
      AssessedModes                complex;
      std::optional<AssessedModes> real; ///< real eigenvalues where there are any

      double worst() const
      {
        return real ? std::max(complex.worst(), real->worst()) : complex.worst();
      }

      MultiVector directions(const double tolerance) const
      {
        const auto of_complex = complex.directions(tolerance), of_real = real ? real->directions(tolerance) : std::nullopt;
        if (of_complex && of_real)
          return join({&*of_complex, &*of_real});
        return of_complex ? *of_complex : *of_real;
      }
    };

    /// Oscillating modes inside the radius of the band.
    ReducedModes modes_in_band(const ReducedModel &model, const double mu, const double largest_circular_frequency)
    {
      const ReducedModes modes = reduced_modes(model, mu, largest_circular_frequency);
      std::vector<int>   inside;
      for (std::size_t j = 0; j < modes.lambda.size(); ++j)
        if (std::abs(modes.lambda[j]) <= band_radius(largest_circular_frequency))
          inside.push_back(static_cast<int>(j));
      if (inside.empty())
        throw SolverError("no oscillating mode lies in the band", "complex modes", "raise Band/Maximum frequency");
      return inside.size() == modes.lambda.size() ? modes : selected(modes, inside);
    }

    State assess(const CoupledSystem  &system,
                 const UpdatedInverse &inverse,
                 const ReducedModel   &model,
                 const double          mu,
                 const double          largest_circular_frequency)
    {
      const double radius = band_radius(largest_circular_frequency);
      State        state{AssessedModes(system, inverse, model, modes_in_band(model, mu, largest_circular_frequency)), {}};
      const auto  &values = state.complex.modes.real_values;
      if (std::any_of(values.begin(), values.end(), [radius](const double l) { return std::abs(l) <= radius; }))
        state.real.emplace(system, inverse, model, real_eigenvalue_modes(model, mu, largest_circular_frequency, radius));
      return state;
    }

    /// The state of the largest error among all friction coefficients.
    State worst_state(const CoupledSystem       &system,
                      const UpdatedInverse      &inverse,
                      const ReducedModel        &model,
                      const std::vector<double> &friction_coefficients,
                      const double               largest_circular_frequency)
    {
      std::unique_ptr<State> result;
      for (const double mu : friction_coefficients)
        {
          State state = assess(system, inverse, model, mu, largest_circular_frequency);
          if (!result || !(state.worst() <= result->worst()))
            result = std::make_unique<State>(std::move(state));
        }
      return std::move(*result);
    }
  } // namespace

  ReducedModel starting_model(const CoupledSystem  &system,
                              const UpdatedInverse &inverse,
                              const MultiVector    &real_modes,
                              const bool            friction)
  {
    ReducedModel model(system);
    model.extend(orthonormalize(*system.mass, nullptr, starting_vectors(system, inverse, real_modes, friction), dependence_tolerance));
    return model;
  }

  MultiVector residual_directions(const ResidualVectors &residuals, const ReducedModes &modes, const std::vector<int> &chosen)
  {
    const int   k = modes.lambda.size();
    MultiVector X(residuals.right_forces.Map(), 4 * static_cast<int>(chosen.size()));
    int         column = 0;
    for (const int j : chosen)
      {
        // Coefficients in an M-orthonormal basis: their norm is the mode's M-norm.
        const double right = modes.right.col(j).norm(), left = modes.left.col(j).norm();
        X(column++)->Scale(1. / right, *residuals.right_displacements(j));
        X(column++)->Scale(1. / right, *residuals.right_displacements(k + j));
        X(column++)->Scale(1. / left, *residuals.left_displacements(j));
        X(column++)->Scale(1. / left, *residuals.left_displacements(k + j));
      }
    return X;
  }

  std::optional<MultiVector> new_vectors(const CoupledSystem &system, const ReducedModel &model, const MultiVector &directions)
  {
    const SparseMatrix &M = *system.mass;
    return orthonormalize_if_any(M, &model.basis(), compress(M, model.basis(), directions), dependence_tolerance);
  }

  GrownBasis grow_residual_basis(const CoupledSystem            &system,
                                 const UpdatedInverse           &inverse,
                                 const MultiVector              &real_modes,
                                 const std::vector<double>      &friction_coefficients,
                                 const ResidualIterationOptions &options,
                                 Progress                       &progress)
  {
    if (friction_coefficients.empty())
      throw SolverError("there is no friction coefficient at which the basis could grow", "residual iteration", "give one at least");
    const bool friction = std::any_of(friction_coefficients.begin(), friction_coefficients.end(), [](const double mu) { return mu != 0.; });
    ReducedModel model  = starting_model(system, inverse, real_modes, friction);

    for (int step = 0;; ++step)
      {
        State        state = worst_state(system, inverse, model, friction_coefficients, options.largest_circular_frequency);
        const double worst = state.worst();

        std::ostringstream text;
        text << model.size() << " vectors, estimated error " << worst;
        progress.update(text.str());
        if (worst <= options.tolerance)
          return {std::move(model), std::move(state.complex.modes), std::move(state.complex.estimates), worst, step};

        const auto fresh = new_vectors(system, model, state.directions(options.tolerance));
        if (!fresh || step == options.maximum_steps || model.size() + fresh->NumVectors() > options.maximum_basis)
          {
            std::ostringstream what;
            what << "the residual iteration ends with an estimated error of lambda of " << worst << " where " << options.tolerance
                 << " was asked for (" << model.size() << " vectors, " << step << " growths)";
            throw SolverError(what.str(), "complex modes",
                              "raise Complex modes/Maximum basis or Complex modes/Iteration tolerance, or choose the Krylov solver");
          }
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
      if (std::abs(l) <= band_radius(options.largest_circular_frequency))
        modes.real_values.push_back(l);
    std::ostringstream summary;
    summary << grown.model.size() << " vectors, estimated error " << grown.worst_error << ", " << grown.n_growths << " growths";
    modes.summary = summary.str();
    return modes;
  }
} // namespace Squeal
