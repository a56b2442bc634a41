// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/estimates/conditioning.h>
#include <squeal/estimates/mode_groups.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <tuple>

namespace Squeal
{
  namespace
  {
    constexpr int n_lanczos_steps = 15;
    /// The Krylov space is exhausted if the norm of a Lanczos vector relative to the previous one is below this limit [-].
    constexpr double negligible_beta = 1e-14;

    /// Eigenvalues λ with a smaller relative distance form one multiple eigenvalue [-].
    constexpr double width_of_clusters = 1e-7;

    using Operator = std::function<MultiVector(const MultiVector &)>;

    /// Smallest and largest Ritz value of a symmetric operator in a Krylov space.
    std::pair<double, double> extreme_ritz_values(const Operator &A, const RowMap &map)
    {
      MultiVector q = random_vectors(map, 1), before(map, 1);
      q *= 1. / column_norms(q)[0];
      DenseMatrix T    = DenseMatrix::Zero(n_lanczos_steps, n_lanczos_steps);
      double      beta = 0.;
      int         size = 0;
      while (size < std::min(n_lanczos_steps, map.n()))
        {
          MultiVector w = A(q);
          w -= beta * before;
          const double alpha = column_products(q, w)[0];
          w -= alpha * q;
          T(size, size) = alpha;
          beta          = column_norms(w)[0];
          ++size;
          if (size == std::min(n_lanczos_steps, map.n()) || !(beta > negligible_beta * std::abs(alpha)))
            break;
          T(size, size - 1) = T(size - 1, size) = beta;
          before                                = q;
          q                                     = (1. / beta) * w;
        }
      const auto values = symmetric_eigenpairs(DenseMatrix(T.topLeftCorner(size, size))).values;
      return {values.front(), values.back()};
    }

    /// Square roots of the diagonal entries, n × 1; 1 for zero entries.
    MultiVector root_of_diagonal(const SparseMatrix &A)
    {
      MultiVector       result(A.rows(), 1);
      SparseMatrix::Row row;
      for (int i = 0; i < result.n_local_rows(); ++i)
        {
          A.get_row(i, row);
          for (const auto &[column, value] : row)
            if (column == A.rows().number(i))
              result(i, 0) = std::sqrt(std::abs(value));
          if (result(i, 0) == 0.)
            result(i, 0) = 1.;
        }
      return result;
    }

    MultiVector product(const MultiVector &scaling, MultiVector X)
    {
      X.col(0).array() *= scaling.col(0).array();
      return X;
    }

    MultiVector quotient(MultiVector X, const MultiVector &scaling)
    {
      X.col(0).array() /= scaling.col(0).array();
      return X;
    }

    /// Smallest and largest Ritz value of D A D.
    std::pair<double, double> equilibrated_extremes(const SparseMatrix &A, const MultiVector &roots)
    {
      return extreme_ritz_values([&](const MultiVector &x) { return quotient(A * quotient(x, roots), roots); }, A.rows());
    }

    double condition_of_mass(const SparseMatrix &M)
    {
      const auto [smallest, largest] = equilibrated_extremes(M, root_of_diagonal(M));
      return largest / std::max(smallest, std::numeric_limits<double>::epsilon() * largest); // massless dofs have the eigenvalue zero
    }

    double condition_of_stiffness(const SparseMatrix &K, const UpdatedInverse &inverse)
    {
      const MultiVector roots = root_of_diagonal(K);
      const auto        inverse_max =
        extreme_ritz_values([&](const MultiVector &x) { return product(roots, inverse.solve_frictionless(product(roots, x))); }, K.rows());
      return equilibrated_extremes(K, roots).second * inverse_max.second;
    }

    /// |φ|ᵀ |K| |φ| of each mode.
    std::vector<double> sums_of_moduli(const SparseMatrix &K, const ComplexModes &modes)
    {
      const auto          K_moduli = moduli(K);
      std::vector<double> result;
      for_column_blocks(static_cast<int>(modes.lambda.size()), [&](const int first, const int n) {
        const MultiVector re = view(*modes.real_part, first, n), im = view(*modes.imaginary_part, first, n);
        MultiVector       size(re.map(), n, false);
        size.local()    = (re.local().array().square() + im.local().array().square()).sqrt().matrix();
        const auto sums = column_products(size, *K_moduli * size);
        result.insert(result.end(), sums.begin(), sums.end());
      });
      return result;
    }

