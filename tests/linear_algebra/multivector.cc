// SPDX-License-Identifier: GPL-3.0-or-later

#include "matrices.h"

#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  class MultiVectors : public ::testing::TestWithParam<Distribution>
  {};
  INSTANTIATE_TEST_SUITE_P(Distributions,
                           MultiVectors,
                           ::testing::Values(Distribution::even, Distribution::first_process_empty, Distribution::last_process_all));

  /// A symmetric positive definite tridiagonal matrix.
  std::shared_ptr<SparseMatrix> inner_product(const RowMap &map)
  {
    const int n = map.n();
    return sparse(map, map, [n](const int i) {
      Row row{{i, 4. + i % 7}};
      if (i > 0)
        row[i - 1] = 1.;
      if (i < n - 1)
        row[i + 1] = 1.;
      return row;
    });
  }
} // namespace

TEST_P(MultiVectors, AreGatheredAndScattered)
{
  const int         n    = 50;
  const RowMap      map  = rows(n, GetParam());
  const MultiVector X    = random_vectors(map, 3, 7);
  const DenseMatrix all  = replicate(X);
  DenseMatrix       root = gather(X);
  EXPECT_EQ(root.rows(), map.rank() == 0 ? n : 0);
  if (map.rank() == 0)
    EXPECT_EQ(max_norm(root - all), 0.);
  else
    root = DenseMatrix();
  const MultiVector Y = scatter(root, map);
  EXPECT_TRUE(Y.map() == map);
  ASSERT_EQ(Y.n_columns(), 3);
  EXPECT_EQ(max_norm(Y.local() - X.local()), 0.);
}

TEST_P(MultiVectors, RandomEntriesDoNotDependOnTheDistribution)
{
  const int         n = 50;
  const MultiVector X = random_vectors(rows(n, GetParam()), 3, 7), Y = random_vectors(rows(n, Distribution::even), 3, 7);
  EXPECT_EQ(max_norm(replicate(X) - replicate(Y)), 0.);
  for (const double norm : column_norms(X))
    {
      EXPECT_GT(norm, 2.);
      EXPECT_LT(norm, 6.);
    }
  EXPECT_LT(std::abs(gram(X, X)(0, 1)), 0.5 * gram(X, X)(0, 0));
  EXPECT_GT(max_norm(gram(X, X) - gram(random_vectors(rows(n, GetParam()), 3, 8), X)), 1.);
}

TEST_P(MultiVectors, ProductsAgreeWithDenseOnes)
{
  // Sizes include incomplete blocks of rows and products of few with many columns; beta = 0 overwrites NaN
  for (const auto &[n, n_many, k] : {std::array<int, 3>{{3, 15, 2}}, {{700, 4, 3}}, {{700, 43, 1}}, {{10000, 16, 9}}})
    {
      const MultiVector X = random_vectors(rows(n, GetParam()), n_many, 1), Y = random_vectors(X.map(), k, 2);
      const DenseMatrix all_X = replicate(X), all_Y = replicate(Y), S = agreed_random_matrix(n_many, k);
      EXPECT_LT(max_norm(gram(X, Y) - all_X.transpose() * all_Y), 1e-13 * n);
      EXPECT_LT(max_norm(replicate(X * S) - all_X * S), 1e-13);
      for (const double beta : {0., 1., -2.})
        {
          MultiVector sum = Y;
          if (beta == 0.)
            sum.local().setConstant(std::nan(""));
          multiply_add(0.5, X, S, beta, sum);
          EXPECT_LT(max_norm(replicate(sum) - (0.5 * all_X * S + beta * all_Y)), 1e-13) << n_many << " and " << k;
        }
    }
}

TEST_P(MultiVectors, GrowByColumns)
{
  const RowMap      map = rows(33, GetParam());
  const MultiVector A = random_vectors(map, 3, 1), B = random_vectors(map, 2, 2);
  MultiVector       all = A;
  all.append(B);
  all.append(view(A, 1, 1));
  ASSERT_EQ(all.n_columns(), 6);
  EXPECT_EQ(max_norm(view(all, 0, 3).local() - A.local()), 0.);
  EXPECT_EQ(max_norm(view(all, 3, 2).local() - B.local()), 0.);
  EXPECT_EQ(max_norm(view(all, 5, 1).local() - A.local().middleCols(1, 1)), 0.);
  EXPECT_EQ(max_norm(join({&A, &B}).local() - view(all, 0, 5).local()), 0.);
  if (all.n_local_rows() > 0)
    {
      MultiVector some = view(all, 0, 2); // a view cannot grow
      EXPECT_THROW(some.append(B), SolverError);
    }
}

TEST_P(MultiVectors, OrthonormalizeFindsTheRank)
{
  const RowMap map = rows(60, GetParam());
  const auto   M   = inner_product(map);

  const MultiVector Q = orthonormalize(*M, nullptr, random_vectors(map, 5, 1), 1e-8);
  ASSERT_EQ(Q.n_columns(), 5);
  EXPECT_LT(orthonormality_defect(*M, Q), 1e-13);

  // X: three new directions with very different norms, a vector in the span of Q, a zero vector and a repeated vector
  const MultiVector fresh = random_vectors(map, 3, 2);
  MultiVector       X(map, 6);
  X.col(0)            = 1e6 * fresh.col(0);
  X.col(1)            = 1e-6 * fresh.col(1);
  X.col(2)            = Q.col(3);
  X.col(4)            = 3. * fresh.col(0);
  X.col(5)            = fresh.col(2);
  const MultiVector W = orthonormalize(*M, &Q, X, 1e-10);
  ASSERT_EQ(W.n_columns(), 3);
  EXPECT_LT(orthonormality_defect(*M, W), 1e-13);
  EXPECT_LT(max_norm(gram(Q, *M * W)), 1e-13);

  // X lies in the span of Q and W
  const MultiVector basis = join({&Q, &W});
  EXPECT_FALSE(orthonormalize_if_any(*M, &basis, X, 1e-10).has_value());
  EXPECT_THROW(orthonormalize(*M, &basis, X, 1e-10), SolverError);
  X.local().setConstant(std::nan(""));
  EXPECT_THROW(orthonormalize(*M, nullptr, X, 1e-10), SolverError);
}

