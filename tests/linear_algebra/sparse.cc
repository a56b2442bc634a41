// SPDX-License-Identifier: GPL-3.0-or-later

#include "matrices.h"

#include <squeal/base/exceptions.h>
#include <squeal/base/tasks.h>
#include <squeal/linear_algebra/blas_threads.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <gtest/gtest.h>

#include <array>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  class Sparse : public ::testing::TestWithParam<Distribution>
  {};
  INSTANTIATE_TEST_SUITE_P(Distributions,
                           Sparse,
                           ::testing::Values(Distribution::even, Distribution::first_process_empty, Distribution::last_process_all));

  /// A 30 × 20 matrix with three entries per row.
  std::shared_ptr<SparseMatrix> rectangular(const Distribution distribution)
  {
    return sparse(rows(30, distribution), rows(20, distribution), [](const int i) {
      Row row;
      row[i % 20] += 1.;
      row[(7 * i + 3) % 20] += 0.25 * i;
      row[(i * i) % 20] -= 2.;
      return row;
    });
  }
} // namespace

TEST_P(Sparse, ProductsAgreeWithDenseOnes)
{
  const auto        A = laplacian(3, 1, GetParam());
  const auto        B = sparse(rows(27, GetParam()), rows(20, GetParam()), [](const int i) { return Row{{i % 20, 1. + i}, {19, -1.}}; });
  const auto        C = rectangular(GetParam());
  const DenseMatrix a = to_dense(*A), b = to_dense(*B), c = to_dense(*C);

  EXPECT_LT(max_norm(to_dense(*multiply(*A, *B)) - a * b), 1e-12);
  EXPECT_LT(max_norm(to_dense(*multiply(*B, *A, true, false)) - b.transpose() * a), 1e-12);
  EXPECT_LT(max_norm(to_dense(*multiply(*B, *C, false, true)) - b * c.transpose()), 1e-12);

  // In small matrices, row i and column i may belong to different processes
  for (const int n : {3, 7, 20})
    {
      const RowMap      many = rows(n, GetParam()), fewer = rows(n - 1, GetParam()), few = rows(std::max(1, n / 5), GetParam());
      const auto        S = sparse(many, fewer, [n](const int i) { return Row{{(3 * i + 1) % (n - 1), 1. + i}}; });
      const auto        P = sparse(few, many, [n](const int i) { return Row{{n - 1 - 2 * i, -1. - i}}; });
      const DenseMatrix s = to_dense(*S), p = to_dense(*P);
      EXPECT_EQ(max_norm(to_dense(*multiply(*S, *P, true, true)) - s.transpose() * p.transpose()), 0.) << n;
      EXPECT_EQ(max_norm(to_dense(*multiply(*P, *S)) - p * s), 0.) << n;
      EXPECT_EQ(max_norm(to_dense(*multiply(*S, *multiply(*S, *P, true, true))) - s * (s.transpose() * p.transpose())), 0.) << n;
    }

  const auto T = congruence(*A, *B);
  EXPECT_TRUE(T->rows() == B->columns());
  EXPECT_TRUE(T->columns() == B->columns());
  EXPECT_LT(max_norm(to_dense(*T) - b.transpose() * a * b), 1e-10);
  EXPECT_LT(symmetry_defect(*T), 1e-15);
}

TEST_P(Sparse, SumsOfDifferentPatterns)
{
  const auto A = laplacian(3, 1, GetParam());
  const auto D = diagonal(A->rows(), [](const int i) { return 1. + i; });
  const auto P = sparse(A->rows(), A->rows(), [](const int i) { return Row{{(5 * i + 2) % 27, 1.}}; });
  for (const auto &B : {D, P, A})
    {
      EXPECT_LT(max_norm(to_dense(*add(2., *A, -3., *B)) - (2. * to_dense(*A) - 3. * to_dense(*B))), 1e-13);
      EXPECT_LT(max_norm(to_dense(*add(2., *B, -3., *A)) - (2. * to_dense(*B) - 3. * to_dense(*A))), 1e-13);
    }
  EXPECT_DOUBLE_EQ(symmetry_defect(*P), 1.);
  EXPECT_EQ(symmetry_defect(*A), 0.);
}

TEST_P(Sparse, ProductsWithAnyNumberOfColumns)
{
  // Sizes include empty rows, long rows, and wide matrices with fewer or more entries than columns
  for (const auto &[n_rows, n_columns, most_entries] : {std::array<int, 3>{{90, 70, 30}}, {{5, 400, 2}}, {{5, 400, 150}}})
    {
      const int  m = n_columns, period = most_entries;
      const auto A = sparse(rows(n_rows, GetParam()), rows(n_columns, GetParam()), [=](const int i) {
        Row row;
        for (int k = 0; k < (period - i % period) % period; ++k)
          row[(7 * k + 3 * i) % m] = 1. / (1. + k + i);
        return row;
      });
      for (const int k : {1, 7, 8, 9, 33})
        {
          const MultiVector X        = random_vectors(A->columns(), k, 3);
          const DenseMatrix expected = to_dense(*A) * replicate(X);
          EXPECT_LT(max_norm(replicate(*A * X) - expected), 1e-14 * max_norm(expected)) << n_rows << " x " << m << ", " << k;
          const MultiVector Y    = random_vectors(A->rows(), k, 4);
          const DenseMatrix back = to_dense(*A).transpose() * replicate(Y);
          EXPECT_LT(max_norm(replicate(transpose_times(*A, Y)) - back), 1e-14 * max_norm(back)) << n_rows << " x " << m << ", " << k;
        }
    }
}

TEST(BlasThreads, AreSet)
{
  // 0 for BLAS libraries other than OpenBLAS, whose number of threads is unknown
  const int reported = set_blas_threads(1);
  EXPECT_TRUE(reported == 0 || reported == 1);

  // Check that all task threads are used while a large matrix is factorised
  set_task_threads(2);
  {
    const ThreadsOfFactorization small(1000);
    EXPECT_EQ(blas_threads(), reported);
  }
  {
    const ThreadsOfFactorization large(1000000);
    EXPECT_EQ(blas_threads(), 2 * reported);
  }
  EXPECT_EQ(blas_threads(), reported);
  set_task_threads(1);
}
