#pragma once

#include <squeal/linear_algebra/sparse_matrix.h>

#include <memory>
#include <vector>

namespace Squeal
{
  /// Rows of a matrix that nothing couples with others; they stay on their processes.
  struct UncoupledPart
  {
    RowMap                                  map;
    std::vector<int>                        places;  ///< of its rows among those of this process
    std::shared_ptr<const std::vector<int>> numbers; ///< of all rows of the matrix, each in its part
  };

  /// The connected parts of the graph of a square symmetric matrix, in the order of their first rows.
  std::vector<UncoupledPart> uncoupled_parts(const SparseMatrix &A);

  /// Rows and columns of @p A in one of its uncoupled parts.
  std::shared_ptr<SparseMatrix> matrix_of(const UncoupledPart &part, const SparseMatrix &A);
} // namespace Squeal
