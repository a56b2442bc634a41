#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/dense_eigenproblems.h>
#include <squeal/linear_algebra/dense_lu.h>
#include <squeal/linear_algebra/orthonormal_basis.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

using namespace Squeal;

namespace
{
  using Complex = std::complex<double>;

  DenseMatrix example()
  {
    DenseMatrix A = DenseMatrix::Zero(3, 3);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        A(i, j) = 1. / (1 + i + 2 * j) - (i == 2 && j == 0 ? 4. : 0.);
    return A;
  }
} // namespace

TEST(DenseMatrices, Products)
{
  const DenseMatrix A = example();
  const DenseMatrix B = A.middleCols(1, 2);
  const Complex     i(0., 1.);
  // Of complex matrices from real ones
  const ComplexDenseMatrix X = A + i * A.transpose(), Y = B - 0.5 * i * A.leftCols(2);
  EXPECT_LT((multiply(A, X) - (A * A + i * A * A.transpose())).norm(), 1e-14);
  EXPECT_LT((product_of_halves(halves(X).transpose() * halves(Y)) - X.transpose() * Y).norm(), 1e-14);
  EXPECT_EQ((from_halves(halves(X)) - X).norm(), 0.);
  EXPECT_EQ(append_columns(DenseMatrix(), B).cols(), 2);
  EXPECT_EQ(max_norm(append_columns(A.leftCols(1), B) - A), 0.);
  EXPECT_EQ(max_norm(with_rows(A, 5).topRows(3) - A) + max_norm(with_rows(A, 5).bottomRows(2)), 0.);
  EXPECT_EQ(max_norm(DenseMatrix(0, 3)), 0.);
}

TEST(DenseMatrices, LUSolvesBothWaysAndRefusesSingular)
{
  const DenseMatrix A  = example();
  const RealLU      lu = regular_lu(A, "test");
  EXPECT_LT(max_norm(A * lu.solve(DenseMatrix::Identity(3, 3)) - DenseMatrix::Identity(3, 3)), 1e-13);
  EXPECT_LT(max_norm(A.transpose() * lu.solve_transposed(DenseMatrix::Identity(3, 3)) - DenseMatrix::Identity(3, 3)), 1e-13);
  EXPECT_GT(lu.reciprocal_condition(), 1e-4);
  EXPECT_LT(lu.reciprocal_condition(), 1.);
  for (const DenseMatrix &none : {lu.solve(DenseMatrix(3, 0)), lu.solve_transposed(DenseMatrix(3, 0))})
    {
      EXPECT_EQ(none.rows(), 3);
      EXPECT_EQ(none.cols(), 0);
    }

  DenseMatrix singular = A;
  singular.col(2)      = A.col(0) - A.col(1);
  EXPECT_THROW(regular_lu(singular, "test"), SolverError);
  EXPECT_THROW(regular_lu(DenseMatrix::Zero(2, 2), "test"), SolverError);
  EXPECT_NO_THROW(regular_lu(DenseMatrix(Eigen::Vector2d(1., 1e-13).asDiagonal()), "test"));
  EXPECT_THROW(regular_lu(DenseMatrix(Eigen::Vector2d(1., 1e-15).asDiagonal()), "test"), SolverError);
  EXPECT_THROW(regular_lu(DenseMatrix::Constant(2, 2, std::numeric_limits<double>::quiet_NaN()), "test"), SolverError);
  EXPECT_EQ(regular_lu(DenseMatrix(0, 0), "test").reciprocal_condition(), 1.);
}

TEST(DenseMatrices, SymmetricEigenvalues)
{
  DenseMatrix A = DenseMatrix::Zero(2, 2);
  A(0, 0) = A(1, 1) = 2.;
  A(0, 1) = A(1, 0)     = 1.;
  const auto [roots, V] = symmetric_eigenpairs(A);
  EXPECT_NEAR(roots[0], 1., 1e-15);
  EXPECT_LT(max_norm(V.transpose() * V - DenseMatrix::Identity(2, 2)), 1e-15);

  DenseMatrix B          = DenseMatrix::Zero(2, 2);
  B(0, 0)                = 2.;
  B(1, 1)                = 1.;
  const auto [values, W] = symmetric_eigenpairs(A, B);
  EXPECT_NEAR(values[0] * values[1], 3. / 2., 1e-14);
  EXPECT_NEAR(values[0] + values[1], 3., 1e-14);
  EXPECT_LT(max_norm(W.transpose() * B * W - DenseMatrix::Identity(2, 2)), 1e-14);
}

