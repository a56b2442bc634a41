// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense.h>

namespace Squeal
{
  /// Orthonormal basis of the span of the columns of X, none of them zero and as independent as they may be, by Householder's reflections.
  DenseMatrix orthonormal_columns(const DenseMatrix &X);

  /// X = Q R with orthonormal columns of Q, but for zeros where a column of X is dependent up to rounding: there R_jj = 0.
  struct OrthonormalBasis
  {
    ComplexDenseMatrix Q, R;
  };

  /// By Cholesky factors where that is safe, else by the Gram-Schmidt process.
  OrthonormalBasis orthonormal_basis(const ComplexDenseMatrix &X);
} // namespace Squeal
