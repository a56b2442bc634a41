// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/eigen/dense_quadratic.h>
#include <squeal/linear_algebra/dense_eigenproblems.h>
#include <squeal/linear_algebra/dense_lu.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Corrections above this fraction of |λ| are omitted: they indicate a nearly defective eigenvalue, with ψᵀQ'(λ)φ ≈ 0 [-].
    constexpr double largest_correction = 1e-6;
    /// ‖M − I‖_F up to this limit is attributed to rounding errors of modal coordinates: M⁻¹ is omitted, but eigenvalues are corrected with
    /// M.
    constexpr double unit_mass = 1e-11;
    /// |Im λ| / |λ| below which λ is certainly real [-].
    constexpr double surely_real = 1e-13;
    /// |Im λ| / |λ| up to which λ counts as real: above rounding errors of corrected eigenvalues, far below the values of oscillating modes
    /// [-].
    constexpr double real_dense = 1e-12;

    /// Square root of a real or complex number with Im λ ≥ 0.
    Complex upper_root(const Complex square)
    {
      if (square.imag() == 0.)
        return square.real() < 0. ? Complex(0., std::sqrt(-square.real())) : Complex(std::sqrt(square.real()), 0.);
      const Complex root = std::sqrt(square);
      return root.imag() < 0. ? -root : root;
    }

    /// One correction λ -= ψᵀQ(λ)φ / ψᵀQ'(λ)φ for each well-conditioned eigenvalue.
    void correct(DenseQuadraticModes &modes, const DenseMatrix &M, const DenseMatrix *C, const DenseMatrix &K)
    {
      const ComplexDenseMatrix m = multiply(M, modes.right), k = multiply(K, modes.right);
      const ComplexDenseMatrix c = C != nullptr ? multiply(*C, modes.right) : ComplexDenseMatrix::Zero(m.rows(), m.cols());
      for (std::size_t j = 0; j < modes.values.size(); ++j)
        {
          const Complex lambda     = modes.values[j];
          const auto    psi        = modes.left.col(j).transpose();
          const Complex value      = psi * (lambda * (lambda * m.col(j) + c.col(j)) + k.col(j));
          const Complex derivative = psi * (2. * lambda * m.col(j) + c.col(j));
          if (std::abs(value) < largest_correction * std::abs(lambda) * std::abs(derivative))
            modes.values[j] -= value / derivative;
        }
    }

    /// Indices of the requested eigenvalues in the order of the result; stores real eigenvalues in @p modes.
    std::vector<int> sorted_values(const int                          n,
                                   const std::function<Complex(int)> &value,
                                   const bool                         linear,
                                   const double                       largest_circular_frequency,
                                   const RealVectors                  real_vectors,
                                   DenseQuadraticModes               &modes)
    {
      std::vector<int> wanted;
      for (int j = 0; j < n; ++j)
        {
          const Complex lambda = value(j);
          if (!(std::abs(lambda.imag()) / std::abs(lambda) > real_dense))
            {
              modes.real_values.push_back(lambda.real());
              if (linear)
                modes.real_values.push_back(-lambda.real());
              if (real_vectors == RealVectors::wanted)
                wanted.push_back(j);
            }
          else if (lambda.imag() > 0. && lambda.imag() <= largest_circular_frequency)
            wanted.push_back(j);
        }
      std::sort(modes.real_values.begin(), modes.real_values.end());
      std::stable_sort(wanted.begin(), wanted.end(), [&value](const int a, const int b) {
        const Complex x = value(a), y = value(b);
        return x.imag() != y.imag() ? x.imag() < y.imag() : x.real() < y.real();
      });
      return wanted;
    }

    /// Computes dense_quadratic_modes(), or, with @p squares, dense_modes_of_band().
    std::optional<DenseQuadraticModes> found_modes(const DenseMatrix         &mass,
                                                   const DenseMatrix         *damping,
                                                   const DenseMatrix         &stiffness,
                                                   const double               largest_circular_frequency,
                                                   const RealVectors          real_vectors,
                                                   const std::vector<double> *squares)
    {
      DenseQuadraticModes modes;
      const int           r = mass.rows();
      if (r == 0)
        return modes;
      const double size = stiffness.norm(), unit = size > 0. ? std::sqrt(size / mass.norm()) : 1.;

      // ------------------------------------------------- companion form in units of the scale
      const bool                  is_unit = (mass - DenseMatrix::Identity(r, r)).norm() <= unit_mass;
      const std::optional<RealLU> factors =
        is_unit ? std::nullopt : std::optional(regular_lu(mass, "mass matrix of a small quadratic pencil"));
      const bool                   linear = damping == nullptr;
      const DenseMatrix            A      = factors ? factors->solve(stiffness) : stiffness;
      DenseMatrix                  companion;
      std::optional<BandSubspaces> band;
      const DenseMatrix            C = linear ? DenseMatrix() : factors ? factors->solve(*damping) : *damping;
      if (squares != nullptr)
        {
          band = linear ? band_subspaces(A, *squares, largest_circular_frequency) :
                          damped_band_subspaces(A, C, *squares, largest_circular_frequency);
          if (!band)
            return {};
          if (!linear)
            {
              band->right.bottomRows(r) /= unit;
              band->left.bottomRows(r) *= unit;
            }
        }
      if (linear)
        companion = (band ? band->small : A) / (-unit * unit);
      else if (band)
        companion = band->small / unit;
      else
        {
          companion                        = DenseMatrix::Zero(2 * r, 2 * r);
          companion.bottomLeftCorner(r, r) = A / (-unit * unit);
          companion.topRightCorner(r, r).setIdentity();
          companion.bottomRightCorner(r, r) = C / -unit;
        }
      const auto lambda_of = [&](const Complex &of_companion) { return unit * (linear ? upper_root(of_companion) : of_companion); };
      // Compute vectors only for the values selected below and a few others
      const DenseEigenpairs pairs = eigenpairs(companion, [&](const Complex &of_companion) {
        const Complex lambda = lambda_of(of_companion);
        return std::abs(lambda.imag()) <= largest_circular_frequency &&
               (real_vectors == RealVectors::wanted || std::abs(lambda.imag()) > surely_real * std::abs(lambda));
      });

      const auto             value = [&](const int j) { return lambda_of(pairs.values[j]); };
      const std::vector<int> wanted =
        sorted_values(static_cast<int>(companion.rows()), value, linear, largest_circular_frequency, real_vectors, modes);

      // ------------------------------------------------- vectors
      const int k = static_cast<int>(wanted.size());
      modes.right = modes.left = ComplexDenseMatrix(r, k);
      if (k == 0)
        return modes;
      // LAPACK's left vectors satisfy yᴴ A = λ yᴴ; ψ is the conjugate of y
      std::vector<int> columns;
      for (const int j : wanted)
        columns.push_back(static_cast<int>(std::lower_bound(pairs.numbers.begin(), pairs.numbers.end(), j) - pairs.numbers.begin()));
      ComplexDenseMatrix right_parts = pairs.right(Eigen::placeholders::all, columns),
                         left_parts  = pairs.left(Eigen::placeholders::all, columns).conjugate();
      if (band)
        {
          right_parts = multiply(band->right, right_parts);
          left_parts  = multiply(band->left, left_parts);
        }
      modes.left = left_parts.bottomRows(r);
      if (factors)
        modes.left =
          from_halves(sparing_zeros(halves(modes.left), [&factors](const DenseMatrix &X) { return factors->solve_transposed(X); }));
      for (int j = 0; j < k; ++j)
        {
          modes.values.push_back(value(wanted[j]));
          const bool lower   = std::abs(modes.values[j]) > unit;
          modes.right.col(j) = right_parts.col(j).segment(lower && !linear ? r : 0, r);
        }
      normalize_columns(modes.right);
      normalize_columns(modes.left);
      correct(modes, mass, damping, stiffness);
      return modes;
    }
  } // namespace

  void normalize_columns(ComplexDenseMatrix &X)
  {
    for (Eigen::Index j = 0; j < X.cols(); ++j)
      if (const double largest = X.col(j).cwiseAbs().maxCoeff(); largest > 0.)
        {
          // Use the first entry among those of equal modulus
          const auto    x = X.col(j);
          const Complex pivot =
            *std::find_if(x.begin(), x.end(), [largest](const Complex &y) { return std::abs(y) >= (1. - 1e-8) * largest; });
          X.col(j) *= std::conj(pivot) / (std::abs(pivot) * x.norm());
        }
  }

  DenseQuadraticModes dense_quadratic_modes(const DenseMatrix &mass,
                                            const DenseMatrix *damping,
                                            const DenseMatrix &stiffness,
                                            const double       largest_circular_frequency,
                                            const RealVectors  real_vectors)
  {
    return *found_modes(mass, damping, stiffness, largest_circular_frequency, real_vectors, nullptr);
  }

  std::optional<DenseQuadraticModes> dense_modes_of_band(const DenseMatrix         &mass,
                                                         const DenseMatrix         *damping,
                                                         const DenseMatrix         &stiffness,
                                                         const std::vector<double> &squares,
                                                         const double               largest_circular_frequency)
  {
    return found_modes(mass, damping, stiffness, largest_circular_frequency, RealVectors::none, &squares);
  }
} // namespace Squeal
