// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense.h>
#include <squeal/linear_algebra/sparse_matrix.h>

namespace Squeal
{
  /// Y = A X for the rows of A and those columns of it that are known here.
  void multiply_rows(const SparseRows &A, const Eigen::Ref<const DenseMatrix> &X, Eigen::Ref<DenseMatrix> Y);

  /// Y = Aᵀ X for all rows of A. Columns of X are tasks.
  void multiply_transpose(const SparseRows &A, const Eigen::Ref<const DenseMatrix> &X, Eigen::Ref<DenseMatrix> Y);
} // namespace Squeal
