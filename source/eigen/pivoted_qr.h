#pragma once

#include <squeal/linear_algebra/dense.h>
#include <squeal/linear_algebra/multivector.h>

#include <vector>

namespace Squeal
{
  /**
   * X Π = Q R by modified Gram–Schmidt with column pivoting; columns left
   * with no more than @p smallest, one for each, are dropped. Q replaces the
   * first columns of X; returns R Πᵀ, k × b.
   */
  DenseMatrix pivoted_qr(MultiVector &X, std::vector<double> smallest);

  /// The same for a small matrix, by Householder reflections (X is replaced by Q, n × k).
  DenseMatrix pivoted_qr(DenseMatrix &X, double smallest);

  /// Smallest pivot of R Πᵀ by pivoted_qr() / norm of its column.
  double smallest_share(const DenseMatrix &R);
} // namespace Squeal
