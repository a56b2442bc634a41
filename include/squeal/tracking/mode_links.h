// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/tracking/chart_point.h>

#include <complex>
#include <optional>
#include <vector>

namespace Squeal
{
  /// Modes with a smaller |λ_i − λ_j| / |λ_i| form a multiple λ: their vectors are arbitrary within their common span [-].
  constexpr double indistinguishable = 1e-7;

  /// Modes of two neighbouring points that span the same subspace.
  struct ModeBlock
  {
    std::vector<int> first, second; ///< indices of the modes; the same number at both points
    /// True if the modes of the block have definite counterparts: a single mode, a multiple λ at one of the points (any order), or two
    /// modes with an exceptional point in between. Otherwise the step is too large.
    bool resolved;
  };

  /// Counterparts among the modes of two neighbouring points.
  struct ModeLinks
  {
    std::vector<ModeBlock> blocks;
    std::vector<int>       lost, gained; ///< modes without counterpart, of the first and of the second point
    bool                   resolved;     ///< true if all blocks with modes in the band are resolved
  };

  /// Index of the cluster of each λ: chains of indistinguishable neighbours.
  std::vector<int> mode_clusters(const std::vector<std::complex<double>> &lambda);

  /// Replaces the vectors of each cluster of λ by an orthonormal basis of their span. The vectors of an eigensolver within this span depend
  /// on rounding errors, and so do sums over these vectors.
  ComplexDenseMatrix orthonormal_in_clusters(const ComplexDenseMatrix &vectors, const std::vector<std::complex<double>> &lambda);

  /// X with Φ_b ≈ Φ_a X in the least-squares sense, and its inverse, for equal numbers of columns; empty if X or the inverse does not
  /// exist.
  struct Transformation
  {
    ComplexDenseMatrix X, inverse;
  };
  std::optional<Transformation> transformation(const ComplexDenseMatrix &first, const ComplexDenseMatrix &second);

  /// Sign of δ² = (λ_1 − λ_2)²: −1 for equal growth rates, +1 for equal frequencies, 0 if δ² is not real.
  int pair_sign(const std::complex<double> &lambda_1, const std::complex<double> &lambda_2);

  /**
   * Links modes of neighbouring points by their right and left vectors, not by index. Modes of both points are grouped into blocks that
   * overlap, by |φ_aᴴφ_b|² in the span of multiple λ, and whose subspaces agree. Within a block, Φ_b = Φ_a X. The contribution of mode j to
   * mode i is
   *
   *   T_ij = Re X_ij (X⁻¹)_ji,   Σ_i T_ij = Σ_j T_ij = 1,
   *
   * the trace of the product of the spectral projectors (the relative gain array of X). This holds for any angles between the vectors at
   * one point, which are nearly parallel close to a coalescence. T = ½ across an exceptional point of two modes for any step size; there
   * the common subspace is analytic and (λ_1 − λ_2)², which is real, changes its sign. In all other cases T tends to a permutation as steps
   * become smaller.
   *
   * Modes beyond @p largest_circular_frequency [rad/s] may appear and disappear. Modes in the band may do so only if the number of real
   * pairs changes in the opposite way.
   */
  ModeLinks link_modes(const ChartPoint &first, const ChartPoint &second, double largest_circular_frequency);
} // namespace Squeal
