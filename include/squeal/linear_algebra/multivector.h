#pragma once

#include <squeal/linear_algebra/dense_eigenproblems.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_Map.h>
#include <Epetra_MultiVector.h>

#include <memory>
#include <optional>
#include <vector>

namespace Squeal
{
  /// Vectors in bulk: n × k, distributed by rows.
  using MultiVector = Epetra_MultiVector;
  /// Sparse matrices: distributed by rows.
  using SparseMatrix = Epetra_CrsMatrix;

  /// XᵀY, k_X × k_Y, the same on every process.
  DenseMatrix gram(const MultiVector &X, const MultiVector &Y);

  /**
   * The small dense result of process 0, on all. Rounding of the same
   * LAPACK call may differ between processes, with the alignment of memory for
   * instance; eigenvectors of a multiple eigenvalue then differ altogether.
   */
  RealPairs agreed(const Epetra_Comm &comm, RealPairs pairs);

  /// Y = alpha X S + beta Y; X and Y must not share memory.
  void multiply_add(double alpha, const MultiVector &X, const DenseMatrix &S, double beta, MultiVector &Y);

  /// X S.
  MultiVector operator*(const MultiVector &X, const DenseMatrix &S);

  /// A X for a sparse matrix.
  MultiVector operator*(const SparseMatrix &A, const MultiVector &X);

  /// Aᵀ X for a sparse matrix.
  MultiVector transpose_times(const SparseMatrix &A, const MultiVector &X);

  /// Columns [first, first + n) of X, n ≥ 1, as a view; X must outlive it. (A copy of a view is a deep copy.)
  MultiVector view(const MultiVector &X, int first, int n);

  /// [X Y ...]: the columns of all, copied.
  MultiVector join(const std::vector<const MultiVector *> &parts);

  /// Euclidean norms of the columns.
  std::vector<double> column_norms(const MultiVector &X);

  /// The identity matrix as vectors, for maps of a few rows (contact nodes).
  MultiVector unit_vectors(const Epetra_Map &map);

  /// Deterministic pseudo-random entries in [-1, 1], the same vectors however the rows are distributed.
  MultiVector random_vectors(const Epetra_Map &map, int n_vectors, unsigned int seed = 1);

  /// How far the columns of a set of vectors are from dependent.
  struct PrincipalAxes
  {
    std::vector<double> norms;          ///< M-norms of the kept axes (singular values of the columns), largest first
    double              condition = 1.; ///< of the Gram matrix of all columns, scaled or not; infinite where rounding makes it indefinite
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
   * dropped. The axes are computed in passes of five orders of magnitude each,
   * since a Gram matrix squares the condition; tolerances down to 1e-13 make
   * sense.
   *
   * Returns the kept directions, or nothing if none is left (an Epetra
   * multivector has at least one column). @p axes, if given, receives what was
   * found about the columns.
   */
  std::optional<MultiVector> orthonormalize_if_any(const SparseMatrix &M,
                                                   const MultiVector  *Q,
                                                   const MultiVector  &X,
                                                   double              tolerance,
                                                   PrincipalAxes      *axes = nullptr);

  /// The same where at least one direction must be left; throws SolverError otherwise.
  MultiVector orthonormalize(const SparseMatrix &M,
                             const MultiVector  *Q,
                             const MultiVector  &X,
                             double              tolerance,
                             PrincipalAxes      *axes = nullptr);

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
