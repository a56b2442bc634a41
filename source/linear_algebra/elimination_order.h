#pragma once

#include <squeal/linear_algebra/sparse_matrix.h>

#include <vector>

namespace Squeal
{
  /**
   * The rows of a symmetric matrix of one process in an order of elimination that leaves few entries in its factors: the better one of
   * approximate minimum degree (AMD) and nested dissection (METIS), of which small matrices take the first unseen. A factor of K and the
   * count of the modes of K - s M have one pattern, so that the last orders are kept. Several threads may ask; the order is always the
   * same. Throws SolverError naming @p what if CHOLMOD fails.
   */
  std::vector<int> elimination_order(const SparseMatrix &A, const std::string &what);
} // namespace Squeal
