// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense_eigenproblems.h>

#include <optional>

namespace Squeal
{
  /// Subspaces of a dense n × n matrix A for the modes of a band: A R = R S, Lᵀ A = S Lᵀ, Lᵀ R = I.
  struct BandSubspaces
  {
    DenseMatrix right; ///< R, n × k
    DenseMatrix left;  ///< L, n × k
    DenseMatrix small; ///< S, k × k; its eigenvalues are −λ² or λ of these modes
  };

  /**
   * Invariant subspaces of A φ = −λ² φ for all λ with |Im λ| ≤ @p largest_circular_frequency [rad/s].
   *
   * A is given in modal coordinates of a nearby symmetric pencil with −λ² = @p squares, ascending. If the modes up to the widest gap above
   * the band come first, A has blocks B_ij, and
   *
   *   R = [I; X],           B_21 + B_22 X − X (B_11 + B_12 X) = 0,
   *   Lᵀ = [I − Y X, Y],    S_1 Y − Y T − B_12 = 0,   S_1 = B_11 + B_12 X,  T = B_22 − X B_12.
   *
   * Both equations are solved by fixed-point iteration with the diagonal operator of the symmetric pencil (Stewart 1973, Demmel 1987), a
   * few block products per step, accelerated by Anderson's method; S = LᵀAR, so that its error is the product of the errors of X and Y. One
   * of two tests proves that T has no eigenvalue in the band, real λ included: Lyapunov's theorem with P = diag(T), or powers of a Cayley
   * transform,
   *
   *   P (T − ω² I) + (T − ω² I)ᵀ P positive definite, or
   * Z = (T − ω² I − a I) (T − ω² I + a I)⁻¹: ‖Z^m‖ < 1 for any m => Re(−λ²) > ω² for all eigenvalues −λ² of T.
   *
   * @return empty if there is no sufficiently wide gap above the band within the lowest 60 % of the modes, if the iteration does not
   * converge, or if neither test succeeds
   */
  std::optional<BandSubspaces> band_subspaces(const DenseMatrix &A, const std::vector<double> &squares, double largest_circular_frequency);

  /**
   * Invariant subspaces of a system with damping,
   *
   *   [ 0   I ]
   *   [ -A -C ]  [φ; λ φ] = λ [φ; λ φ],   right and left 2r × 2k, small 2k × 2k with eigenvalues λ.
   *
   * A and C are given in modal coordinates. Each mode of the symmetric pencil has a pair of coordinates (x, λ x / ω), in which its block is
   * ω J, J = [0 1; -1 0]. Fixed-point steps divide the part of the residual that commutes with J by ω_i − ω_j and the anticommuting part by
   * ω_i + ω_j. The tests use −T² instead of T.
   */
  std::optional<BandSubspaces> damped_band_subspaces(const DenseMatrix         &A,
                                                     const DenseMatrix         &C,
                                                     const std::vector<double> &squares,
                                                     double                     largest_circular_frequency);
} // namespace Squeal
