#include "matrices.h"

#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/sparse.h>
#include <squeal/linear_algebra/sparse_determinant.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  using Complex = std::complex<double>;

  /// Distance of two logarithms of one number.
  double distance(const Complex a, const Complex b)
  {
    return std::hypot(a.real() - b.real(), std::remainder(a.imag() - b.imag(), 2. * M_PI));
  }
} // namespace



TEST(Determinants, OfADenseComplexMatrix)
{
  // Rows in an order that makes the factorisation exchange them
  ComplexDenseMatrix A(3, 3);
  A(0, 1) = {0., 2.};
  A(1, 2) = {3., 0.};
  A(2, 0) = {1., 1.};
  A(0, 0) = 0.5;
  const ComplexDenseLU lu(A);
  // Both cyclic exchanges are even: 2i · 3 · (1 + i)
  EXPECT_LT(distance(lu.log_determinant(), std::log(Complex(0., 6.) * Complex(1., 1.))), 1e-14);

  ComplexDenseMatrix B = A;
  lu.solve(B);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      EXPECT_LT(std::abs(B(i, j) - (i == j ? 1. : 0.)), 1e-14);

  ComplexDenseMatrix inverse(3, 3);
  for (int i = 0; i < 3; ++i)
    inverse(i, i) = 1.;
  lu.solve(inverse);
  double norm = 0.;
  for (int j = 0; j < 3; ++j)
    norm = std::max(norm, std::abs(inverse(0, j)) + std::abs(inverse(1, j)) + std::abs(inverse(2, j)));
  EXPECT_NEAR(lu.inverse_norm(), norm, 1e-12);

  A(1, 2) = 0.;
  const ComplexDenseLU singular(A);
  EXPECT_EQ(singular.log_determinant().real(), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(singular.inverse_norm(), std::numeric_limits<double>::infinity());
}



TEST(Determinants, BalancingKeepsThemAndTheTrace)
{
  ComplexDenseMatrix A(3, 3);
  const double       scale[] = {1e-6, 1., 1e5};
  Complex            trace   = 0.;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      A(i, j) = scale[i] / scale[j] * Complex(1. + i, i == j ? 2. : 0.3 * j);
  const ComplexDenseMatrix B = balanced(A);
  for (int j = 0; j < 3; ++j)
    trace += B(j, j) - A(j, j);
  EXPECT_LT(std::abs(trace), 1e-13);
  EXPECT_LT(distance(ComplexDenseLU(A).log_determinant(), ComplexDenseLU(B).log_determinant()), 1e-12);
  EXPECT_GT(frobenius_norm(A), 1e10);
  EXPECT_LT(frobenius_norm(B), 20.);
}



TEST(Determinants, OfASparseQuadraticPencil)
{
  const Epetra_Map map = rows(40);
  const auto       M   = Testing::diagonal(map, [](const int i) { return 1. + 0.1 * i; });
  const auto       C   = sparse(map, map, [](const int i) { return i > 2 ? Row{{i - 3, 0.2}} : Row{{39 - i, 0.5}}; });
  const auto       K   = sparse(map, map, [](const int i) { return i < 39 ? Row{{i, 2.}, {i + 1, -1.}} : Row{{i, 2.}, {0, 0.7}}; });
  if (map.Comm().NumProc() > 1)
    {
      EXPECT_THROW(SparseDeterminant(*M, C.get(), *K), SolverError);
      return;
    }
  const DenseMatrix M_dense = to_dense(*M), C_dense = to_dense(*C), K_dense = to_dense(*K);
  for (const bool damped : {false, true})
    for (const Complex lambda : {Complex(0.3, 1.), Complex(-0.2, 0.4), Complex(0., 2.)})
      {
        ComplexDenseMatrix Q(40, 40);
        for (int j = 0; j < 40; ++j)
          for (int i = 0; i < 40; ++i)
            Q(i, j) = K_dense(i, j) + lambda * (damped ? C_dense(i, j) : 0.) + lambda * lambda * M_dense(i, j);
        const Complex expected = ComplexDenseLU(Q).log_determinant();
        EXPECT_LT(distance(SparseDeterminant(*M, damped ? C.get() : nullptr, *K).logarithm(lambda), expected), 1e-11);
      }

  // λ² + 4 = 0
  const auto one = Testing::diagonal(map, [](int) { return 1.; }), four = Testing::diagonal(map, [](int) { return 4.; });
  EXPECT_EQ(SparseDeterminant(*one, nullptr, *four).logarithm({0., 2.}).real(), -std::numeric_limits<double>::infinity());
}
