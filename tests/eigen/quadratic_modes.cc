// SPDX-License-Identifier: GPL-3.0-or-later

#include "matrices.h"

#include <squeal/base/exceptions.h>
#include <squeal/eigen/quadratic_modes.h>
#include <squeal/linear_algebra/dense_eigenproblems.h>
#include <squeal/linear_algebra/dense_lu.h>
#include <squeal/linear_algebra/multivector.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{
  using namespace Squeal;
  using namespace Squeal::Testing;

  /// A small quadratic pencil and its inverse at a shift.
  struct DensePencil
  {
    DensePencil(const DenseMatrix &M, const DenseMatrix *C, const DenseMatrix &K, const double shift = 0.)
      : mass(sparse(M))
      , damping(C != nullptr ? sparse(*C) : nullptr)
      , stiffness(sparse(K))
      , inverse(sparse(inverse_of(C != nullptr ? K + shift * shift * M + shift * *C : DenseMatrix(K + shift * shift * M))))
      , pencil{mass.get(), damping.get(), stiffness.get()}
    {
      options.shift = shift;
    }

    static DenseMatrix inverse_of(const DenseMatrix &A)
    {
      return regular_lu(A, "test matrix").solve(DenseMatrix::Identity(A.rows(), A.rows()));
    }

    QuadraticModes modes(const double largest_circular_frequency)
    {
      options.largest_circular_frequency = largest_circular_frequency;
      return quadratic_modes(pencil, *inverse, options);
    }

    std::shared_ptr<const SparseMatrix> mass, damping, stiffness, inverse;
    QuadraticPencil                     pencil;
    QuadraticModesOptions               options;
  };

  DenseMatrix diagonal_matrix(const std::vector<double> &values)
  {
    return as_column(values).asDiagonal();
  }

  DenseMatrix random_matrix(const int n, const unsigned int seed)
  {
    const RowMap map = RowMap::even(n, MPI_COMM_WORLD);
    return gram(unit_vectors(map), random_vectors(map, n, seed));
  }

  /// All eigenvalues of the companion form with 0 < Im λ ≤ largest, ascending by Im.
  std::vector<Complex> companion_values(const DenseMatrix &M, const DenseMatrix &C, const DenseMatrix &K, const double largest)
  {
    const int    n         = M.rows();
    const RealLU factors   = regular_lu(M, "mass");
    DenseMatrix  companion = DenseMatrix::Zero(2 * n, 2 * n);
    companion << DenseMatrix::Zero(n, n), DenseMatrix::Identity(n, n), -factors.solve(K), -factors.solve(C);
    std::vector<Complex> values;
    for (const Complex &value : eigenpairs(companion).values)
      if (value.imag() > 1e-6 * std::abs(value) && value.imag() <= largest)
        values.push_back(value);
    std::sort(values.begin(), values.end(), [](const Complex &x, const Complex &y) { return x.imag() < y.imag(); });
    return values;
  }

  void expect_same(const std::vector<Complex> &values, const std::vector<Complex> &expected, const double relative)
  {
    EXPECT_LT(largest(distances(expected, values)), relative);
  }

  /// Stiffness of a mass-spring chain.
  DenseMatrix chain(const int n)
  {
    DenseMatrix K = DenseMatrix::Zero(n, n);
    for (int i = 0; i < n; ++i)
      {
        K(i, i) = 2.;
        if (i + 1 < n)
          K(i, i + 1) = K(i + 1, i) = -1.;
      }
    return K;
  }

  double chain_frequency(const int n, const int i)
  {
    return 2. * std::sin(0.5 * M_PI * i / (n + 1));
  }
} // namespace

