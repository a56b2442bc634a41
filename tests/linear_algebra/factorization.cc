// SPDX-License-Identifier: GPL-3.0-or-later

#include "matrices.h"

#include <squeal/base/exceptions.h>
#include <squeal/base/tasks.h>
#include <squeal/linear_algebra/factorization.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <gtest/gtest.h>

#include <memory>
#include <vector>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  class Factorizations : public ::testing::TestWithParam<Distribution>
  {};
  INSTANTIATE_TEST_SUITE_P(Distributions,
                           Factorizations,
                           ::testing::Values(Distribution::even, Distribution::first_process_empty, Distribution::last_process_all));

  /// Libraries to test: CHOLMOD on one process, and MUMPS.
  constexpr FactorizationLibrary libraries[] = {FactorizationLibrary::automatic, FactorizationLibrary::mumps};

  /// Largest relative residual of A X = B, or Aᵀ X = B.
  double residual(const SparseMatrix &A, const MultiVector &X, const MultiVector &B, const bool transposed)
  {
    return relative_difference(transposed ? transpose_times(A, X) : A * X, B);
  }
} // namespace

TEST_P(Factorizations, PositiveDefiniteSystemsAreSolved)
{
  const auto A = laplacian(6, 2, GetParam());
  // Use more right-hand sides than any library solves at once
  const MultiVector B = random_vectors(A->rows(), 70);
  for (const FactorizationLibrary library : libraries)
    {
      const auto  factors = factorize_positive_definite(*A, library, "test");
      MultiVector X(B.map(), B.n_columns());
      factors->apply(B, X);
      EXPECT_LT(residual(*A, X, B, false), 1e-13) << to_string(library);
      X.local().setZero();
      factors->apply_transpose(B, X);
      EXPECT_LT(residual(*A, X, B, false), 1e-13) << to_string(library);
      EXPECT_GT(factors->n_factor_entries(), A->n_entries() / 2.);
    }
}

TEST_P(Factorizations, SolutionsForAnyNumberOfColumns)
{
  // Use a small matrix, a matrix large enough for nested dissection, and uncoupled blocks
  for (const auto &A : {laplacian(7, 1, GetParam()), laplacian(22, 1, GetParam()), laplacian(9, 30, GetParam())})
    {
      const auto        factor = factorize_positive_definite(*A, FactorizationLibrary::automatic, "test matrix");
      const MultiVector B      = random_vectors(A->rows(), 33, 4);
      for (const unsigned int n_threads : {1, 2})
        {
          set_task_threads(n_threads);
          for (const int k : {1, 8, 9, 33})
            {
              MultiVector X(B.map(), k), alone(B.map(), 1);
              factor->apply(view(B, 0, k), X);
              EXPECT_LT(residual(*A, X, view(B, 0, k), false), 1e-12) << A->n_rows() << " rows, " << k << " columns";
              // Other columns affect a solution only by rounding errors
              factor->apply(view(B, k - 1, 1), alone);
              EXPECT_LT(column_norms(view(X, k - 1, 1) - alone)[0], 1e-13 * column_norms(alone)[0]) << k << " columns";
            }
          set_task_threads(1);
        }
    }
}

TEST_P(Factorizations, GeneralSystemsAreSolvedBothWays)
{
  const auto        L = laplacian(6, 1, GetParam());
  const auto        P = sparse(L->rows(), L->rows(), [](const int i) { return Row{{(5 * i + 2) % 216, 0.7}, {i, 0.1 * (i % 3)}}; });
  const auto        A = add(1., *L, 1., *P);
  const MultiVector B = random_vectors(A->rows(), 5);
  ASSERT_GT(symmetry_defect(*A), 0.1);
  const auto  factors = factorize_general(*A, "test");
  MultiVector X(B.map(), B.n_columns());
  factors->apply(B, X);
  EXPECT_LT(residual(*A, X, B, false), 1e-12);
  factors->apply_transpose(B, X);
  EXPECT_LT(residual(*A, X, B, true), 1e-12);
}

TEST_P(Factorizations, MatricesThatAreNotDefiniteAreRefused)
{
  const auto L          = laplacian(5, 1, GetParam());
  const auto indefinite = add(1., *L, -1., *diagonal(L->rows(), [](int) { return 1.; }));
  const auto body       = plate({{4, 3, 2}}, 0.01, 0., GetParam());
  for (const FactorizationLibrary library : libraries)
    {
      EXPECT_THROW(factorize_positive_definite(*indefinite, library, "test"), SolverError) << to_string(library);
      // The stiffness of a free body is singular
      EXPECT_THROW(factorize_positive_definite(*body.stiffness, library, "test"), SolverError) << to_string(library);
    }
  const auto singular = diagonal(L->rows(), [](const int i) { return i == 3 ? 0. : 1.; });
  EXPECT_THROW(factorize_general(*singular, "test"), SolverError);
}

TEST_P(Factorizations, InertiaCountsEigenvalues)
{
  // Count eigenvalues of two uncoupled bodies and of a larger body
  for (const auto &[m, n_copies] : {std::make_pair(6, 2), {14, 1}})
    {
      const auto L      = laplacian(m, n_copies, GetParam());
      const auto values = laplacian_eigenvalues(m, n_copies);
      for (const double limit : {0.1, 2.3, 11.9})
        {
          const auto shifted  = add(1., *L, -limit, *diagonal(L->rows(), [](int) { return 1.; }));
          const int  expected = std::lower_bound(values.begin(), values.end(), limit) - values.begin();
          int        n_null   = -1;
          EXPECT_EQ(count_negative_eigenvalues(*shifted, "test", &n_null), expected) << limit;
          EXPECT_EQ(n_null, 0);
        }
    }

  const auto D      = diagonal(rows(100, GetParam()), [](const int i) { return i % 5 == 0 ? 0. : (i % 3 == 0 ? -1. : 2.); });
  int        n_null = 0;
  EXPECT_EQ(count_negative_eigenvalues(*D, "test", &n_null), 27); // 34 numbers below 100 are divisible by 3, and 7 of these by 5
  EXPECT_EQ(n_null, 20);
  EXPECT_THROW(count_negative_eigenvalues(*D, "test"), SolverError);
}
