#pragma once

#include <squeal/linear_algebra/dense.h>

namespace Squeal
{
  /// Xᴴ M Y from the Gram matrix of [Re X, Im X] and [Re Y, Im Y].
  ComplexDenseMatrix hermitian_products(const DenseMatrix &G);

  /**
   * cos² of the principal angles between the spans of two sets of vectors, ascending.
   *
   * @param A, B Gram matrices of both sets, Hermitian positive semidefinite
   * @param C    products of the first with the second
   */
  Eigen::VectorXd squared_cosines(const ComplexDenseMatrix &A, const ComplexDenseMatrix &B, const ComplexDenseMatrix &C);

  /// ‖Pψ‖² / ‖ψ‖² for the projection P on the span of vectors with Gram matrix A, of which C are the products with all ψ; B those of ψ.
  Eigen::RowVectorXd shares_in_span(const ComplexDenseMatrix &A, const ComplexDenseMatrix &C, const ComplexDenseMatrix &B);
} // namespace Squeal
