#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/dense_matrix.h>

#include <gtest/gtest.h>

#include <algorithm>

using namespace Squeal;

namespace
{
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
  const DenseMatrix B = columns(A, 1, 2);
  EXPECT_LT(max_norm(add(transpose(multiply(A, B)), multiply(B, A, true, true), -1.)), 1e-15);
  EXPECT_LT(max_norm(add(multiply(A, identity(3)), A, -1.)), 1e-16);
  EXPECT_EQ(multiply(DenseMatrix(2, 0), DenseMatrix(0, 3)).n_columns(), 3);
  EXPECT_THROW(multiply(A, DenseMatrix(2, 2)), SolverError);
}



TEST(DenseMatrices, LUSolvesBothWaysAndRefusesSingular)
{
  const DenseMatrix A = example();
  const DenseLU     lu(A, "test");
  for (const bool transposed : {false, true})
    {
      DenseMatrix X = identity(3);
      lu.solve(X, transposed);
      EXPECT_LT(max_norm(add(multiply(A, X, transposed), identity(3), -1.)), 1e-13);
    }
  EXPECT_GT(lu.reciprocal_condition(), 1e-4);
  EXPECT_LT(lu.reciprocal_condition(), 1.);

  DenseMatrix singular = A;
  for (int i = 0; i < 3; ++i)
    singular(i, 2) = singular(i, 0) - singular(i, 1);
  EXPECT_THROW(DenseLU(singular, "test"), SolverError);
}



TEST(DenseMatrices, SymmetricEigenvalues)
{
  DenseMatrix A(2, 2);
  A(0, 0) = A(1, 1) = 2.;
  A(0, 1) = A(1, 0) = 1.;
  DenseMatrix V     = A;
  EXPECT_NEAR(symmetric_eigenvalues(V)[0], 1., 1e-15);
  EXPECT_LT(max_norm(add(multiply(V, V, true), identity(2), -1.)), 1e-15);

  DenseMatrix B(2, 2);
  B(0, 0)            = 2.;
  B(1, 1)            = 1.;
  DenseMatrix W      = A;
  const auto  values = symmetric_eigenvalues(W, B);
  EXPECT_NEAR(values[0] * values[1], 3. / 2., 1e-14);
  EXPECT_NEAR(values[0] + values[1], 3., 1e-14);
  EXPECT_LT(max_norm(add(multiply(W, multiply(B, W), true), identity(2), -1.)), 1e-14);
}



TEST(DenseMatrices, EigenpairsOfANonsymmetricMatrix)
{
  // One real eigenvalue and a conjugate pair.
  DenseMatrix A(3, 3);
  A(0, 0) = 2.;
  A(1, 2) = -3.;
  A(2, 1) = 3.;
  A(0, 1) = A(2, 0)           = 0.5;
  const DenseEigenpairs pairs = eigenpairs(A, true);

  ComplexDenseMatrix C(3, 3);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      C(i, j) = A(i, j);
  const ComplexDenseMatrix AR = multiply(C, pairs.right), LA = multiply(pairs.left, C, true);
  int                      n_complex = 0;
  for (int j = 0; j < 3; ++j)
    {
      n_complex += pairs.values[j].imag() != 0.;
      for (int i = 0; i < 3; ++i)
        {
          EXPECT_LT(std::abs(AR(i, j) - pairs.values[j] * pairs.right(i, j)), 1e-14);
          EXPECT_LT(std::abs(LA(j, i) - pairs.values[j] * std::conj(pairs.left(i, j))), 1e-14);
        }
    }
  EXPECT_EQ(n_complex, 2);
}



TEST(DenseMatrices, SingularValuesAndKernel)
{
  const DenseMatrix A = example(), tall = multiply(A, columns(A, 0, 2), true);
  for (const DenseMatrix &B : {A, tall, transpose(tall)})
    {
      const auto [values, V] = singular_values(B);
      const int n = B.n_columns(), k = values.size();
      ASSERT_EQ(k, std::min(B.n_rows(), n));
      EXPECT_TRUE(std::is_sorted(values.rbegin(), values.rend()));
      EXPECT_LT(max_norm(add(multiply(V, V, true), identity(n), -1.)), 1e-14);
      const DenseMatrix BV = multiply(B, V), squares = multiply(BV, BV, true);
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
          EXPECT_NEAR(squares(i, j), i == j && i < k ? values[i] * values[i] : 0., 1e-13);
    }
  EXPECT_TRUE(singular_values(DenseMatrix(0, 3)).values.empty());
}
