// Kernels that take a few vectors together: any number of columns, of rows and of threads, against products entry by entry.

#include "matrices.h"

#include <squeal/base/exceptions.h>
#include <squeal/base/tasks.h>
#include <squeal/linear_algebra/factorization.h>
#include <squeal/linear_algebra/replicate.h>

#include <gtest/gtest.h>

#include <limits>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  class Lanes : public ::testing::TestWithParam<Distribution>
  {};
  INSTANTIATE_TEST_SUITE_P(Distributions, Lanes, ::testing::Values(Distribution::even, Distribution::first_process_empty));

  /// More than one of the groups in which columns are taken, and all widths below that.
  const std::vector<int> numbers_of_columns = {1, 2, 3, 4, 5, 8, 9, 15, 16, 17, 25, 33};

  /// max |X − Y| / max |Y|
  double difference(const DenseMatrix &X, const DenseMatrix &Y)
  {
    return max_norm(DenseMatrix(X - Y)) / max_norm(Y);
  }

  /// Sums of products one after the other, by no library.
  DenseMatrix product(const DenseMatrix &A, const DenseMatrix &B)
  {
    DenseMatrix C = DenseMatrix::Zero(A.rows(), B.cols());
    for (Eigen::Index j = 0; j < C.cols(); ++j)
      for (Eigen::Index k = 0; k < A.cols(); ++k)
        for (Eigen::Index i = 0; i < C.rows(); ++i)
          C(i, j) += A(i, k) * B(k, j);
    return C;
  }

  /// Restores the number of threads.
  struct TaskThreads
  {
    explicit TaskThreads(const unsigned int n)
    {
      set_task_threads(n);
    }

    ~TaskThreads()
    {
      set_task_threads(1);
    }
  };
} // namespace

TEST_P(Lanes, ProductsOfFewVectorsWithMany)
{
  // Blocks of rows that end in the middle, and some rows only
  for (const int n : {3, 700})
    for (const int n_many : {15, 16, 43})
      {
        const MultiVector X     = random_vectors(rows(n, GetParam()), n_many, 1);
        const DenseMatrix all_X = replicate(X);
        for (const int k : numbers_of_columns)
          {
            const MultiVector Y     = random_vectors(X.map(), k, 2);
            const DenseMatrix all_Y = replicate(Y), S = agreed_random_matrix(n_many, k);
            EXPECT_LT(difference(gram(X, Y), product(all_X.transpose(), all_Y)), 1e-13) << n_many << " and " << k;
            for (const double beta : {0., 1., -2.})
              {
                MultiVector sum = Y;
                multiply_add(0.5, X, S, beta, sum);
                EXPECT_LT(difference(replicate(sum), 0.5 * product(all_X, S) + beta * all_Y), 1e-13) << n_many << " and " << k;
              }
          }
      }
}

TEST_P(Lanes, CombinationsThatReplaceWhatWasThere)
{
  const MultiVector X = random_vectors(rows(700, GetParam()), 20, 1);
  MultiVector       Y(X.map(), 8);
  Y.local().setConstant(std::numeric_limits<double>::quiet_NaN());
  const DenseMatrix S = agreed_random_matrix(20, 8);
  multiply_add(1., X, S, 0., Y);
  EXPECT_LT(difference(replicate(Y), product(replicate(X), S)), 1e-13);
}

TEST_P(Lanes, SparseProducts)
{
  // Rows without entries, and rows of more entries than are summed side by side
  const auto        A     = sparse(rows(90, GetParam()), rows(70, GetParam()), [](const int i) {
    Row row;
    for (int k = 0; k < i % 30; ++k)
      row[(7 * k + 3 * i) % 70] = 1. / (1. + k + i);
    return row;
  });
  const DenseMatrix all_A = to_dense(*A);
  for (const int k : numbers_of_columns)
    {
      const MultiVector X = random_vectors(A->columns(), k, 3);
      EXPECT_LT(difference(replicate(*A * X), product(all_A, replicate(X))), 1e-14) << k;
    }
}

TEST_P(Lanes, SolutionsForAnyNumberOfColumns)
{
  // Factors of one task; of several, with a top; of trees without a top
  for (const auto &A : {laplacian(7, 1, GetParam()), laplacian(22, 1, GetParam()), laplacian(9, 30, GetParam())})
    {
      const auto factor = factorize_positive_definite(*A, FactorizationLibrary::automatic, "test matrix");
      for (const unsigned int n_threads : {1, 2})
        {
          const TaskThreads threads(n_threads);
          for (const int k : numbers_of_columns)
            {
              const MultiVector B = random_vectors(A->rows(), k, 4);
              MultiVector       X(B.map(), k);
              factor->apply(B, X);
              EXPECT_LT(difference(replicate(*A * X), replicate(B)), 1e-12) << A->n_rows() << " rows, " << k << " columns";
            }
        }
    }
}

TEST_P(Lanes, SolutionsHardlyDependOnTheOtherColumns)
{
  const auto        A      = laplacian(16, 1, GetParam());
  const auto        factor = factorize_positive_definite(*A, FactorizationLibrary::automatic, "test matrix");
  const MultiVector B      = random_vectors(A->rows(), 33, 4);
  MultiVector       together(B.map(), 33), alone(B.map(), 1);
  factor->apply(B, together);
  for (const int j : {0, 16, 32})
    {
      factor->apply(view(B, j, 1), alone);
      EXPECT_LT(difference(replicate(alone), replicate(together).col(j)), 1e-13);
    }
}
