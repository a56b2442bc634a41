// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/linear_algebra/multivector.h>
#include <squeal/eigen/quadratic_modes.h>
#include <squeal/modes/complex_modes.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace Squeal
{
  namespace
  {
    /// Y_j += c_j (x_j + i y_j) for the columns of complex vectors stored as real and imaginary halves.
    void add_scaled(MultiVector &Y, const std::vector<std::complex<double>> &c, const MultiVector &X)
    {
      const int k = X.n_columns() / 2;
      for (int j = 0; j < k; ++j)
        {
          Y.col(j) += c[j].real() * X.col(j) - c[j].imag() * X.col(k + j);
          Y.col(k + j) += c[j].real() * X.col(k + j) + c[j].imag() * X.col(j);
        }
    }

    /// Scales every vector to φᴴ M φ = 1 with its entry of largest modulus real and positive.
    void normalize(const SparseMatrix &M, MultiVector &real_part, MultiVector &imaginary_part)
    {
      fix_phase(real_part, imaginary_part);
      const std::vector<double> of_real      = column_products(real_part, M * real_part),
                                of_imaginary = column_products(imaginary_part, M * imaginary_part);
      for (MultiVector *part : {&real_part, &imaginary_part})
        for (int j = 0; j < part->n_columns(); ++j)
          part->col(j) /= std::sqrt(of_real[j] + of_imaginary[j]);
    }

  } // namespace

  std::vector<double> complex_products(const MultiVector &X, const MultiVector &Y)
  {
    const int           k      = X.n_columns() / 2;
    std::vector<double> result = column_products(X, Y);
    std::transform(result.begin(), result.begin() + k, result.begin() + k, result.begin(), std::plus<>());
    result.resize(k);
    return result;
  }

  MultiVector force_residuals(const CoupledSystem                     &system,
                              const ParameterValues                   &values,
                              const std::vector<std::complex<double>> &lambda,
                              const MultiVector                       &real_part,
                              const MultiVector                       &imaginary_part,
                              const bool                               left)
  {
    const MultiVector                 X = join({&real_part, &imaginary_part});
    MultiVector                       R = times(system.terms, values, 0, X, left);
    std::vector<std::complex<double>> factors(lambda.size(), 1.);
    for (const int power : {1, 2})
      {
        std::transform(factors.begin(), factors.end(), lambda.begin(), factors.begin(), std::multiplies<>());
        if (!terms_of(system.terms, values, power).empty())
          add_scaled(R, factors, times(system.terms, values, power, X, left));
      }
    return R;
  }

  void finish_modes(const CoupledSystem &system, const ParameterValues &values, const UpdatedInverse &inverse, ComplexModes &modes)
  {
    const int k = modes.lambda.size();
    if (k == 0)
      return;

    // Sort by frequency, and modes of equal frequency by growth rate
    std::vector<int> order(k);
    std::iota(order.begin(), order.end(), 0);
    constexpr double equal = 1e-9;
    std::sort(order.begin(), order.end(), [&](const int a, const int b) {
      return std::make_pair(modes.lambda[a].imag(), modes.lambda[a].real()) <
             std::make_pair(modes.lambda[b].imag(), modes.lambda[b].real());
    });
    for (int j = 0; j + 1 < k; ++j)
      {
        const auto &a = modes.lambda[order[j]], &b = modes.lambda[order[j + 1]];
        if (b.imag() - a.imag() < equal * b.imag() && a.real() > b.real())
          std::swap(order[j], order[j + 1]);
      }
    const auto reorder = [&](auto &values) {
      const auto unsorted = values;
      for (std::size_t j = 0; j < values.size(); ++j)
        values[j] = unsorted[order[j]];
    };
    reorder(modes.lambda);
    reorder(modes.estimated_errors);
    for (const auto part : {&modes.real_part, &modes.imaginary_part, &modes.left_real_part, &modes.left_imaginary_part})
      if (*part)
        (*part)->local() = DenseMatrix((*part)->local()(Eigen::placeholders::all, order));

    normalize(*system.mass, *modes.real_part, *modes.imaginary_part);
    if (modes.left_real_part)
      normalize(*system.mass, *modes.left_real_part, *modes.left_imaginary_part);

    // Compute residuals of a few modes at a time to limit the memory
    constexpr int modes_together = 16;
    modes.residuals.resize(k);
    modes.energy_residuals.resize(k);
    for (int first = 0; first < k; first += modes_together)
      {
        const int         n    = std::min(modes_together, k - first);
        const MultiVector real = view(*modes.real_part, first, n), imaginary = view(*modes.imaginary_part, first, n);
        const MultiVector X  = join({&real, &imaginary});
        const MultiVector KX = *system.stiffness * X;
        const MultiVector R =
          force_residuals(system, values, {modes.lambda.begin() + first, modes.lambda.begin() + first + n}, real, imaginary);
        const MultiVector U   = inverse.solve_frictionless(R);
        const auto        R_R = complex_products(R, R), KX_KX = complex_products(KX, KX), U_R = complex_products(U, R),
                   X_KX = complex_products(X, KX);
        for (int j = 0; j < n; ++j)
          {
            modes.residuals[first + j]        = std::sqrt(R_R[j] / KX_KX[j]);
            modes.energy_residuals[first + j] = U_R[j] / X_KX[j];
          }
      }
  }

  Verdict verdict_of(const std::complex<double> &lambda, const double error, const bool growth_needs_coalescence)
  {
    const double rate = lambda.real(), uncertainty = error_safety * error, negligible = negligible_divergence * lambda.imag();
    if (rate / (negligible + uncertainty) > 1.)
      return Verdict::unstable;
    if (!(rate + (growth_needs_coalescence && !std::isnan(error) ? 0. : uncertainty) <= negligible))
      return Verdict::undecided;
    return rate >= -negligible ? Verdict::neutral : Verdict::stable;
  }
} // namespace Squeal
