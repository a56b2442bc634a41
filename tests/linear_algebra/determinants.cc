// SPDX-License-Identifier: GPL-3.0-or-later

#include "matrices.h"

#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/dense_lu.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/linear_algebra/sparse_determinant.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  using Complex = std::complex<double>;

  /// Distance of two complex logarithms modulo 2π i.
  double distance(const Complex a, const Complex b)
  {
    return std::hypot(a.real() - b.real(), std::remainder(a.imag() - b.imag(), 2. * M_PI));
  }
} // namespace

TEST(Determinants, OfADenseComplexMatrix)
{
  // The pivot of the first column is not on the diagonal
  ComplexDenseMatrix A = ComplexDenseMatrix::Zero(3, 3);
  A(0, 1)              = {0., 2.};
  A(1, 2)              = {3., 0.};
  A(2, 0)              = {1., 1.};
  A(0, 0)              = 0.5;
  const ComplexLU lu(A);
  // The cyclic permutation of the rows is even
  EXPECT_LT(distance(lu.log_determinant(), std::log(Complex(0., 6.) * Complex(1., 1.))), 1e-14);

  const ComplexDenseMatrix I = ComplexDenseMatrix::Identity(3, 3);
  EXPECT_LT(max_norm(lu.solve(A) - I), 1e-14);
  EXPECT_NEAR(lu.inverse_norm(), lu.solve(I).cwiseAbs().colwise().sum().maxCoeff(), 1e-12);

  A(1, 2) = 0.;
  const ComplexLU singular(A);
  EXPECT_EQ(singular.log_determinant().real(), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(singular.inverse_norm(), std::numeric_limits<double>::infinity());

  // Matrices with NaN are not factorised
  A(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(ComplexLU(A).inverse_norm(), std::numeric_limits<double>::infinity());
}

TEST(Determinants, BalancingKeepsThemAndTheTrace)
{
  ComplexDenseMatrix A       = ComplexDenseMatrix::Zero(3, 3);
  const double       scale[] = {1e-6, 1., 1e5};
  Complex            trace   = 0.;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      A(i, j) = scale[i] / scale[j] * Complex(1. + i, i == j ? 2. : 0.3 * j);
  const ComplexDenseMatrix B = balanced(A);
  for (int j = 0; j < 3; ++j)
    trace += B(j, j) - A(j, j);
  EXPECT_LT(std::abs(trace), 1e-13);
  EXPECT_LT(distance(ComplexLU(A).log_determinant(), ComplexLU(B).log_determinant()), 1e-12);
  EXPECT_GT(A.norm(), 1e10);
  EXPECT_LT(B.norm(), 20.);
}

TEST(Determinants, OfASparseQuadraticPencil)
{
  const RowMap map = rows(40);
  const auto   M   = Testing::diagonal(map, [](const int i) { return 1. + 0.1 * i; });
  const auto   C   = sparse(map, map, [](const int i) { return i > 2 ? Row{{i - 3, 0.2}} : Row{{39 - i, 0.5}}; });
  const auto   K   = sparse(map, map, [](const int i) { return i < 39 ? Row{{i, 2.}, {i + 1, -1.}} : Row{{i, 2.}, {0, 0.7}}; });
  if (map.n_processes() > 1)
    {
      EXPECT_THROW(SparseDeterminant(*M, C.get(), *K), SolverError);
      return;
    }
  const DenseMatrix M_dense = to_dense(*M), C_dense = to_dense(*C), K_dense = to_dense(*K);
  for (const bool damped : {false, true})
    for (const Complex lambda : {Complex(0.3, 1.), Complex(-0.2, 0.4), Complex(0., 2.)})
      {
        const ComplexDenseMatrix Q        = K_dense + lambda * (damped ? 1. : 0.) * C_dense + lambda * lambda * M_dense;
        const Complex            expected = ComplexLU(Q).log_determinant();
        EXPECT_LT(distance(SparseDeterminant(*M, damped ? C.get() : nullptr, *K).logarithm(lambda), expected), 1e-11);
      }

  // The determinant of (λ² + 4) I vanishes at λ = 2i
  const auto one = Testing::diagonal(map, [](int) { return 1.; }), four = Testing::diagonal(map, [](int) { return 4.; });
  EXPECT_EQ(SparseDeterminant(*one, nullptr, *four).logarithm({0., 2.}).real(), -std::numeric_limits<double>::infinity());
}
