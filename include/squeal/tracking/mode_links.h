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

  /// Group of modes at one point and the corresponding group at a neighbouring point.
  struct ModeBlock
  {
    std::vector<int> first, second; ///< indices of the modes; the same number at both points
    /// True if both groups span similar subspaces and their modes have definite counterparts: a single mode, a multiple λ at one of the
    /// points (any order), or two modes with an exceptional point in between. Otherwise the step is too large.
    bool resolved;
  };

  /// Counterparts among the modes of two neighbouring points.
  struct ModeLinks
  {
    std::vector<ModeBlock> blocks;
    std::vector<int>       lost, gained; ///< modes without counterpart, of the first and of the second point
    bool resolved; ///< true if blocks with modes in the band are resolved and modes without counterpart match the change in real λ
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
   * the trace of the product of the spectral projectors (the relative gain array of X). Both sums are one for any angles between the
   * vectors at one point, which are nearly parallel close to a coalescence. T = ½ across an exceptional point of two modes for any step
   * size; there the common subspace is analytic and (λ_1 − λ_2)², which is real, changes its sign. In all other cases T tends to a
   * permutation as steps become smaller.
   *
   * Modes beyond @p largest_circular_frequency [rad/s] may appear and disappear. For modes in the band, the number of real pairs must
   * change in the opposite way; otherwise, the links are unresolved.
   */
  ModeLinks link_modes(const ChartPoint &first, const ChartPoint &second, double largest_circular_frequency);
} // namespace Squeal
