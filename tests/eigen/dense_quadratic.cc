// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/eigen/band_subspaces.h>
#include <squeal/eigen/dense_quadratic.h>

#include <Eigen/LU>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

namespace
{
  using namespace Squeal;
  using Complex = std::complex<double>;

  DenseMatrix random_entries(const int n, const unsigned int seed)
  {
    std::mt19937                           generator(seed);
    std::uniform_real_distribution<double> entry(-1., 1.);
    return DenseMatrix::NullaryExpr(n, n, [&] { return entry(generator); });
  }

  /// A pencil with the properties of a reduced model: diagonal stiffness over a wide range, nonsymmetric coupling, low-rank damping.
  struct Pencil
  {
    explicit Pencil(const int n)
      : M(DenseMatrix::Identity(n, n) + 0.1 / n * random_entries(n, 1))
      , C(0.1 / n * random_entries(n, 2).leftCols(n / 4) * random_entries(n, 2).leftCols(n / 4).transpose())
      , K(random_entries(n, 3))
    {
      for (int i = 0; i < n; ++i)
        K(i, i) += std::pow(1. + i, 2);
    }
    DenseMatrix M, C, K;
  };

  /// Largest ‖Q(λ)x‖ / (|λ|²‖M‖ + |λ|‖C‖ + ‖K‖) over the right vectors, or the left vectors with Q(λ)ᵀ.
  double backward_error(const Pencil &pencil, const bool damped, const DenseQuadraticModes &modes, const bool left)
  {
    const ComplexDenseMatrix &X     = left ? modes.left : modes.right;
    double                    worst = 0.;
    for (int j = 0; j < X.cols(); ++j)
      {
        const Complex      l = modes.values[j];
        ComplexDenseMatrix Q = l * l * pencil.M.cast<Complex>() + pencil.K.cast<Complex>();
        if (damped)
          Q += l * pencil.C.cast<Complex>();
        if (left)
          Q.transposeInPlace();
        const double scale = std::norm(l) * max_norm(pencil.M) + std::abs(l) * max_norm(pencil.C) + max_norm(pencil.K);
        worst              = std::max(worst, (Q * X.col(j)).norm() / scale);
      }
    return worst;
  }

  void expect_subspaces(const DenseMatrix &A, const std::optional<BandSubspaces> &band, const int size)
  {
    const double tolerance = 1e-9 * A.norm();
    ASSERT_TRUE(band.has_value());
    EXPECT_EQ(band->small.rows(), size);
    EXPECT_LT((A * band->right - band->right * band->small).norm(), tolerance);
    EXPECT_LT((A.transpose() * band->left - band->left * band->small.transpose()).norm(), tolerance);
    EXPECT_LT((band->left.transpose() * band->right - DenseMatrix::Identity(size, size)).norm(), 1e-12);
  }

  void expect_same(const DenseQuadraticModes &some, const DenseQuadraticModes &all)
  {
    ASSERT_EQ(some.values.size(), all.values.size());
    for (std::size_t j = 0; j < all.values.size(); ++j)
      {
        EXPECT_LT(std::abs(some.values[j] - all.values[j]), 1e-11);
        EXPECT_LT((some.right.col(j) - all.right.col(j)).norm(), 1e-8);
        EXPECT_LT((some.left.col(j) - all.left.col(j)).norm(), 1e-8);
      }
  }
} // namespace

TEST(DenseQuadratic, VectorsOfBothSides)
{
  const Pencil pencil(60);
  for (const bool damped : {false, true})
    {
      const auto modes = dense_quadratic_modes(pencil.M, damped ? &pencil.C : nullptr, pencil.K);
      EXPECT_EQ(2 * modes.values.size() + modes.real_values.size(), 120u);
      EXPECT_LT(backward_error(pencil, damped, modes, false), 1e-12);
      EXPECT_LT(backward_error(pencil, damped, modes, true), 1e-12);
      EXPECT_TRUE(
        std::is_sorted(modes.values.begin(), modes.values.end(), [](const Complex &a, const Complex &b) { return a.imag() < b.imag(); }));
    }
}

TEST(DenseQuadratic, OscillatorsOverWideRange)
{
  // Roots of λ² + 2 ζ ω λ + ω² = 0 with ω from 1 to 1e5; even the smallest roots have ten correct digits
  const int   n = 26;
  DenseMatrix C = DenseMatrix::Zero(n, n), K = DenseMatrix::Zero(n, n);
  for (int i = 0; i < n; ++i)
    {
      const double omega = std::pow(10., 0.2 * i);
      K(i, i)            = omega * omega;
      C(i, i)            = 2. * 0.03 * omega;
    }
  const auto modes = dense_quadratic_modes(DenseMatrix::Identity(n, n), &C, K);
  ASSERT_EQ(modes.values.size(), static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i)
    {
      const double  omega = std::pow(10., 0.2 * i);
      const Complex expected(-0.03 * omega, omega * std::sqrt(1. - 0.03 * 0.03));
      EXPECT_LT(std::abs(modes.values[i] - expected), 1e-10 * omega);
      EXPECT_NEAR(std::abs(modes.right(i, i)), 1., 1e-10);
      EXPECT_NEAR(std::abs(modes.left(i, i)), 1., 1e-10);
    }
}

