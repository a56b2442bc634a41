#include <squeal/base/exceptions.h>
#include <squeal/bases/static_modes.h>
#include <squeal/stability/residual_iteration.h>

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

    /// Φ_R with its static responses to friction and damping of first order. That to modal damping, K_c⁻¹ C_m Φ_R, lies in
    /// the span of Φ_R, which are eigenvectors; that to friction from the reactions to damping, μ A V_C, is of second order.
    MultiVector starting_vectors(const CoupledSystem &system, const UpdatedInverse &inverse, const MultiVector &Phi, const bool friction)
    {
      // Epetra vectors cannot be assigned in another size: parts are collected first.
      std::vector<MultiVector> parts = {Phi};
      if (friction)
        for (const Side side : {Side::right, Side::left})
          parts.push_back(friction_response(system, inverse, Phi, side));
      if (system.frictionless.damping)
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
      DenseMatrix  axes    = gram(X, M * X);
      const auto   squares = symmetric_eigenvalues(axes); // ascending
      const int    k       = squares.size();
      const double limit   = compression_tolerance * compression_tolerance * squares.back();
      const int    first   = std::lower_bound(squares.begin(), squares.end(), limit) - squares.begin();
      return X * columns(axes, first, k - first);
    }

    /// Modes at one friction coefficient with their estimates.
    struct State
    {
      ReducedModes        modes;
      ResidualVectors     residuals;
      EigenvalueEstimates estimates;
      double              worst;
    };

    /// The state of the largest error among all friction coefficients.
    State worst_state(const CoupledSystem       &system,
                      const UpdatedInverse      &inverse,
                      const ReducedModel        &model,
                      const std::vector<double> &friction_coefficients,
                      const double               largest_frequency)
    {
      std::unique_ptr<State> result;
      for (const double mu : friction_coefficients)
        {
          ReducedModes modes = reduced_modes(model, mu, largest_frequency);
          if (modes.lambda.empty())
            throw SolverError("no oscillating mode lies in the band", "complex modes", "raise Band/Maximum frequency");
          ResidualVectors     residuals = residual_vectors(system, inverse, model, modes);
          EigenvalueEstimates estimates = estimate_eigenvalues(modes, residuals.products());
          const double        worst     = *std::max_element(estimates.errors.begin(), estimates.errors.end());
          if (!result || !(worst <= result->worst))
            result = std::make_unique<State>(State{std::move(modes), std::move(residuals), std::move(estimates), worst});
        }
      return std::move(*result);
    }
  } // namespace

  ReducedModel
  starting_model(const CoupledSystem &system, const UpdatedInverse &inverse, const MultiVector &real_modes, const bool friction)
  {
    ReducedModel model(system);
    model.extend(orthonormalize(*system.frictionless.mass, nullptr, starting_vectors(system, inverse, real_modes, friction), dependence_tolerance));
    return model;
  }

  MultiVector residual_directions(const ResidualVectors &residuals, const ReducedModes &modes, const std::vector<int> &chosen)
  {
    const int  k    = modes.lambda.size();
    const auto norm = [](const ComplexDenseMatrix &X, const int j) {
      double sum = 0.;
      for (int i = 0; i < X.n_rows(); ++i)
        sum += std::norm(X(i, j));
      return std::sqrt(sum);
    };
    MultiVector X(residuals.right_forces.Map(), 4 * static_cast<int>(chosen.size()));
    int         column = 0;
    for (const int j : chosen)
      {
        // Coefficients in an M-orthonormal basis: their norm is the mode's M-norm.
        const double right = norm(modes.right, j), left = norm(modes.left, j);
        X(column++)->Scale(1. / right, *residuals.right_displacements(j));
        X(column++)->Scale(1. / right, *residuals.right_displacements(k + j));
        X(column++)->Scale(1. / left, *residuals.left_displacements(j));
        X(column++)->Scale(1. / left, *residuals.left_displacements(k + j));
      }
    return X;
  }

  std::optional<MultiVector> new_vectors(const CoupledSystem &system, const ReducedModel &model, const MultiVector &directions)
  {
    const SparseMatrix &M = *system.frictionless.mass;
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
    const bool          friction = std::any_of(friction_coefficients.begin(), friction_coefficients.end(), [](const double mu) { return mu != 0.; });
    ReducedModel        model    = starting_model(system, inverse, real_modes, friction);

    for (int step = 0;; ++step)
      {
        State state = worst_state(system, inverse, model, friction_coefficients, options.largest_frequency);

        std::ostringstream text;
        text << model.size() << " vectors, estimated error " << state.worst;
        progress.update(text.str());
        if (state.worst <= options.tolerance)
          return {std::move(model), std::move(state.modes), std::move(state.estimates), state.worst, step};

        std::vector<int> inaccurate;
        for (std::size_t j = 0; j < state.modes.lambda.size(); ++j)
          if (!(state.estimates.errors[j] <= options.tolerance))
            inaccurate.push_back(static_cast<int>(j));
        const auto fresh = new_vectors(system, model, residual_directions(state.residuals, state.modes, inaccurate));
        if (!fresh || step == options.maximum_steps || model.size() + fresh->NumVectors() > options.maximum_basis)
          {
            std::ostringstream what;
            what << "the residual iteration ends with an estimated error of lambda of " << state.worst << " where " << options.tolerance
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
      if (std::abs(l) <= options.largest_frequency)
        modes.overdamped.push_back(l);
    std::ostringstream summary;
    summary << grown.model.size() << " vectors, estimated error " << grown.worst_error << ", " << grown.n_growths << " growths";
    modes.summary = summary.str();
    return modes;
  }
} // namespace Squeal
