#pragma once

#include "solutions.h"

namespace Squeal::Testing
{
  /// ẍ + K̃ x = 0 of two unit masses with one contact, K̃ = [3, 0.7 − s μ; 0.7, 2]: the modes coalesce where 1 + 2.8 (0.7 − s μ) = 0.
  inline CoupledSystem flutter(const double s)
  {
    return system_of({sparse(DenseMatrix::Identity(2, 2)), nullptr, sparse(DenseMatrix{{3., 0.7}, {0.7, 2.}})},
                     sparse(DenseMatrix{{1., 0.}}), sparse(DenseMatrix{{0., s}}));
  }
} // namespace Squeal::Testing
