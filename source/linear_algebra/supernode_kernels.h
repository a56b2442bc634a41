#pragma once

#include "lane_row.h"

namespace Squeal
{
  /// Columns of a Cholesky factor with the same rows, stored as a dense matrix of @p n_rows × @p n_columns by columns: a lower triangle, and the
  /// rows below it.
  struct Supernode
  {
    int           n_columns, n_rows;
    const double *values;
  };

  // Kernels, compiled for several generations of processors, for the rows of vectors that belong to the rows of a supernode [L₁; L₂].

  /// Y₁ = L₁⁻¹ Y₁ and Y₂ = Y₂ − L₂ Y₁.
  void solve_forward(const Supernode &L, LaneRow<4> *Y);
  void solve_forward(const Supernode &L, LaneRow<8> *Y);
  void solve_forward(const Supernode &L, LaneRow<16> *Y);

  /// Y₁ = L₁⁻ᵀ (Y₁ − L₂ᵀ Y₂).
  void solve_backward(const Supernode &L, LaneRow<4> *Y);
  void solve_backward(const Supernode &L, LaneRow<8> *Y);
  void solve_backward(const Supernode &L, LaneRow<16> *Y);
} // namespace Squeal
