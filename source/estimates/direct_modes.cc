// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/conventions.h>
#include <squeal/base/text.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/eigen/quadratic_modes.h>
#include <squeal/estimates/direct_modes.h>
#include <squeal/linear_algebra/factorization.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Squeal
{
  namespace
  {
    /// Operator A⁻ᵀ from the factors of A.
    struct TransposedInverse : LinearOperator
    {
      explicit TransposedInverse(const Factorization &factor)
        : factor(factor)
      {}

      void apply(const MultiVector &X, MultiVector &Y) const override
      {
        factor.apply_transpose(X, Y);
      }

      const RowMap &map() const override
      {
        return factor.map();
      }

      const Factorization &factor;
    };

    std::shared_ptr<const SparseMatrix> transposed(const std::shared_ptr<const SparseMatrix> &A)
    {
      return A ? transpose(*A) : nullptr;
    }

    SecondOrderSystem transposed(const SecondOrderSystem &matrices)
    {
      SecondOrderSystem result;
      result.mass      = transposed(matrices.mass);
      result.damping   = transposed(matrices.damping);
      result.stiffness = transposed(matrices.stiffness);
      return result;
    }

    /// Sorts the columns of @p modes so that their eigenvalues match @p lambda; each is used once.
    QuadraticModes in_order_of(const std::vector<std::complex<double>> &lambda, const QuadraticModes &modes)
    {
      if (modes.values.size() != lambda.size())
        throw SolverError(text("the numbers of right and left modes differ: ", lambda.size(), " and ", modes.values.size()),
                          "complex modes", "change Band/Maximum frequency or Band/Maximum rate, or lower Complex modes/Tolerance");
      std::vector<int> rest(lambda.size()), order;
      for (std::size_t j = 0; j < rest.size(); ++j)
        rest[j] = static_cast<int>(j);
      for (const std::complex<double> &value : lambda)
        {
          const auto nearest = std::min_element(rest.begin(), rest.end(), [&](const int a, const int b) {
            return std::abs(modes.values[a] - value) < std::abs(modes.values[b] - value);
          });
          order.push_back(*nearest);
          rest.erase(nearest);
        }
      QuadraticModes result;
      result.real_part      = std::make_shared<MultiVector>(selected(*modes.real_part, order));
      result.imaginary_part = std::make_shared<MultiVector>(selected(*modes.imaginary_part, order));
      return result;
    }

    /// Ψᵀ A Φ.
    ComplexDenseMatrix product(const SparseMatrix &A, const ComplexModes &modes)
    {
      const auto         n = static_cast<Eigen::Index>(modes.lambda.size());
      const DenseMatrix  S = weighted_gram(join({modes.left_real_part.get(), modes.left_imaginary_part.get()}), A,
                                           join({modes.real_part.get(), modes.imaginary_part.get()}));
      ComplexDenseMatrix result(n, n);
      result.real() = S.topLeftCorner(n, n) - S.bottomRightCorner(n, n);
      result.imag() = S.topRightCorner(n, n) + S.bottomLeftCorner(n, n);
      return result;
    }

    /// D_ij = ψ_iᵀ ((λ_i + λ_j) M + C) φ_j.
    ComplexDenseMatrix products_by_lambda(const SecondOrderSystem &matrices, const ComplexModes &modes)
    {
      ComplexDenseMatrix result = product(*matrices.mass, modes);
      for (Eigen::Index j = 0; j < result.cols(); ++j)
        for (Eigen::Index i = 0; i < result.rows(); ++i)
          result(i, j) *= modes.lambda[i] + modes.lambda[j];
      if (matrices.damping)
        result += product(*matrices.damping, modes);
      return result;
    }

    /// Replaces the left vectors Ψ by Ψ D⁻ᵀ, whose products with the right vectors are the identity.
    void make_dual(ComplexModes &modes, const ComplexDenseMatrix &D)
    {
      const ComplexDenseMatrix X  = D.inverse().transpose();
      const DenseMatrix        re = X.real(), im = X.imag();
      MultiVector             &left = *modes.left_real_part, &left_im = *modes.left_imaginary_part;
      MultiVector              real_part = left * re - left_im * im;
      left_im                            = left * im + left_im * re;
      left                               = std::move(real_part);
    }
  } // namespace

  /// LU factors of Q(s). Throws a SolverError that names @p source if Q is also singular at another shift, and thus probably for all λ.
  static std::unique_ptr<Factorization> factors_at(const SecondOrderSystem &matrices, const double shift, const std::string &source)
  {
    constexpr double other  = 1.3;
    const auto       factor = [&](const double s) { return factorize_general(*pencil_at(matrices, s), "Q(s) at a real shift, " + source); };
    try
      {
        return factor(shift);
      }
    catch (const SolverError &)
      {
        try
          {
            factor(other * shift);
          }
        catch (const SolverError &)
          {
            throw SolverError(
              "Q(lambda) is singular at two shifts and probably for all lambda: a motion or a combination of equations may have no mass, "
              "damping or stiffness",
              source, "remove dependent rows and columns from all matrices, for example redundant constraints");
          }
        throw;
      }
  }

  std::shared_ptr<const SparseMatrix> inertia_square(const CoupledSystem &system, const double value, const double omega_max)
  {
    const auto M = sparse_matrices(system.terms, system.at(value)).mass;
    return add(omega_max * omega_max, *multiply(*transpose(*M), *M), 0., *M);
  }

  JudgedModes direct_modes(const CoupledSystem    &system,
                           const double            value,
                           const Band             &band,
                           const SolverParameters &solvers,
                           const std::string      &source,
                           Progress               &progress)
  {
    const ParameterValues   values   = system.at(value);
    const SecondOrderSystem matrices = sparse_matrices(system.terms, values), transpose = transposed(matrices);

    QuadraticModesOptions options;
    options.shift                      = band.end / band_per_stabilizing_shift;
    options.largest_circular_frequency = band.end;
    options.largest_damping            = band.largest_damping;
    options.largest_decay              = band.largest_decay;
    options.tolerance                  = solvers.complex_tolerance;
    options.stiffness_norm             = norm_bound(system.terms, values, 0);
    options.damping_norm               = norm_bound(system.terms, values, 1);
    options.report                     = [&](const std::string &state) { progress.update(state); };

    const auto           factor = factors_at(matrices, options.shift, source);
    const QuadraticModes right = quadratic_modes({matrices.mass.get(), matrices.damping.get(), matrices.stiffness.get()}, *factor, options);
    ComplexModes         modes;
    modes.real_values  = right.real_values;
    modes.n_rigid_body = right.n_zero_values / 2;
    if (right.values.empty())
      return judged_by_errors(std::move(modes), {}, matrices.damping != nullptr);
    const QuadraticModes left =
      in_order_of(right.values, quadratic_modes({transpose.mass.get(), transpose.damping.get(), transpose.stiffness.get()},
                                                TransposedInverse(*factor), options));

    modes.lambda              = right.values;
    modes.real_part           = right.real_part;
    modes.imaginary_part      = right.imaginary_part;
    modes.left_real_part      = left.real_part;
    modes.left_imaginary_part = left.imaginary_part;
    modes.residuals           = right.residuals;
    modes.summary             = text("LU factors of Q at ", exact_text(options.shift), " 1/s, ", counted(right.n_solves, "solve"));

    make_dual(modes, products_by_lambda(matrices, modes));

    const auto weights = pencil_norms(system, values, modes.lambda), backward = backward_errors(system, values, modes),
               right_norms = complex_norms(*modes.real_part, *modes.imaginary_part),
               left_norms  = complex_norms(*modes.left_real_part, *modes.left_imaginary_part);
    Conditioning conditioning{};
    for (std::size_t j = 0; j < modes.lambda.size(); ++j)
      {
        conditioning.modes.push_back(weights[j] * left_norms[j] * right_norms[j] / std::abs(modes.lambda[j]));
        conditioning.errors.push_back(conditioning.modes.back() * std::max(backward[j], std::numeric_limits<double>::epsilon()));
      }
    return judged_by_errors(std::move(modes), std::move(conditioning), matrices.damping != nullptr);
  }
} // namespace Squeal
