// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/sparse_matrix.h>

#include <optional>
#include <vector>

namespace Squeal
{
  /// How far the columns of a set of vectors are from dependent.
  struct PrincipalAxes
  {
    std::vector<double> norms;          ///< M-norms of the kept axes (singular values of the columns), largest first
    double              condition = 1.; ///< of the Gram matrix of all columns, scaled or not; infinite where rounding makes it indefinite
  };

  /// Whether vectors still have parts in the span of those against which they are orthonormalised.
  enum class FirstProjection
  {
    wanted,
    done ///< beforehand, in two passes
  };

  /**
   * Orthonormalises the columns of @p X in the inner product of the symmetric
   * positive definite @p M against the M-orthonormal columns of @p Q (may be
   * null) and among each other, to about 1e-14.
   *
   * The columns are first scaled to unit M-norm. What remains of them outside
   * of Q is resolved into orthogonal directions (the principal axes of the
   * scaled columns, largest first); those whose M-norm is below @p tolerance
   * times the largest M-norm of a direction in X before the projection are
   * dropped. @p projection says whether X is orthogonal to Q already. The axes are computed in passes of five orders of magnitude each,
   * since a Gram matrix squares the condition; tolerances down to 1e-13 make
   * sense.
   *
   * X handed over by std::move() becomes the result; beside it no copy is made unless axes wait for another pass.
   *
   * Returns the kept directions, or nothing if none is left. @p axes, if given, receives what was
   * found about the columns.
   */
  std::optional<MultiVector> orthonormalize_if_any(const SparseMatrix &M,
                                                   const MultiVector  *Q,
                                                   MultiVector         X,
                                                   double              tolerance,
                                                   PrincipalAxes      *axes       = nullptr,
                                                   FirstProjection     projection = FirstProjection::wanted);

  /// The same where at least one direction must be left; throws SolverError otherwise.
  MultiVector orthonormalize(const SparseMatrix &M, const MultiVector *Q, MultiVector X, double tolerance, PrincipalAxes *axes = nullptr);

  /**
   * Proper orthogonal decomposition: the M-orthonormal principal axes of the
   * columns of X as they are, without scaling, largest first. Kept are those
   * whose M-norm exceeds @p tolerance times the largest, @p maximum at most.
   * Computed in passes as above. Throws SolverError if all columns are zero.
   */
  MultiVector principal_axes(const SparseMatrix &M, const MultiVector &X, double tolerance, int maximum, PrincipalAxes *axes = nullptr);

  /// max |XᵀMX − I|.
  double orthonormality_defect(const SparseMatrix &M, const MultiVector &X);
} // namespace Squeal
