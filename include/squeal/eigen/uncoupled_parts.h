#pragma once

#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <memory>
#include <vector>

namespace Squeal
{
  /**
   * Rows of a square symmetric matrix that belong together: the connected parts of its graph, in the order of their first rows.
   * Of each the map of its rows, which bear the same global numbers and stay where they are.
   */
  std::vector<RowMap> uncoupled_parts(const SparseMatrix &A);

  /// Rows and columns of @p A in one of its uncoupled parts.
  std::shared_ptr<SparseMatrix> part(const SparseMatrix &A, const RowMap &rows);

  /// Copies vectors of a part into columns @p first, ... of @p target, which lives on all rows.
  void insert_part(const MultiVector &vectors, int first, MultiVector &target);
} // namespace Squeal