TEST(QuadraticModes, DampedOscillators)
{
  // Roots of λ² + 2 ζ ω λ + ω² = 0, with two overdamped oscillators
  const int            n = 60;
  std::vector<double>  stiffness(n), damping(n);
  std::vector<Complex> expected;
  std::vector<double>  expected_real;
  for (int i = 0; i < n; ++i)
    {
      const double omega = 1. + i, zeta = i == 3 || i == 5 ? 1.1 : 0.01 * (i % 7);
      stiffness[i] = omega * omega;
      damping[i]   = 2. * zeta * omega;
      if (zeta < 1. && omega * std::sqrt(1. - zeta * zeta) <= 20.5)
        expected.emplace_back(-zeta * omega, omega * std::sqrt(1. - zeta * zeta));
      if (zeta > 1.)
        for (const double sign : {-1., 1.})
          expected_real.push_back(-zeta * omega + sign * omega * std::sqrt(zeta * zeta - 1.));
    }
  std::sort(expected_real.begin(), expected_real.end());
  const DenseMatrix C = diagonal_matrix(damping);
  for (const double shift : {0., 3.})
    {
      DensePencil pencil(DenseMatrix::Identity(n, n), &C, diagonal_matrix(stiffness), shift);
      pencil.options.expected = 18;
      const auto modes        = pencil.modes(20.5);
      expect_same(modes.values, expected, 1e-10);
      ASSERT_EQ(modes.real_values.size(), expected_real.size());
      for (std::size_t i = 0; i < expected_real.size(); ++i)
        EXPECT_NEAR(modes.real_values[i], expected_real[i], 1e-9 * std::abs(expected_real[i]));
      for (const double residual : modes.residuals)
        EXPECT_LT(residual, pencil.options.tolerance);
    }
}

TEST(QuadraticModes, CopiesBeyondTheBlockSizeAreAllFound)
{
  // Eigenvalues of twelve equal chains are twelvefold, and the block size is only four
  const int   n = 20, n_copies = 12;
  DenseMatrix K = DenseMatrix::Zero(n * n_copies, n * n_copies);
  for (int copy = 0; copy < n_copies; ++copy)
    K.block(copy * n, copy * n, n, n) = chain(n);
  const DenseMatrix    C = 0.02 * K;
  std::vector<Complex> undamped, damped;
  const double         largest = 1.05;
  for (int i = 1; i <= n; ++i)
    {
      const double omega = chain_frequency(n, i), zeta = 0.01 * omega;
      for (int copy = 0; copy < n_copies; ++copy)
        {
          if (omega <= largest)
            undamped.emplace_back(0., omega);
          if (omega * std::sqrt(1. - zeta * zeta) <= largest)
            damped.emplace_back(-zeta * omega, omega * std::sqrt(1. - zeta * zeta));
        }
    }
  const DenseMatrix I = DenseMatrix::Identity(n * n_copies, n * n_copies);
  DensePencil       without(I, nullptr, K), with(I, &C, K);
  without.options.expected = static_cast<int>(undamped.size());
  with.options.expected    = static_cast<int>(damped.size());
  expect_same(without.modes(largest).values, undamped, 1e-10);
  expect_same(with.modes(largest).values, damped, 1e-10);
}

TEST(QuadraticModes, NonsymmetricAgreesWithTheCompanionForm)
{
  const int         n = 120;
  const DenseMatrix R = random_matrix(n, 3), S = random_matrix(n, 4), T = random_matrix(n, 5);
  const DenseMatrix M = DenseMatrix::Identity(n, n) + 0.01 * R, C = 1e-3 * S.transpose() * S + 1e-3 * T;
  DenseMatrix       K = 0.5 * T;
  for (int i = 0; i < n; ++i)
    K(i, i) += std::pow(1. + 0.3 * i, 2);
  const double               largest  = 12.;
  const std::vector<Complex> expected = companion_values(M, C, K, largest);
  ASSERT_GT(expected.size(), 30u);

  for (const double shift : {0., 2.})
    for (const int block : {1, 3, 8})
      {
        DensePencil pencil(M, &C, K, shift);
        pencil.options.expected   = 35;
        pencil.options.block_size = block;
        expect_same(pencil.modes(largest).values, expected, 1e-9);
      }
}

