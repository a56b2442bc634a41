// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense.h>

namespace Squeal
{
  /// Orthonormal basis of the span of the columns of X, which must be nonzero and linearly independent, by Householder reflections.
  DenseMatrix orthonormal_columns(const DenseMatrix &X);

  /// X = Q R with orthonormal columns of Q, except zero columns where a column of X is dependent up to rounding: there R_jj = 0.
  struct OrthonormalBasis
  {
    ComplexDenseMatrix Q, R;
  };

  /// Uses Cholesky factors if that is safe, else the Gram-Schmidt process.
  OrthonormalBasis orthonormal_basis(const ComplexDenseMatrix &X);
} // namespace Squeal
