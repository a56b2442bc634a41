#include "near_null_spaces.h"

#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/iterative_inverse.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  class MultigridOn : public ::testing::TestWithParam<Distribution>
  {};
  INSTANTIATE_TEST_SUITE_P(Distributions, MultigridOn, ::testing::Values(Distribution::even, Distribution::first_process_empty));

  constexpr std::array<int, 3> cells = {{30, 12, 2}};

  /// Largest relative residual of A X = B.
  double residual(const SparseMatrix &A, const MultiVector &X, const MultiVector &B)
  {
    const std::vector<double> left = column_norms(B - A * X), norm = column_norms(B);
    double                    largest = 0.;
    for (std::size_t j = 0; j < left.size(); ++j)
      largest = std::max(largest, left[j] / norm[j]);
    return largest;
  }
} // namespace

TEST_P(MultigridOn, CyclesAreSymmetricAndDefinite)
{
  const Body        body = plate(cells, 0.01, 1e11, GetParam());
  const Multigrid   cycle(*body.stiffness, near_null_space_of_plate(body.stiffness->rows(), cells, 0.01), "test");
  const MultiVector X = random_vectors(body.stiffness->rows(), 20);
  MultiVector       Y(X.map(), X.n_columns());
  cycle.apply(X, Y);
  const DenseMatrix G = gram(X, Y);
  EXPECT_LT(max_norm(DenseMatrix(G - G.transpose())), 1e-5 * max_norm(G));
  EXPECT_GT(symmetric_eigenpairs(DenseMatrix(0.5 * (G + G.transpose()))).values.front(), 0.);
  EXPECT_GE(cycle.n_levels(), 2);
  EXPECT_TRUE(cycle.map() == body.stiffness->rows());
}

TEST_P(MultigridOn, BlocksAreSolvedToTheTolerance)
{
  const Body  body    = plate(cells, 0.01, 1e11, GetParam());
  const auto  inverse = iterative_inverse(*body.stiffness, near_null_space_of_plate(body.stiffness->rows(), cells, 0.01), "test");
  MultiVector B       = random_vectors(body.stiffness->rows(), 70);
  // A column of zeros and one that depends on another
  B.col(3).setZero();
  B.col(5) = 1e6 * B.col(4);
  MultiVector X(B.map(), B.n_columns());
  X.local().setConstant(7.);
  inverse->apply(B, X);
  EXPECT_EQ(column_norms(X)[3], 0.);
  std::vector<int> others;
  for (int j = 0; j < 70; ++j)
    if (j != 3)
      others.push_back(j);
  EXPECT_LT(residual(*body.stiffness, selected(X, others), selected(B, others)), 2e-12);
  EXPECT_EQ(inverse->n_vectors(), 70);

  // The same as by a factorisation
  MultiVector Y(B.map(), B.n_columns());
  factorize_positive_definite(*body.stiffness, FactorizationLibrary::mumps, "test")->apply(B, Y);
  for (const int j : others)
    EXPECT_LT(column_norms(X - Y)[j], 1e-9 * column_norms(Y)[j]) << j;
}

TEST_P(MultigridOn, StepsHardlyGrowWithTheSystem)
{
  std::vector<double> steps;
  for (const int factor : {1, 2})
    {
      const std::array<int, 3> finer = {{12 * factor, 12 * factor, 2 * factor}};
      const double             h     = 0.02 / factor;
      const Body               body  = plate(finer, h, 1e11, GetParam());
      const auto        inverse = iterative_inverse(*body.stiffness, near_null_space_of_plate(body.stiffness->rows(), finer, h), "test");
      const MultiVector B       = random_vectors(body.stiffness->rows(), 4);
      MultiVector       X(B.map(), 4);
      inverse->apply(B, X);
      steps.push_back(inverse->n_steps());
      EXPECT_LT(inverse->n_factor_entries(), 2. * body.stiffness->n_entries());
    }
  EXPECT_LT(steps[1], 1.7 * steps[0]);
}

TEST_P(MultigridOn, ScalarProblemsWithOneVector)
{
  const auto    A = laplacian(12, 1, GetParam());
  NearNullSpace space{MultiVector(A->rows(), 1), {}};
  for (int i = 0; i < A->rows().n_local(); ++i)
    {
      space.vectors(i, 0) = 1.;
      space.points.push_back(A->rows().number(i));
    }
  const MultiVector B = random_vectors(A->rows(), 3);
  MultiVector       X(B.map(), 3);
  iterative_inverse(*A, space, "test")->apply(B, X);
  EXPECT_LT(residual(*A, X, B), 2e-12);
}

TEST_P(MultigridOn, MatricesThatAreNotDefiniteAreRefused)
{
  const std::array<int, 3> small = {{12, 8, 2}};
  const Body               body  = plate(small, 0.01, 1e11, GetParam());
  const auto               A     = add(1., *body.stiffness, -1e9, *body.mass);
  const MultiVector        B     = random_vectors(A->rows(), 3);
  MultiVector              X(B.map(), 3);
  EXPECT_THROW(iterative_inverse(*A, near_null_space_of_plate(A->rows(), small, 0.01), "test")->apply(B, X), SolverError);
}