    /// [Re Φ, Im Φ]ᵀ A [Re Φ, Im Φ].
    DenseMatrix products_of_halves(const ComplexModes &modes, const SparseMatrix &A)
    {
      const MultiVector &re = *modes.real_part, &im = *modes.imaginary_part;
      const Eigen::Index k     = re.n_columns();
      const DenseMatrix  mixed = weighted_gram(re, A, im);
      DenseMatrix        result(2 * k, 2 * k);
      result << weighted_gram(re, A), mixed, mixed.transpose(), weighted_gram(im, A);
      return result;
    }

    /// T with TᴴGT = I in each cluster: for a multiple eigenvalue, an eigensolver returns an arbitrary basis, whose condition number is
    /// meaningless.
    ComplexDenseMatrix orthonormal_within_clusters(const std::vector<std::complex<double>> &lambda, const ComplexDenseMatrix &G)
    {
      const int          k = static_cast<int>(lambda.size());
      ComplexDenseMatrix T = ComplexDenseMatrix::Identity(k, k);
      std::vector<bool>  done(k, false);
      for (int i = 0; i < k; ++i)
        {
          std::vector<int> members;
          for (int j = i; j < k; ++j)
            if (!done[j] && std::abs(lambda[i] - lambda[j]) <= width_of_clusters * std::abs(lambda[i]))
              members.push_back(j);
          for (const int j : members)
            done[j] = true;
          if (members.size() < 2)
            continue;
          const ComplexDenseMatrix among = G(members, members);
          const ComplexDenseMatrix L     = among.llt().matrixL();
          T(members, members)            = ComplexDenseMatrix(L.adjoint().inverse());
        }
      return T;
    }

    /// κ of each λ, and the condition number of G, from the products of modes with stiffness and mass.
    std::pair<std::vector<double>, double> conditions(const std::vector<std::complex<double>> &lambda,
                                                      const DenseMatrix                       &stiffness,
                                                      const DenseMatrix                       &mass)
    {
      // [Re X, Im X]ᵀ A [Re X, −Im X] gives Xᴴ A X̄
      const Eigen::Index k         = stiffness.rows() / 2;
      const auto         with_conj = [k](DenseMatrix products) {
        const ComplexDenseMatrix direct = hermitian_products(products);
        products.rightCols(k) *= -1.;
        const ComplexDenseMatrix crossed = hermitian_products(products);
        ComplexDenseMatrix       result(2 * k, 2 * k);
        result << direct, crossed, crossed.conjugate(), direct.conjugate();
        return result;
      };
      Eigen::VectorXcd values(2 * k);
      values << as_column(lambda), as_column(lambda).conjugate();
      ComplexDenseMatrix G =
        with_conj(stiffness) + ComplexDenseMatrix(values.conjugate().asDiagonal() * with_conj(mass) * values.asDiagonal());
      const Eigen::VectorXd scale = G.diagonal().real().cwiseAbs().cwiseSqrt().cwiseInverse();
      G                           = ComplexDenseMatrix(scale.asDiagonal() * G * scale.asDiagonal());
      const ComplexDenseMatrix T  = orthonormal_within_clusters(lambda, G.topLeftCorner(k, k));
      ComplexDenseMatrix       basis(ComplexDenseMatrix::Zero(2 * k, 2 * k));
      basis.topLeftCorner(k, k)     = T;
      basis.bottomRightCorner(k, k) = T.conjugate();
      G                             = ComplexDenseMatrix(basis.adjoint() * G * basis);

      // Real form of the Hermitian matrix G, in which every eigenvalue occurs twice
      DenseMatrix real(4 * k, 4 * k);
      real << G.real(), -G.imag(), G.imag(), G.real();
      const RealPairs     axes = symmetric_eigenpairs(real);
      std::vector<double> result;
      for (Eigen::Index j = 0; j < k; ++j)
        {
          double square = 0.;
          for (Eigen::Index i = 0; i < 4 * k; ++i)
            square += std::norm(axes.vectors(j, i)) / std::max(axes.values[i], std::numeric_limits<double>::epsilon());
          result.push_back(std::sqrt(square));
        }
      return {result, axes.values.back() / std::max(axes.values.front(), std::numeric_limits<double>::epsilon())};
    }
  } // namespace

