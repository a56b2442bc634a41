// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/estimates/eigenvalue_estimates.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Condition number above which δλ is not meaningful [-].
    constexpr double largest_condition = 1e3;

    /// ψ_jᵀ A φ_j (without conjugation) for every column.
    Eigen::VectorXcd bilinear(const DenseMatrix &A, const ComplexDenseMatrix &psi, const ComplexDenseMatrix &phi)
    {
      return psi.cwiseProduct(multiply(A, phi)).colwise().sum();
    }

    /// x_jᴴ A x_j for every column, with a symmetric A, which is diagonal in modal coordinates.
    Eigen::VectorXd squares(const DenseMatrix &A, const ComplexDenseMatrix &X)
    {
      if (A.isDiagonal(0.))
        return X.cwiseAbs2().transpose() * A.diagonal();
      return X.conjugate().cwiseProduct(multiply(A, X)).real().colwise().sum();
    }

    /// Smaller root of a δ² + b δ = e.
    Complex smaller_root(const Complex a, const Complex b, const Complex e)
    {
      const Complex root = std::sqrt(b * b + 4. * a * e);
      // The formula 2 e / (b ± root) with the larger denominator avoids cancellation
      const Complex denominator = std::abs(b + root) > std::abs(b - root) ? b + root : b - root;
      return std::abs(denominator) > 0. ? 2. * e / denominator : 0.;
    }
  } // namespace

  ResidualVectors residual_vectors(const CoupledSystem  &system,
                                   const UpdatedInverse &inverse,
                                   const ReducedModel   &model,
                                   const ReducedModes   &modes)
  {
    const auto force = [&](const ComplexDenseMatrix &vectors, const bool left) {
      return force_residuals(system, modes.values, modes.lambda, model.basis() * vectors.real(), model.basis() * vectors.imag(), left);
    };
    const MultiVector R = force(modes.right, false), L = force(modes.left, true);
    return {R, L, inverse.solve_frictionless(R), inverse.solve_frictionless(L)};
  }

  ResidualProducts ResidualVectors::products() const
  {
    return {product_of_halves(gram(left_forces, right_displacements)), complex_products(right_forces, right_displacements),
            complex_products(left_forces, left_displacements)};
  }

  EigenvalueEstimates estimate_eigenvalues(const ReducedModes &modes, const ResidualProducts &products)
  {
    const int                 k = modes.lambda.size();
    const ComplexDenseMatrix &E = products.coupling;
    EigenvalueEstimates       result;

    const Eigen::VectorXcd mass = bilinear(modes.pencil.mass, modes.left, modes.right);
    const Eigen::VectorXcd damping =
      modes.pencil.has_damping ? bilinear(modes.pencil.damping, modes.left, modes.right) : Eigen::VectorXcd(Eigen::VectorXcd::Zero(k));
    const Eigen::VectorXd left_masses = squares(modes.mass, modes.left), right_masses = squares(modes.mass, modes.right);
    const Eigen::VectorXd left_stiffnesses  = squares(modes.stiffness, modes.left),
                          right_stiffnesses = squares(modes.stiffness, modes.right);
    const Eigen::VectorXcd derivatives      = 2. * as_column(modes.lambda).cwiseProduct(mass) + damping;
    for (int j = 0; j < k; ++j)
      {
        const Complex lambda = modes.lambda[j], b = derivatives[j];
        result.corrections.push_back(smaller_root(mass[j], b, E(j, j)));
        result.errors.push_back(std::abs(result.corrections[j]) / std::abs(lambda));
        const double norms = std::sqrt(left_masses[j] * right_masses[j]);
        result.conditions.push_back(std::abs(b) > 0. ? 2. * std::abs(lambda) * norms / std::abs(b) :
                                                       std::numeric_limits<double>::infinity());
        result.energy_residuals.push_back(products.right_energies[j] / right_stiffnesses[j]);
        result.left_residuals.push_back(products.left_energies[j] / left_stiffnesses[j]);
      }
    result.couplings = derivatives.cwiseInverse().asDiagonal() * E;

    // Find modes that may coalesce
    for (int i = 0; i < k; ++i)
      {
        bool   alone = true, apart = true;
        double uncertainty = std::abs(result.corrections[i]);
        for (int j = 0; j < k; ++j)
          {
            // Two neutral modes may coalesce if their errors differ by more than their distance
            const double shift = error_safety * std::abs(result.corrections[i] - result.corrections[j]);
            if (shift >= std::abs(modes.lambda[i] - modes.lambda[j]) && shift > negligible_divergence * std::abs(modes.lambda[i]))
              apart = false;
            if (j != i && 4. * error_safety * error_safety * std::abs(E(i, j) * E(j, i)) >=
                            std::norm(modes.lambda[i] - modes.lambda[j]) * std::abs(derivatives[i] * derivatives[j]))
              {
                alone = false;
                uncertainty += std::abs(E(i, j)) / std::abs(derivatives[i]);
              }
          }
        const bool well_conditioned = result.conditions[i] <= largest_condition;
        result.claimed.push_back(alone && well_conditioned);
        result.uncertainties.push_back(uncertainty);
        result.verdicts.push_back(well_conditioned ? verdict_of(modes.lambda[i], uncertainty, alone && apart && !modes.pencil.has_damping) :
                                                     Verdict::undecided);
      }
    return result;
  }

  ComplexModes full_order_modes(const CoupledSystem       &system,
                                const UpdatedInverse      &inverse,
                                const ReducedModel        &model,
                                const ReducedModes        &modes,
                                const EigenvalueEstimates *estimates)
  {
    const auto   full = [&](const DenseMatrix &coefficients) { return std::make_shared<MultiVector>(model.basis() * coefficients); };
    ComplexModes result;
    result.lambda              = modes.lambda;
    result.real_part           = full(modes.right.real());
    result.imaginary_part      = full(modes.right.imag());
    result.left_real_part      = full(modes.left.real());
    result.left_imaginary_part = full(modes.left.imag());
    result.n_rigid_body        = modes.n_zeros / 2;
    if (estimates != nullptr)
      result.estimated_errors = estimates->errors;
    finish_modes(system, modes.values, inverse, result);
    return result;
  }
} // namespace Squeal
