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

  /// A dense matrix as an operator on vectors distributed by rows.
  class DenseOperator : public LinearOperator
  {
  public:
    DenseOperator(const RowMap &map, const DenseMatrix &A)
      : row_map(map)
      , A(A)
    {}

    void apply(const MultiVector &X, MultiVector &Y) const override
    {
      // All rows of X on every process: its Gram matrix with unit vectors.
      Y = distribute(A * gram(unit_vectors(row_map), X), row_map);
    }

    const RowMap &map() const override
    {
      return row_map;
    }

  private:
    RowMap      row_map;
    DenseMatrix A;
  };

  /// The pencil of three small matrices and its inverse at a shift.
  struct DensePencil
  {
    DensePencil(const DenseMatrix &M, const DenseMatrix *C, const DenseMatrix &K, const double shift)
      : map(RowMap::even(M.rows(), MPI_COMM_WORLD))
      , mass(map, M)
      , damping(map, C != nullptr ? *C : DenseMatrix::Zero(M.rows(), M.rows()))
      , stiffness(map, K)
      , inverse(map, inverse_of(C != nullptr ? K + shift * shift * M + shift * *C : DenseMatrix(K + shift * shift * M)))
      , pencil{&mass, C != nullptr ? &damping : nullptr, &stiffness}
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
      return quadratic_modes(pencil, inverse, options);
    }

    RowMap                map;
    DenseOperator         mass, damping, stiffness, inverse;
    QuadraticPencil       pencil;
    QuadraticModesOptions options;
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

  /// A chain of masses and springs: a stiffness with spread eigenvalues.
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
} // namespace

TEST(QuadraticModes, DampedOscillators)
{
  // λ² + 2 ζ ω λ + ω² = 0; two are overdamped.
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
  // Twelve equal chains: every eigenvalue has twelve members, the block has four vectors.
  const int   n = 20, n_copies = 12;
  DenseMatrix K = DenseMatrix::Zero(n * n_copies, n * n_copies);
  for (int copy = 0; copy < n_copies; ++copy)
    K.block(copy * n, copy * n, n, n) = chain(n);
  const DenseMatrix    C = 0.02 * K;
  std::vector<Complex> undamped, damped;
  const double         largest = 1.05;
  for (int i = 1; i <= n; ++i)
    {
      const double omega = 2. * std::sin(0.5 * M_PI * i / (n + 1)), zeta = 0.01 * omega;
      for (int copy = 0; copy < n_copies; ++copy)
        {
          if (omega <= largest)
            undamped.emplace_back(0., omega);
          if (omega * std::sqrt(1. - zeta * zeta) <= largest)
            damped.emplace_back(-zeta * omega, omega * std::sqrt(1. - zeta * zeta));
        }
    }
  DensePencil without(DenseMatrix::Identity(n * n_copies, n * n_copies), nullptr, K, 0.);
  without.options.expected = static_cast<int>(undamped.size());
  expect_same(without.modes(largest).values, undamped, 1e-10);
  DensePencil with(DenseMatrix::Identity(n * n_copies, n * n_copies), &C, K, 0.);
  with.options.expected = static_cast<int>(damped.size());
  expect_same(with.modes(largest).values, damped, 1e-10);
}

