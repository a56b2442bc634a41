// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense.h>

namespace Squeal
{
  /// Orthonormal basis of the span of the columns of X, which must be nonzero and linearly independent, by Householder reflections.
  DenseMatrix orthonormal_columns(const DenseMatrix &X);

  /// X = Q R with orthonormal columns of Q. If column j of X is linearly dependent up to rounding, column j of Q and R_jj are zero.
  struct OrthonormalBasis
  {
    ComplexDenseMatrix Q, R;
  };

  /// Computes X = Q R by Cholesky factors for more than four well-conditioned columns, otherwise by the Gram-Schmidt process.
  OrthonormalBasis orthonormal_basis(const ComplexDenseMatrix &X);
} // namespace Squeal