TEST(DenseQuadratic, OverdampedAndDivergentValuesAreReal)
{
  DenseMatrix C = DenseMatrix::Zero(2, 2), K = DenseMatrix::Zero(2, 2);
  C(0, 0)             = 3.;
  K(0, 0)             = 2.;
  K(1, 1)             = -9.;
  const auto damped   = dense_quadratic_modes(DenseMatrix::Identity(2, 2), &C, K),
             undamped = dense_quadratic_modes(DenseMatrix::Identity(2, 2), nullptr, K);
  ASSERT_EQ(damped.real_values.size(), 4u);
  EXPECT_NEAR(damped.real_values[0], -3., 1e-13);
  EXPECT_NEAR(damped.real_values[1], -2., 1e-13);
  EXPECT_NEAR(damped.real_values[2], -1., 1e-13);
  EXPECT_NEAR(damped.real_values[3], 3., 1e-13);
  ASSERT_EQ(undamped.real_values.size(), 2u);
  EXPECT_EQ(undamped.values.size(), 1u);
}

TEST(DenseQuadratic, SingularMassIsRefused)
{
  EXPECT_THROW(dense_quadratic_modes(DenseMatrix::Zero(2, 2), nullptr, DenseMatrix::Identity(2, 2)), SolverError);
}

TEST(DenseQuadratic, ModesOfABandApartFromTheRest)
{
  const int    n = 90, n_band = 20;
  const double end = 25.;
  DenseMatrix  K = random_entries(n, 4), D = random_entries(n, 7) / n, M = random_entries(n, 5) * 0.1 / n;
  for (int i = 0; i < n; ++i)
    {
      // The first mode of the reference pencil is a rigid-body motion
      K(i, i) += i == 0 ? 0. : std::pow(1. + i + (i < n_band ? 0 : 20), 2);
      D(i, i) += 0.02 * (1. + i);
    }
  DenseMatrix reference = 0.5 * (K + K.transpose());
  reference.row(0).setZero();
  reference.col(0).setZero();
  M += DenseMatrix::Identity(n, n);
  const auto [squares, V] = symmetric_eigenpairs(reference, 0.5 * (M + M.transpose()));
  for (DenseMatrix *matrix : {&K, &M, &D})
    *matrix = (V.transpose() * *matrix * V).eval();
  const DenseMatrix A = M.partialPivLu().solve(K), C = M.partialPivLu().solve(D);
  DenseMatrix       companion = DenseMatrix::Zero(2 * n, 2 * n);
  companion.topRightCorner(n, n).setIdentity();
  companion.bottomLeftCorner(n, n)  = -A;
  companion.bottomRightCorner(n, n) = -C;
  expect_subspaces(A, band_subspaces(A, squares, end), n_band);
  expect_subspaces(companion, damped_band_subspaces(A, C, squares, end), 2 * n_band);
  for (const DenseMatrix *damping : {static_cast<const DenseMatrix *>(nullptr), static_cast<const DenseMatrix *>(&D)})
    expect_same(dense_modes_of_band(M, damping, K, squares, end).value(), dense_quadratic_modes(M, damping, K, end));

  // The band is not separated from an overdamped mode above it, or from a mode above it whose damped frequency lies in it
  for (const double damping : {400., 135.})
    {
      DenseMatrix much = C;
      much(50, 50)     = damping;
      EXPECT_FALSE(damped_band_subspaces(A, much, squares, end).has_value()) << damping;
    }
}

TEST(DenseQuadratic, ABandThatIsNotApartIsNotSeparated)
{
  const int    n = 90, n_band = 20;
  const double end       = 25.;
  const auto   stiffness = [](const double gap) {
    DenseMatrix K = DenseMatrix::Zero(n, n);
    for (int i = 0; i < n; ++i)
      K(i, i) = std::pow(1. + i + (i < n_band ? 0. : gap), 2);
    return K;
  };
  const DenseMatrix I = DenseMatrix::Identity(n, n), apart = stiffness(20.);
  const auto        squares_of = [](const DenseMatrix &K) { return std::vector<double>(K.diagonal().begin(), K.diagonal().end()); };
  const auto        squares    = squares_of(apart);
  const DenseMatrix noise      = random_entries(n, 6);
  EXPECT_TRUE(band_subspaces(apart + noise, squares, end).has_value());
  // Separation requires a bounded band and a gap above it
  EXPECT_FALSE(band_subspaces(stiffness(0.) + noise, squares_of(stiffness(0.)), end).has_value());
  EXPECT_FALSE(band_subspaces(apart + noise, squares, std::numeric_limits<double>::infinity()).has_value());
  // Separation fails if a mode expected above the band lies in it or is real
  for (const double square : {100., -1e4})
    {
      DenseMatrix A = apart + noise;
      A(50, 50)     = square;
      EXPECT_FALSE(band_subspaces(A, squares, end).has_value()) << square;
    }
  // Separation fails if the iterations do not converge
  EXPECT_FALSE(band_subspaces(apart + 2000. * noise, squares, end).has_value());
  // Without separation, the QR algorithm computes all eigenvalues
  DenseMatrix A = apart + noise;
  A(50, 50)     = 100.;
  EXPECT_FALSE(dense_modes_of_band(I, nullptr, A, squares, end).has_value());
  EXPECT_EQ(dense_quadratic_modes(I, nullptr, A, end).values.size(), n_band + 1u);
}
