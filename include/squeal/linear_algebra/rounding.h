#pragma once

#include <squeal/linear_algebra/sparse_matrix.h>

namespace Squeal
{
  /**
   * ω² [rad²/s²] up to which rounding errors of K hide the frequency of a motion, K φ = ω² M φ, whatever the band,
   *
   *   100 ε ρ,   ρ: geometric mean over the rows, weighted by mass, of Σ_j |K_ij| / Σ_j |M_ij|.
   *
   * φᵀKφ of a motion like that of a rigid body sums entries of K that cancel, of size ρ φᵀMφ; its error is some ε ρ at most. The
   * mean is that of the heavy bodies: those that are light and stiff take no part in such a motion. All processes must call.
   */
  double unresolved_square(const SparseMatrix &K, const SparseMatrix &M);
} // namespace Squeal