TEST(QuadraticModes, RestartsGiveTheSameValues)
{
  const int         n = 300;
  const DenseMatrix K = chain(n), C = 0.01 * K * K;
  for (const DenseMatrix *damping : {static_cast<const DenseMatrix *>(nullptr), &C})
    {
      const int            degree  = damping != nullptr ? 2 : 1;
      const double         largest = 0.2;
      std::vector<Complex> expected;
      for (int i = 1; i <= n; ++i)
        {
          const double square = std::pow(chain_frequency(n, i), 2);
          const double rate   = damping != nullptr ? 0.005 * square * square : 0.;
          const double omega  = std::sqrt(std::max(0., square - rate * rate));
          if (omega <= largest)
            expected.emplace_back(-rate, omega);
        }
      DensePencil pencil(DenseMatrix::Identity(n, n), damping, K, 0.);
      pencil.options.expected   = static_cast<int>(expected.size());
      pencil.options.block_size = 2;
      pencil.options.max_basis  = degree * (static_cast<int>(expected.size()) + 12);
      const auto modes          = pencil.modes(largest);
      EXPECT_GT(modes.n_restarts, 0);
      expect_same(modes.values, expected, 1e-10);
    }
}

TEST(QuadraticModes, ZeroDampingKeepsTheSymmetryOfTheSpectrum)
{
  const int         n = 100;
  DenseMatrix       K = chain(n) * chain(n), zero = DenseMatrix::Zero(n, n);
  const DenseMatrix R = random_matrix(n, 9);
  K += 1e-4 * R;
  DensePencil quadratic(DenseMatrix::Identity(n, n), &zero, K, 0.), linear(DenseMatrix::Identity(n, n), nullptr, K, 0.);
  quadratic.options.expected = linear.options.expected = 20;
  const auto one = linear.modes(0.4), two = quadratic.modes(0.4);
  ASSERT_GT(one.values.size(), 15u);
  expect_same(two.values, one.values, 1e-9);
  // Without a damping matrix, the spectrum is symmetric within rounding errors
  for (const auto &[values, relative] : {std::make_pair(one.values, 1e-15), {two.values, 1e-9}})
    for (const Complex &value : values)
      EXPECT_TRUE(std::any_of(values.begin(), values.end(), [&value = value, relative = relative](const Complex &other) {
        return std::abs(other + std::conj(value)) <= relative * std::abs(value);
      }));
}

TEST(QuadraticModes, FreeBodyNeedsAShift)
{
  // K of two free chains is singular, with one rigid-body mode per chain
  const int   n     = 40;
  DenseMatrix K     = DenseMatrix::Zero(2 * n, 2 * n);
  DenseMatrix alone = chain(n);
  alone(0, 0) = alone(n - 1, n - 1) = 1.;
  K.topLeftCorner(n, n) = K.bottomRightCorner(n, n) = alone;
  const double         largest                      = 0.8;
  std::vector<Complex> expected;
  for (int i = 1; chain_frequency(n - 1, i) <= largest; ++i)
    expected.insert(expected.end(), 2, Complex(0., chain_frequency(n - 1, i)));
  const auto modes = DensePencil(DenseMatrix::Identity(2 * n, 2 * n), nullptr, K, 0.3).modes(largest);
  expect_same(modes.values, expected, 1e-10);
  EXPECT_EQ(modes.n_zero_values, 4);
}

TEST(QuadraticModes, NonConvergenceIsRefused)
{
  const int         n = 300;
  const DenseMatrix K = chain(n);
  DensePencil       pencil(DenseMatrix::Identity(n, n), nullptr, K, 0.);
  pencil.options.expected     = 20;
  pencil.options.block_size   = 2;
  pencil.options.max_basis    = 26;
  pencil.options.max_restarts = 1;
  EXPECT_THROW(pencil.modes(0.21), SolverError);
}
