// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/tracking/chart_point.h>

#include <complex>
#include <optional>
#include <vector>

namespace Squeal
{
  /// |λ_i − λ_j| / |λ_i| below which vectors of modes are arbitrary within their common span [-].
  constexpr double indistinguishable = 1e-7;

  /// Modes of two neighbouring points that span the same subspace.
  struct ModeBlock
  {
    std::vector<int> first, second; ///< numbers of the modes, as many at either point
    /// Whether each mode has its counterpart: a single mode; a multiple λ at one of the points, of which any order will do; two modes with
    /// an exceptional point between. Otherwise the step is too long.
    bool resolved;
  };

  /// Which modes of two neighbouring points belong together.
  struct ModeLinks
  {
    std::vector<ModeBlock> blocks;
    std::vector<int>       lost, gained; ///< modes without counterpart at the second, at the first point
    bool                   resolved;     ///< whether that holds for every mode in the band
  };

  /// Number of the cluster of each λ: chains of neighbours that are indistinguishable.
  std::vector<int> mode_clusters(const std::vector<std::complex<double>> &lambda);

  /// The vectors with those of each cluster of λ replaced by an orthonormal basis of their span: an eigensolver chooses them within that
  /// span by rounding errors, and what is summed over them must not depend on its choice.
  ComplexDenseMatrix orthonormal_in_clusters(const ComplexDenseMatrix &vectors, const std::vector<std::complex<double>> &lambda);

  /// X of Φ_b ≈ Φ_a X in the least-squares sense and its inverse, for as many columns on either side; nothing if one does not exist.
  struct Transformation
  {
    ComplexDenseMatrix X, inverse;
  };
  std::optional<Transformation> transformation(const ComplexDenseMatrix &first, const ComplexDenseMatrix &second);

  /// Sign of δ² = (λ_1 − λ_2)²: −1 for equal growth rates, +1 for equal frequencies, 0 where it is not real.
  int pair_sign(const std::complex<double> &lambda_1, const std::complex<double> &lambda_2);

  /**
   * Links modes of neighbouring points by their vectors, right and left, never
   * by their numbers. Modes of both points are collected into blocks that
   * overlap, |φ_aᴴφ_b|² in the span of multiple λ, and whose subspaces agree.
   * Within a block Φ_b = Φ_a X, and
   *
   *   T_ij = Re X_ij (X⁻¹)_ji,   Σ_i T_ij = Σ_j T_ij = 1,
   *
   * the trace of the product of the spectral projectors (the relative gain
   * array of X), says how much of mode i is mode j, whatever the angles between the
   * vectors of one point: close to a coalescence they are parallel. T = ½
   * across an exceptional point of two modes, however short the step; there the
   * common subspace is analytic and (λ_1 − λ_2)², which is real, changes
   * sign. Everything else tends to a permutation as steps become shorter.
   *
   * Modes beyond @p largest_circular_frequency [rad/s] may come and go; modes in the band
   * only if as many pairs of real values go or come.
   */
  ModeLinks link_modes(const ChartPoint &first, const ChartPoint &second, double largest_circular_frequency);
} // namespace Squeal
