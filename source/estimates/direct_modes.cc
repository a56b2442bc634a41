#include <squeal/base/exceptions.h>
#include <squeal/base/conventions.h>
#include <squeal/base/text.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/eigen/quadratic_modes.h>
#include <squeal/estimates/direct_modes.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/factorization.h>
#include <squeal/modes/contour_count.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Squeal
{
  namespace
  {
    const char *const what = "Q(s) at a real shift";

    /// A⁻ᵀ by the factors of A.
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

    /// √(‖A‖_1 ‖A‖_∞) ≥ ‖A‖_2.
    double norm_of(const SparseMatrix *A, const SparseMatrix *transpose)
    {
      return A ? std::sqrt(row_sum_norm(*A) * row_sum_norm(*transpose)) : 0.;
    }

    /// Columns of @p modes in the order of @p lambda, each taken once.
    QuadraticModes in_order_of(const std::vector<std::complex<double>> &lambda, const QuadraticModes &modes)
    {
      if (modes.values.size() != lambda.size())
        throw SolverError(text(lambda.size(), " right and ", modes.values.size(), " left modes were found"), "complex modes",
                          "move Band/Maximum frequency off the mode next to it, or lower Complex modes/Tolerance");
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

    std::vector<double> complex_norms(const MultiVector &real_part, const MultiVector &imaginary_part)
    {
      std::vector<double>       result    = column_norms(real_part);
      const std::vector<double> imaginary = column_norms(imaginary_part);
      for (std::size_t j = 0; j < result.size(); ++j)
        result[j] = std::hypot(result[j], imaginary[j]);
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

    /// Ψ ← Ψ D⁻ᵀ, so that the products D of left and right vectors become the identity.
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

  DirectModes direct_modes(const CoupledSystem    &system,
                           const double            value,
                           const double            largest_circular_frequency,
                           const SolverParameters &solvers,
                           Progress               &progress)
  {
    const ParameterValues   values   = system.at(value);
    const SecondOrderSystem matrices = sparse_matrices(system.terms, values), transpose = transposed(matrices);
    const auto              norm = [&](const std::shared_ptr<const SparseMatrix> SecondOrderSystem::*member) {
      return norm_of((matrices.*member).get(), (transpose.*member).get());
    };
    const double norm_M = norm(&SecondOrderSystem::mass), norm_C = norm(&SecondOrderSystem::damping),
                 norm_K = norm(&SecondOrderSystem::stiffness);

    QuadraticModesOptions options;
    options.shift                      = largest_circular_frequency / band_per_stabilizing_shift;
    options.largest_circular_frequency = largest_circular_frequency;
    options.largest_damping            = largest_rate_of_band;
    options.tolerance                  = solvers.complex_tolerance;
    options.stiffness_norm             = norm_K;
    options.damping_norm               = norm_C;
    options.report                     = [&](const std::string &state) { progress.update(state); };

    const auto           factor = factorize_general(*pencil_at(matrices, options.shift), what);
    const QuadraticModes right = quadratic_modes({matrices.mass.get(), matrices.damping.get(), matrices.stiffness.get()}, *factor, options);
    if (right.values.empty())
      throw SolverError("no oscillating mode lies in the band", "complex modes", "raise Band/Maximum frequency");
    const QuadraticModes left =
      in_order_of(right.values, quadratic_modes({transpose.mass.get(), transpose.damping.get(), transpose.stiffness.get()},
                                                TransposedInverse(*factor), options));

    ComplexModes modes;
    modes.lambda              = right.values;
    modes.real_part           = right.real_part;
    modes.imaginary_part      = right.imaginary_part;
    modes.left_real_part      = left.real_part;
    modes.left_imaginary_part = left.imaginary_part;
    modes.residuals           = right.residuals;
    modes.real_values         = right.real_values;
    modes.n_rigid_body        = right.n_zero_values / 2;
    modes.summary             = text("LU factors of Q at ", exact_text(options.shift), " 1/s, ", right.n_solves, " solves");

    make_dual(modes, products_by_lambda(matrices, modes));

    const MultiVector forces    = force_residuals(system, values, modes.lambda, *modes.real_part, *modes.imaginary_part);
    const int         n         = static_cast<int>(modes.lambda.size());
    const auto        residuals = complex_norms(view(forces, 0, n), view(forces, n, n)),
               right_norms      = complex_norms(*modes.real_part, *modes.imaginary_part),
               left_norms       = complex_norms(*modes.left_real_part, *modes.left_imaginary_part);
    Conditioning        conditioning{};
    std::vector<double> backward_errors;
    for (int j = 0; j < n; ++j)
      {
        const double modulus = std::abs(modes.lambda[j]), weight = modulus * (modulus * norm_M + norm_C) + norm_K;
        backward_errors.push_back(residuals[j] / (weight * right_norms[j]));
        conditioning.modes.push_back(weight * left_norms[j] * right_norms[j] / modulus);
        conditioning.errors.push_back(conditioning.modes.back() * std::max(backward_errors.back(), std::numeric_limits<double>::epsilon()));
      }

    DirectModes    result{judged_by_errors(std::move(modes), std::move(conditioning), matrices.damping != nullptr),
                       std::move(backward_errors),
                       {}};
    ContourOptions contour;
    contour.largest_circular_frequency = largest_circular_frequency;
    contour.lowest_frequency           = 1e-3 * largest_circular_frequency;
    contour.largest_growth             = largest_rate_of_band * largest_circular_frequency;
    if (n_processes(matrices.mass->communicator()) == 1)
      {
        progress.update("count by the argument principle");
        result.n_counted   = count_by_sparse_lu(matrices, contour, progress).n_modes;
        const auto n_found = std::count_if(right.values.begin(), right.values.end(), [&](const std::complex<double> &lambda) {
          return std::abs(lambda.real()) <= contour.largest_growth && lambda.imag() >= contour.lowest_frequency;
        });
        if (*result.n_counted != n_found)
          throw SolverError(text(n_found, " complex modes were found in the band, ", *result.n_counted, " are counted"), "complex modes",
                            "lower Complex modes/Tolerance, or move Band/Maximum frequency");
      }
    return result;
  }
} // namespace Squeal
