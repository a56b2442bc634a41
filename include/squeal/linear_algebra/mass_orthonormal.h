// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/sparse_matrix.h>

#include <optional>
#include <vector>

namespace Squeal
{
  /// Norms of the principal axes of a set of vectors, and their condition number.
  struct PrincipalAxes
  {
    std::vector<double> norms;          ///< M-norms of the kept axes (singular values of the columns), largest first
    double              condition = 1.; ///< condition number of the Gram matrix of all columns; infinite if rounding makes it indefinite
  };

  /// Selects whether vectors must still be projected against given orthonormal vectors.
  enum class FirstProjection
  {
    wanted,
    done ///< the vectors have been projected in two passes
  };

  /**
   * Orthonormalises the columns of @p X in the inner product of the symmetric positive definite @p M, against the M-orthonormal columns of
   * @p Q (may be null) and among each other, to about 1e-14.
   *
   * The columns are scaled to unit M-norm and projected onto the complement of Q, unless @p projection is `done`. The result is resolved
   * into principal axes, largest first; axes whose M-norm is below @p tolerance times the largest M-norm of a direction in X before the
   * projection are dropped. The axes are computed in passes of five orders of magnitude each, because a Gram matrix squares the condition
   * number; the smallest useful tolerance is 1e-13.
   *
   * With std::move(), the result overwrites X; X is copied only if it has zero columns or requires another pass.
   *
   * Returns the kept directions; empty if none remains. @p axes, if not null, receives norms and condition number.
   */
  std::optional<MultiVector> orthonormalize_if_any(const SparseMatrix &M,
                                                   const MultiVector  *Q,
                                                   MultiVector         X,
                                                   double              tolerance,
                                                   PrincipalAxes      *axes       = nullptr,
                                                   FirstProjection     projection = FirstProjection::wanted);

  /// Calls orthonormalize_if_any(); throws SolverError if no direction remains.
  MultiVector orthonormalize(const SparseMatrix &M, const MultiVector *Q, MultiVector X, double tolerance, PrincipalAxes *axes = nullptr);

  /**
   * Proper orthogonal decomposition: M-orthonormal principal axes of the unscaled columns of X, largest first. Axes with an M-norm above @p
   * tolerance times the largest are kept, at most @p maximum. They are computed in passes as in orthonormalize_if_any(). Throws SolverError
   * if all columns are zero.
   */
  MultiVector principal_axes(const SparseMatrix &M, const MultiVector &X, double tolerance, int maximum, PrincipalAxes *axes = nullptr);

  /// max |XᵀMX − I|.
  double orthonormality_defect(const SparseMatrix &M, const MultiVector &X);
} // namespace Squeal
