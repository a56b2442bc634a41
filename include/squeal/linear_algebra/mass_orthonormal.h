// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/sparse_matrix.h>

#include <optional>
#include <vector>

namespace Squeal
{
  /// Principal axes of a set of vectors: norms and conditioning.
  struct PrincipalAxes
  {
    std::vector<double> norms;          ///< M-norms of the kept axes (singular values of the columns), largest first
    double              condition = 1.; ///< of the Gram matrix of all columns, scaled or not; infinite if rounding makes it indefinite
  };

  /// Whether vectors must still be projected against the given orthonormal vectors.
  enum class FirstProjection
  {
    wanted,
    done ///< the vectors have been projected in two passes
  };

  /**
   * Orthonormalises the columns of @p X in the inner product of the symmetric positive definite @p M, against the M-orthonormal columns of
   * @p Q (may be null) and among each other, to about 1e-14.
   *
   * The columns are first scaled to unit M-norm and projected to the complement of Q, unless @p projection says that this is done. The
   * result is resolved into principal axes, largest first; those whose M-norm is below @p tolerance times the largest M-norm of a direction
   * in X before the projection are dropped. The axes are computed in passes of five orders of magnitude each, because a Gram matrix squares
   * the condition number; the smallest useful tolerance is 1e-13.
   *
   * With std::move() X is overwritten by the result; it is copied only if some axes need another pass.
   *
   * Returns the kept directions, or nothing if none is left. @p axes, if not null, receives norms and condition number.
   */
  std::optional<MultiVector> orthonormalize_if_any(const SparseMatrix &M,
                                                   const MultiVector  *Q,
                                                   MultiVector         X,
                                                   double              tolerance,
                                                   PrincipalAxes      *axes       = nullptr,
                                                   FirstProjection     projection = FirstProjection::wanted);

  /// orthonormalize_if_any() that throws SolverError if no direction is left.
  MultiVector orthonormalize(const SparseMatrix &M, const MultiVector *Q, MultiVector X, double tolerance, PrincipalAxes *axes = nullptr);

  /**
   * Proper orthogonal decomposition: M-orthonormal principal axes of the unscaled columns of X, largest first. Axes with an M-norm above @p
   * tolerance times the largest are kept, at most @p maximum. Computed in passes as above. Throws SolverError if all columns are zero.
   */
  MultiVector principal_axes(const SparseMatrix &M, const MultiVector &X, double tolerance, int maximum, PrincipalAxes *axes = nullptr);

  /// max |XᵀMX − I|.
  double orthonormality_defect(const SparseMatrix &M, const MultiVector &X);
} // namespace Squeal