TEST_P(MultiVectors, OrthonormalizeResolvesNearlyParallelDirections)
{
  const RowMap map = rows(60, GetParam());
  const auto   M   = inner_product(map);

  // A single Gram matrix cannot resolve all directions at angles of 1e-2, 1e-4, ..., 1e-12
  const MultiVector fresh = orthonormalize(*M, nullptr, random_vectors(map, 7, 3), 1e-8);
  MultiVector       X(map, 7);
  for (int j = 0; j < 7; ++j)
    {
      X.col(j) = fresh.col(0);
      if (j > 0)
        X.col(j) += std::pow(10., -2 * j) * fresh.col(j);
    }

  for (const int exponent : {3, 5, 7, 9, 11})
    {
      const MultiVector W = orthonormalize(*M, nullptr, X, std::pow(10., -exponent));
      EXPECT_EQ(W.n_columns(), 1 + exponent / 2) << "tolerance 1e-" << exponent;
      EXPECT_LT(orthonormality_defect(*M, W), 1e-13);
    }

  // The retained directions are accurate: fresh(4), with a contribution of only 1e-8, is resolved
  const MultiVector W         = orthonormalize(*M, nullptr, X, 1e-13);
  const DenseMatrix component = gram(W, *M * view(fresh, 4, 1));
  EXPECT_NEAR(component.squaredNorm(), 1., 1e-10);
}

TEST_P(MultiVectors, OrthonormalizeTellsHowFarFromDependentTheColumnsAre)
{
  // The Gram matrix of two unit vectors at an angle α has the eigenvalues 1 ± cos α
  const RowMap      map    = rows(60, GetParam());
  const auto        M      = inner_product(map);
  const MultiVector Q      = orthonormalize(*M, nullptr, random_vectors(map, 2, 3), 1e-8);
  const double      cosine = 0.8, sine = 0.6;
  MultiVector       X(map, 2);
  X.col(0) = 5. * Q.col(0);
  X.col(1) = 0.1 * cosine * Q.col(0) + 0.1 * sine * Q.col(1);
  PrincipalAxes axes;
  orthonormalize(*M, nullptr, X, 1e-8, &axes);
  EXPECT_NEAR(axes.condition, (1. + cosine) / (1. - cosine), 1e-12);
  ASSERT_EQ(axes.norms.size(), 2u);
  EXPECT_NEAR(axes.norms[0], std::sqrt(1. + cosine), 1e-13);
  EXPECT_NEAR(axes.norms[1], std::sqrt(1. - cosine), 1e-13);
}

TEST_P(MultiVectors, PrincipalAxesAreOrderedAndBest)
{
  // Mix columns with singular values over twelve orders of magnitude by an orthogonal matrix
  const RowMap      map = rows(60, GetParam());
  const auto        M   = inner_product(map);
  const int         k   = 7;
  const MultiVector Q   = orthonormalize(*M, nullptr, random_vectors(map, k, 3), 1e-8);
  const DenseMatrix mix = gram(random_vectors(map, k, 5), random_vectors(map, k, 6));
  DenseMatrix       S   = symmetric_eigenpairs(mix + mix.transpose()).vectors.transpose();
  for (int i = 0; i < k; ++i)
    S.row(i) *= std::pow(10., 2 - 2 * i);
  const MultiVector X = Q * S;

  PrincipalAxes     axes;
  const MultiVector W = principal_axes(*M, X, 1e-9, 20, &axes);
  ASSERT_EQ(W.n_columns(), 5);
  EXPECT_LT(orthonormality_defect(*M, W), 1e-13);
  ASSERT_EQ(axes.norms.size(), 5u);
  for (int i = 0; i < 5; ++i)
    {
      EXPECT_NEAR(axes.norms[i] / std::pow(10., 2 - 2 * i), 1., 1e-4);
      EXPECT_NEAR(std::abs(gram(view(W, i, 1), *M * view(Q, i, 1))(0, 0)), 1., 1e-6);
    }

  const MultiVector first = principal_axes(*M, X, 1e-9, 3, &axes);
  EXPECT_EQ(first.n_columns(), 3);
  EXPECT_LT(max_norm(gram(first, *M * view(W, 0, 3)) - DenseMatrix::Identity(3, 3)), 1e-13);
  EXPECT_EQ(axes.norms.size(), 3u);
  EXPECT_THROW(principal_axes(*M, MultiVector(map, 2), 1e-9, 2), SolverError);
}

TEST_P(MultiVectors, ProductsByBlocksAreThoseOfTheWhole)
{
  // Use more columns and rows than fit in a block
  const auto        M = inner_product(rows(2500, GetParam()));
  const MultiVector X = random_vectors(M->rows(), 70, 1), Y = random_vectors(M->rows(), 130, 2);
  const DenseMatrix expected = gram(X, *M * Y);
  EXPECT_LT(max_norm(weighted_gram(X, *M, Y) - expected), 1e-13 * max_norm(expected));

  const DenseMatrix S       = agreed_random_matrix(70, 70);
  MultiVector       product = X;
  multiply_in_place(product, S);
  EXPECT_LT(max_norm(replicate(product) - replicate(X * S)), 1e-13 * max_norm(replicate(product)));
}
