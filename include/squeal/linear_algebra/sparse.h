#pragma once

#include <squeal/linear_algebra/multivector.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace Squeal
{
  /// op(A) op(B), op = transpose where asked; rows distributed like those of op(A).
  std::shared_ptr<SparseMatrix> multiply(const SparseMatrix &A, const SparseMatrix &B, bool transpose_A = false, bool transpose_B = false);

  /// Tᵀ A T, n_T × n_T, distributed like the columns of T.
  std::shared_ptr<SparseMatrix> congruence(const SparseMatrix &A, const SparseMatrix &T);

  /// alpha A + beta B for matrices of the same shape and distribution; the patterns may differ.
  std::shared_ptr<SparseMatrix> add(double alpha, const SparseMatrix &A, double beta, const SparseMatrix &B);

  /// Σ factor A of one matrix at least, all of the same shape and distribution.
  std::shared_ptr<SparseMatrix> linear_combination(const std::vector<std::pair<double, const SparseMatrix *>> &summands);

  /// Largest absolute entry.
  double max_norm(const SparseMatrix &A);

  /// max |A - Aᵀ| / max |A| of a square matrix; 0 for a zero matrix.
  double symmetry_defect(const SparseMatrix &A);

  /// A copy as a dense matrix, the same on every process: for small matrices only.
  DenseMatrix to_dense(const SparseMatrix &A);

  /// What the header of a Matrix Market file promises about its entries.
  enum class MatrixMarketSymmetry
  {
    general,  ///< all entries are listed
    symmetric ///< the lower triangle is listed
  };

  /**
   * A in Matrix Market coordinate form with 17 significant digits, so that reading returns the same numbers: the whole text on
   * process 0, nothing on the others. All processes must call.
   */
  std::string matrix_market(const SparseMatrix &A, MatrixMarketSymmetry symmetry = MatrixMarketSymmetry::general);

  /**
   * The local rows of a matrix with rows and columns numbered without gaps over
   * all processes: those of process 0 first, then those of process 1, and so
   * on, in the order of the local entries of vectors. Columns ascend in a row.
   */
  struct LocalRows
  {
    explicit LocalRows(const SparseMatrix &A);

    int                 first_row; ///< number of the first local row
    int                 n_rows;    ///< of all processes
    int                 n_columns; ///< of all processes
    std::vector<int>    start;     ///< start[i], ..., start[i+1]: entries of local row i
    std::vector<int>    column;
    std::vector<double> value;
  };
} // namespace Squeal
