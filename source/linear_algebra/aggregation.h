#pragma once

#include <squeal/linear_algebra/multigrid.h>

namespace Squeal
{
  /// A level of a hierarchy: its matrix and what takes vectors of the next, coarser one to it.
  struct Level
  {
    std::shared_ptr<const SparseMatrix> matrix;       ///< null on the finest level: the caller's
    std::shared_ptr<const SparseMatrix> prolongation; ///< null on the coarsest
  };

  /// Rows of a matrix from which on it is not coarsened any more.
  constexpr int largest_coarse_matrix = 600;

  /// The levels of smoothed aggregation by MueLu, finest first; the coarsest is small enough for a dense inverse.
  std::vector<Level> aggregate(const SparseMatrix &A, const NearNullSpace &space, const std::string &what);
} // namespace Squeal