  std::vector<double> complex_norms(const MultiVector &real_part, const MultiVector &imaginary_part)
  {
    std::vector<double>       result    = column_norms(real_part);
    const std::vector<double> imaginary = column_norms(imaginary_part);
    for (std::size_t j = 0; j < result.size(); ++j)
      result[j] = std::hypot(result[j], imaginary[j]);
    return result;
  }

  std::vector<double> pencil_norms(const CoupledSystem                     &system,
                                   const ParameterValues                   &values,
                                   const std::vector<std::complex<double>> &lambda)
  {
    const double M = norm_bound(system.terms, values, 2), C = norm_bound(system.terms, values, 1), K = norm_bound(system.terms, values, 0);
    std::vector<double> result;
    for (const std::complex<double> &value : lambda)
      result.push_back(std::abs(value) * (std::abs(value) * M + C) + K);
    return result;
  }

  std::vector<double> backward_errors(const CoupledSystem &system, const ParameterValues &values, const ComplexModes &modes)
  {
    const int                 n      = static_cast<int>(modes.lambda.size());
    const MultiVector         forces = force_residuals(system, values, modes.lambda, *modes.real_part, *modes.imaginary_part);
    std::vector<double>       result = complex_norms(view(forces, 0, n), view(forces, n, n));
    const std::vector<double> w      = pencil_norms(system, values, modes.lambda),
                              norms  = complex_norms(*modes.real_part, *modes.imaginary_part);
    for (int j = 0; j < n; ++j)
      result[j] /= w[j] * norms[j];
    return result;
  }

  double Conditioning::largest_error() const
  {
    return errors.empty() ? 0. : *std::max_element(errors.begin(), errors.end());
  }

  double Conditioning::digits() const
  {
    return std::max(0., -std::log10(std::max(largest_error(), std::numeric_limits<double>::epsilon())));
  }

  ModalProducts modal_products(const CoupledSystem &system, const ComplexModes &modes)
  {
    if (modes.lambda.empty())
      return {};
    return {products_of_halves(modes, *system.stiffness), products_of_halves(modes, *system.mass)};
  }

  Conditioning estimate_conditioning(const CoupledSystem  &system,
                                     const UpdatedInverse &inverse,
                                     const double          shift,
                                     const ComplexModes   &modes,
                                     const ModalProducts  &products)
  {
    const SparseMatrix &M = *system.mass;
    const auto          K = shift == 0. ? system.stiffness : add(1., *system.stiffness, shift * shift, M);
    Conditioning        result;
    result.stiffness = condition_of_stiffness(*K, inverse);
    result.mass      = condition_of_mass(M);
    if (modes.lambda.empty())
      return result;

    const DenseMatrix  &stiffness = products.stiffness;
    std::vector<double> gamma     = sums_of_moduli(*system.stiffness, modes);
    for (Eigen::Index j = 0, k = stiffness.rows() / 2; j < k; ++j)
      gamma[j] /= stiffness(j, j) + stiffness(k + j, k + j);
    std::tie(result.modes, result.span) = conditions(modes.lambda, stiffness, products.mass);
    result.largest_cancellation         = *std::max_element(gamma.begin(), gamma.end());
    for (std::size_t j = 0; j < modes.lambda.size(); ++j)
      {
        const double residual   = std::sqrt(std::abs(modes.energy_residuals[j]));
        result.largest_residual = std::max(result.largest_residual, residual);
        const double of_solver  = modes.estimated_errors.empty() ? 0.5 * result.modes[j] * residual : modes.estimated_errors[j];
        result.errors.push_back(of_solver + 0.5 * result.modes[j] * std::numeric_limits<double>::epsilon() * gamma[j]);
      }
    return result;
  }
} // namespace Squeal
