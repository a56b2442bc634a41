#pragma once

#include "lane_row.h"

namespace Squeal
{
  // Kernels, compiled for several generations of processors: products of a few vectors, whose rows lie beside each other, with many.

  /// Some rows of many vectors, by columns that are @p stride numbers apart.
  struct TallBlock
  {
    int           n_rows, n_columns;
    const double *values;
    std::size_t   stride;
  };

  /// S += Vᵀ W, n_columns of V × width.
  void add_products(const TallBlock &V, const LaneRow<8> *W, LaneRow<8> *S);
  void add_products(const TallBlock &V, const LaneRow<16> *W, LaneRow<16> *S);

  /// W += V S.
  void add_combinations(const TallBlock &V, const LaneRow<8> *S, LaneRow<8> *W);
  void add_combinations(const TallBlock &V, const LaneRow<16> *S, LaneRow<16> *W);

  /// Rows of a sparse matrix: the entries of row i are those from start[i] up to start[i + 1].
  struct SparseRows
  {
    int           n_rows;
    const int    *start, *column;
    const double *value;
  };

  /// Y = A X.
  void set_products(const SparseRows &A, const LaneRow<8> *X, LaneRow<8> *Y);
  void set_products(const SparseRows &A, const LaneRow<16> *X, LaneRow<16> *Y);
} // namespace Squeal
