// SPDX-License-Identifier: GPL-3.0-or-later

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
    DenseMatrix A(3, 3);
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
  // Complex products are computed from real products
  const ComplexDenseMatrix X = A + i * A.transpose(), Y = B - 0.5 * i * A.leftCols(2);
  EXPECT_LT((multiply(A, X) - (A * A + i * A * A.transpose())).norm(), 1e-14);
  EXPECT_LT((product_of_halves(halves(X).transpose() * halves(Y)) - X.transpose() * Y).norm(), 1e-14);
  EXPECT_EQ((from_halves(halves(X)) - X).norm(), 0.);
  EXPECT_EQ(append_columns(DenseMatrix(), B).cols(), 2);
}

TEST(DenseMatrices, LUSolvesBothWaysAndRefusesSingular)
{
  const DenseMatrix A  = example();
  const RealLU      lu = regular_lu(A, "test");
  EXPECT_LT(max_norm(A * lu.solve(DenseMatrix::Identity(3, 3)) - DenseMatrix::Identity(3, 3)), 1e-13);
  EXPECT_LT(max_norm(A.transpose() * lu.solve_transposed(DenseMatrix::Identity(3, 3)) - DenseMatrix::Identity(3, 3)), 1e-13);

  DenseMatrix singular = A;
  singular.col(2)      = A.col(0) - A.col(1);
  EXPECT_THROW(regular_lu(singular, "test"), SolverError);
  EXPECT_NO_THROW(regular_lu(DenseMatrix(Eigen::Vector2d(1., 1e-13).asDiagonal()), "test"));
  EXPECT_THROW(regular_lu(DenseMatrix(Eigen::Vector2d(1., 1e-15).asDiagonal()), "test"), SolverError);
  EXPECT_THROW(regular_lu(DenseMatrix::Constant(2, 2, std::numeric_limits<double>::quiet_NaN()), "test"), SolverError);
  EXPECT_EQ(regular_lu(DenseMatrix(0, 0), "test").reciprocal_condition(), 1.);
}

TEST(DenseMatrices, VectorsOfTheWantedEigenvaluesOnly)
{
  // Scale rows and columns differently to exercise balancing
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
}

TEST(DenseMatrices, OrthonormalBasisLeavesOutDependentColumns)
{
  ComplexDenseMatrix X = example();
  X.col(1)             = -2. * X.col(0);
  const auto [Q, R]    = orthonormal_basis(X);
  EXPECT_LT(max_norm(Q * R - X), 1e-14);
  EXPECT_EQ(R(1, 1), 0.);
  EXPECT_LT(max_norm(Q.adjoint() * Q - ComplexDenseMatrix(Eigen::Vector3cd(1., 0., 1.).asDiagonal())), 1e-14);
}
