// SPDX-License-Identifier: GPL-3.0-or-later

#include "matrices.h"

#include <squeal/base/tasks.h>
#include <squeal/linear_algebra/factorization.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /// Results computed from the same vectors with a given number of threads.
  struct Results
  {
    explicit Results(const unsigned int n_threads)
    {
      set_task_threads(n_threads);
      const MultiVector X = random_vectors(K->rows(), 11);
      products            = std::make_shared<MultiVector>(*K * X);
      inner               = gram(X, *products);
      combinations        = std::make_shared<MultiVector>(X);
      multiply_add(0.5, X, inner, -2., *combinations);
      solutions = std::make_shared<MultiVector>(X.map(), X.n_columns());
      factorize_positive_definite(*K, FactorizationLibrary::automatic, "test matrix")->apply(X, *solutions);
      set_task_threads(1);
    }

    // The matrix has more rows than a task
    std::shared_ptr<const SparseMatrix> K = laplacian(24, 1);
    std::shared_ptr<MultiVector>        products, combinations, solutions;
    DenseMatrix                         inner;
  };
} // namespace

TEST(Threads, ChangeRoundingOfSolutionsOnly)
{
  constexpr double rounding = 1e-14;
  const Results    one(1);
  for (const unsigned int n_threads : {2, 3})
    {
      const Results several(n_threads);
      EXPECT_EQ(relative_difference(*several.products, *one.products), 0.);
      EXPECT_EQ(max_norm(several.inner - one.inner), 0.);
      EXPECT_EQ(relative_difference(*several.combinations, *one.combinations), 0.);
      EXPECT_LE(relative_difference(*several.solutions, *one.solutions), rounding);
    }
}
