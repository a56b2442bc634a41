// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense_eigenproblems.h>

#include <optional>

namespace Squeal
{
  /// The part of a small n × n matrix A that has the modes of a band: A R = R S, Lᵀ A = S Lᵀ, Lᵀ R = I.
  struct BandSubspaces
  {
    DenseMatrix right; ///< R, n × k
    DenseMatrix left;  ///< L, n × k
    DenseMatrix small; ///< S, k × k; its eigenvalues, −λ² or λ, belong to R and L
  };

  /**
   * Invariant subspaces of A φ = −λ² φ that have every λ with |Im λ| ≤ @p largest_circular_frequency [rad/s].
   *
   * A is given in coordinates of the modes of a symmetric pencil near by, whose −λ² are @p squares, ascending. With those of the band
   * first, up to the widest gap beyond it, A has blocks B_ij, and
   *
   *   R = [I; X],           B_21 + B_22 X − X (B_11 + B_12 X) = 0,
   *   Lᵀ = [I − Y X, Y],    S_1 Y − Y T − B_12 = 0,   S_1 = B_11 + B_12 X,  T = B_22 − X B_12.
   *
   * Both are solved step by step with the diagonal operator of the symmetric pencil in place of their own (Stewart 1973, Demmel 1987), a
   * few products of blocks each, which Anderson's method combines; S = LᵀAR, so that its error is the product of those of X and Y.
   * That T has no eigenvalue of the band, λ that are real included, follows from Lyapunov's theorem with P = diag(T), else from powers,
   *
   *   P (T − ω² I) + (T − ω² I)ᵀ P positive definite, or
   *   Z = (T − ω² I − a I) (T − ω² I + a I)⁻¹:  ‖Z^m‖ < 1 for any m     =>   Re(−λ²) > ω² for all of T.
   *
   * @return nothing if the band is not well apart, if the steps do not converge, or if neither test succeeds
   */
  std::optional<BandSubspaces> band_subspaces(const DenseMatrix &A, const std::vector<double> &squares, double largest_circular_frequency);

  /**
   * The same with dissipation: invariant subspaces of
   *
   *   [ 0   I ]
   *   [ -A -C ]  [φ; λ φ] = λ [φ; λ φ],   right and left 2r × 2k, small 2k × 2k with eigenvalues λ.
   *
   * A and C are given in modal coordinates, too. Every mode of the reference is a pair of coordinates (x, λ x / ω) here, in which its
   * block is ω J, J = [0 1; -1 0]. Steps divide what commutes with J by ω_i − ω_j and what anticommutes by ω_i + ω_j. The proof looks at
   * −T² in the place of T.
   */
  std::optional<BandSubspaces> damped_band_subspaces(const DenseMatrix         &A,
                                                     const DenseMatrix         &C,
                                                     const std::vector<double> &squares,
                                                     double                     largest_circular_frequency);
} // namespace Squeal