TEST(DenseMatrices, EigenpairsOfANonsymmetricMatrix)
{
  // One real eigenvalue and a conjugate pair.
  DenseMatrix A = DenseMatrix::Zero(3, 3);
  A(0, 0)       = 2.;
  A(1, 2)       = -3.;
  A(2, 1)       = 3.;
  A(0, 1) = A(2, 0)           = 0.5;
  const DenseEigenpairs pairs = eigenpairs(A);

  int n_complex = 0;
  for (int j = 0; j < 3; ++j)
    {
      n_complex += pairs.values[j].imag() != 0.;
      EXPECT_LT((A * pairs.right.col(j) - pairs.values[j] * pairs.right.col(j)).norm(), 1e-14);
      EXPECT_LT((pairs.left.col(j).adjoint() * A - pairs.values[j] * pairs.left.col(j).adjoint()).norm(), 1e-14);
    }
  EXPECT_EQ(n_complex, 2);
}

TEST(DenseMatrices, VectorsOfTheWantedEigenvaluesOnly)
{
  // Badly scaled, so that balancing has something to do
  DenseMatrix A = DenseMatrix::Random(15, 15);
  for (int i = 0; i < 15; ++i)
    A.row(i) *= std::pow(10., i % 4), A.col(i) /= std::pow(10., i % 4);
  const auto            is_wanted = [](const std::complex<double> &l) { return l.imag() > 0. && l.real() > -0.5; };
  const DenseEigenpairs pairs     = eigenpairs(A, is_wanted);
  ASSERT_EQ(pairs.values.size(), 15u);
  EXPECT_NEAR(std::accumulate(pairs.values.begin(), pairs.values.end(), std::complex<double>()).real(), A.trace(), 1e-12);
  std::vector<int> expected;
  for (int j = 0; j < 15; ++j)
    if (is_wanted(pairs.values[j]) || is_wanted(std::conj(pairs.values[j])))
      expected.push_back(j);
  EXPECT_EQ(pairs.numbers, expected);
  ASSERT_GT(expected.size(), 2u);
  ASSERT_LT(expected.size(), 15u);
  ASSERT_EQ(pairs.right.cols(), static_cast<int>(expected.size()));
  for (std::size_t i = 0; i < expected.size(); ++i)
    {
      const auto x = pairs.right.col(i), y = pairs.left.col(i);
      const auto value = pairs.values[expected[i]];
      EXPECT_NEAR(x.norm(), 1., 1e-14);
      EXPECT_NEAR(y.norm(), 1., 1e-14);
      EXPECT_LT((A * x - value * x).norm(), 1e-13 * A.norm());
      EXPECT_LT((y.adjoint() * A - value * y.adjoint()).norm(), 1e-13 * A.norm());
    }
  const DenseEigenpairs none = eigenpairs(A, [](const std::complex<double> &) { return false; });
  EXPECT_EQ(none.values.size(), 15u);
  EXPECT_EQ(none.right.cols(), 0);
}

TEST(DenseMatrices, SingularValuesAndKernel)
{
  const DenseMatrix A = example(), tall = A.transpose() * A.leftCols(2);
  for (const DenseMatrix &B : {A, tall, DenseMatrix(tall.transpose())})
    {
      const auto [values, V] = singular_values(B);
      const int n = B.cols(), k = values.size();
      ASSERT_EQ(k, std::min<int>(B.rows(), n));
      EXPECT_TRUE(std::is_sorted(values.rbegin(), values.rend()));
      EXPECT_LT(max_norm(V.transpose() * V - DenseMatrix::Identity(n, n)), 1e-14);
      const DenseMatrix squares = V.transpose() * B.transpose() * B * V;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
          EXPECT_NEAR(squares(i, j), i == j && i < k ? values[i] * values[i] : 0., 1e-13);
    }
  EXPECT_TRUE(singular_values(DenseMatrix(0, 3)).values.empty());
}

TEST(DenseMatrices, OrthonormalBasisLeavesOutDependentColumns)
{
  DenseMatrix X     = example();
  X.col(1)          = -2. * X.col(0);
  const auto [Q, R] = orthonormal_basis(X, [](const double rest) { return rest > 1e-13; });
  EXPECT_LT(max_norm(Q * R - X), 1e-14);
  EXPECT_EQ(R(1, 1), 0.);
  EXPECT_EQ(max_norm(Q.col(1)), 0.);
  EXPECT_NEAR(Q.col(0).norm(), 1., 1e-15);
  EXPECT_NEAR(Q.col(2).norm(), 1., 1e-15);
  EXPECT_LT(std::abs(Q.col(0).dot(Q.col(2))), 1e-15);
}