TEST(QuadraticModes, NonsymmetricAgreesWithTheCompanionForm)
{
  const int         n = 120;
  const DenseMatrix R = random_matrix(n, 3), S = random_matrix(n, 4), T = random_matrix(n, 5);
  const DenseMatrix M = DenseMatrix::Identity(n, n) + 0.01 * R, C = 1e-3 * S.transpose() * S + 1e-3 * T;
  DenseMatrix       K = diagonal_matrix([n] {
                    std::vector<double> values(n);
                    for (int i = 0; i < n; ++i)
                      values[i] = std::pow(1. + 0.3 * i, 2);
                    return values;
                  }()) +
                  0.5 * T;
  const double               largest  = 12.;
  const std::vector<Complex> expected = companion_values(M, C, K, largest);
  ASSERT_GT(expected.size(), 30u);

  std::vector<Complex> first;
  for (const double shift : {0., 2.})
    for (const int block : {1, 3, 8})
      for (const unsigned int seed : {1u, 17u})
        {
          DensePencil pencil(M, &C, K, shift);
          pencil.options.expected   = 35;
          pencil.options.block_size = block;
          pencil.options.seed       = seed;
          const auto modes          = pencil.modes(largest);
          expect_same(modes.values, expected, 1e-9);
          if (first.empty())
            first = modes.values;
          expect_same(modes.values, first, 1e-10);
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
          const double square = std::pow(2. * std::sin(0.5 * M_PI * i / (n + 1)), 2);
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
  // Without a damping matrix, exactly
  for (const auto &[values, relative] : {std::make_pair(one.values, 1e-15), {two.values, 1e-9}})
    for (const Complex &value : values)
      EXPECT_TRUE(std::any_of(values.begin(), values.end(), [&value = value, relative = relative](const Complex &other) {
        return std::abs(other + std::conj(value)) <= relative * std::abs(value);
      }));
}

TEST(QuadraticModes, FreeBodyNeedsAShift)
{
  // Two free chains: K is singular, with one rigid-body mode for each.
  const int   n = 40;
  DenseMatrix K = DenseMatrix::Zero(2 * n, 2 * n);
  for (int part = 0; part < 2; ++part)
    for (int i = 0; i + 1 < n; ++i)
      {
        const int a = part * n + i, b = a + 1;
        K(a, a) += 1.;
        K(b, b) += 1.;
        K(a, b) -= 1.;
        K(b, a) -= 1.;
      }
  const DenseMatrix    C       = 1e-3 * K;
  const double         largest = 0.8;
  std::vector<Complex> undamped, damped;
  for (int i = 1; i < n; ++i)
    for (int part = 0; part < 2; ++part)
      {
        const double omega = 2. * std::sin(0.5 * M_PI * i / n), zeta = 5e-4 * omega;
        if (omega <= largest)
          {
            undamped.emplace_back(0., omega);
            damped.emplace_back(-zeta * omega, omega * std::sqrt(1. - zeta * zeta));
          }
      }
  DensePencil without(DenseMatrix::Identity(2 * n, 2 * n), nullptr, K, 0.3), with(DenseMatrix::Identity(2 * n, 2 * n), &C, K, 0.3);
  const auto  one = without.modes(largest), two = with.modes(largest);
  expect_same(one.values, undamped, 1e-10);
  expect_same(two.values, damped, 1e-10);
  EXPECT_EQ(one.n_zero_values, 4);
  EXPECT_EQ(two.n_zero_values, 4);
}

TEST(QuadraticModes, DivergenceIsReportedAsRealValues)
{
  std::vector<double> stiffness;
  for (int i = 0; i < 30; ++i)
    stiffness.push_back(i == 2 ? -4. : std::pow(1. + i, 2));
  DensePencil pencil(DenseMatrix::Identity(30, 30), nullptr, diagonal_matrix(stiffness), 0.);
  const auto  modes = pencil.modes(8.5);
  EXPECT_EQ(modes.values.size(), 7u);
  ASSERT_EQ(modes.real_values.size(), 2u);
  EXPECT_NEAR(modes.real_values[0], -2., 1e-10);
  EXPECT_NEAR(modes.real_values[1], 2., 1e-10);
}

TEST(QuadraticModes, VectorsAreNormalised)
{
  const int         n = 50;
  const DenseMatrix K = chain(n), C = 0.05 * K * K;
  DensePencil       pencil(DenseMatrix::Identity(n, n), &C, K, 0.);
  const auto        modes = pencil.modes(0.7);
  const auto        real = column_norms(*modes.real_part), imaginary = column_norms(*modes.imaginary_part);
  const auto        recomputed = residuals(pencil.pencil, modes.values, *modes.real_part, *modes.imaginary_part);
  for (std::size_t i = 0; i < modes.values.size(); ++i)
    {
      EXPECT_NEAR(std::hypot(real[i], imaginary[i]), 1., 1e-13);
      EXPECT_NEAR(recomputed[i], modes.residuals[i], 1e-14);
    }
}

TEST(QuadraticModes, NonConvergenceSaysHowFarItCame)
{
  const int         n = 300;
  const DenseMatrix K = chain(n);
  DensePencil       pencil(DenseMatrix::Identity(n, n), nullptr, K, 0.);
  pencil.options.expected     = 20;
  pencil.options.block_size   = 2;
  pencil.options.max_basis    = 26;
  pencil.options.max_restarts = 1;
  try
    {
      pencil.modes(0.21);
      FAIL() << "converged against expectation";
    }
  catch (const SolverError &error)
    {
      const std::string message = error.what();
      EXPECT_NE(message.find("converged; the worst residual is"), std::string::npos) << message;
      EXPECT_NE(message.find("after 1 restarts"), std::string::npos) << message;
    }
}

TEST(QuadraticModes, RefusesAnImpossibleToleranceAndANegativeShift)
{
  const int   n = 100;
  DensePencil pencil(DenseMatrix::Identity(n, n), nullptr, chain(n), 0.);
  pencil.options.tolerance = 1e-17;
  EXPECT_THROW(pencil.modes(0.3), SolverError);
  pencil.options       = {};
  pencil.options.shift = -1.;
  EXPECT_THROW(pencil.modes(1.), SolverError);
}
