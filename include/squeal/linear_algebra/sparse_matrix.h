// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/multivector.h>

#include <Eigen/SparseCore>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace Squeal
{
  /// Rows of a sparse matrix on one process, with ascending columns.
  using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// A sparse matrix, distributed by rows, immutable.
  class SparseMatrix : public LinearOperator
  {
  public:
    /// Entries of one row: number of the column, value.
    using Row = std::vector<std::pair<int, double>>;

    /**
     * @param rows    distribution of the rows, and of A X
     * @param columns distribution of X
     * @param fill    appends the entries of a local row to an empty row; duplicate entries are added
     */
    SparseMatrix(const RowMap &rows, const RowMap &columns, const std::function<void(int place, Row &row)> &fill);

    /// From the rows of this process, with global column numbers. Collective.
    SparseMatrix(const RowMap &rows, const RowMap &columns, SparseRows by_number);

    /// Columns that occur in the local rows but belong to other processes.
    struct Halo;

    /// For linear_algebra/ only: local rows, local column indices; halo columns follow the own ones.
    const SparseRows &by_place() const
    {
      return local;
    }

    /// For linear_algebra/ only: null if one process has the whole matrix.
    const Halo *halo() const
    {
      return columns_elsewhere.get();
    }

    ~SparseMatrix() override;
    SparseMatrix(const SparseMatrix &)            = delete;
    SparseMatrix &operator=(const SparseMatrix &) = delete;

    const RowMap &rows() const
    {
      return row_map;
    }

    const RowMap &columns() const
    {
      return column_map;
    }

    /// Global number of rows.
    int n_rows() const
    {
      return row_map.n();
    }

    int n_columns() const
    {
      return column_map.n();
    }

    /// Global number of entries.
    long long n_entries() const;

    MPI_Comm communicator() const
    {
      return row_map.communicator();
    }

    /// Replaces @p row by the entries of a local row, in no particular order.
    void get_row(int place, Row &row) const;

    void apply(const MultiVector &X, MultiVector &Y) const override
    {
      multiply(false, X, Y);
    }

    /// Y = Aᵀ X.
    void apply_transpose(const MultiVector &X, MultiVector &Y) const
    {
      multiply(true, X, Y);
    }

    const RowMap &map() const override
    {
      return row_map;
    }

  private:
    void multiply(bool transposed, const MultiVector &X, MultiVector &Y) const;

    std::unique_ptr<const Halo> columns_elsewhere;
    SparseRows                  local;
    RowMap                      row_map, column_map;
  };

  /// A X.
  MultiVector operator*(const SparseMatrix &A, const MultiVector &X);

  /// Aᵀ X.
  MultiVector transpose_times(const SparseMatrix &A, const MultiVector &X);

  /// op(A) op(B), op = transpose if requested; rows are distributed like those of op(A).
  std::shared_ptr<SparseMatrix> multiply(const SparseMatrix &A, const SparseMatrix &B, bool transpose_A = false, bool transpose_B = false);

  /// Aᵀ.
  std::shared_ptr<SparseMatrix> transpose(const SparseMatrix &A);

  /// Tᵀ A T, n_T × n_T, distributed like the columns of T.
  std::shared_ptr<SparseMatrix> congruence(const SparseMatrix &A, const SparseMatrix &T);

  /// |A|, entry by entry.
  std::shared_ptr<SparseMatrix> moduli(const SparseMatrix &A);

  /// diag(f(0), f(1), ...) A, with f of the global row number.
  std::shared_ptr<SparseMatrix> scale_rows(const SparseMatrix &A, const std::function<double(int number)> &f);

  /// alpha A + beta B for matrices of the same shape and distribution; the patterns may differ.
  std::shared_ptr<SparseMatrix> add(double alpha, const SparseMatrix &A, double beta, const SparseMatrix &B);

  /// Σ factor A of at least one matrix, all of the same shape and distribution.
  std::shared_ptr<SparseMatrix> linear_combination(const std::vector<std::pair<double, const SparseMatrix *>> &summands);

  /// Largest absolute entry.
  double max_norm(const SparseMatrix &A);

  /// Largest sum of absolute entries of a row.
  double row_sum_norm(const SparseMatrix &A);

  /// A copy as a dense matrix, the same on every process: for small matrices only.
  DenseMatrix to_dense(const SparseMatrix &A);

  /// Rows of this process with global column numbers.
  SparseRows local_rows(const SparseMatrix &A);

  /// Xᵀ A Y, with A applied to a few columns of Y at a time: all of A Y would take as much memory as Y.
  DenseMatrix weighted_gram(const MultiVector &X, const SparseMatrix &A, const MultiVector &Y);

  /// Xᵀ A X for a symmetric A; only one half is computed.
  DenseMatrix weighted_gram(const MultiVector &X, const SparseMatrix &A);

  /// Calls f(first, n) for blocks of columns narrow enough to copy.
  template <typename Function>
  void for_column_blocks(const int n_columns, const Function &f)
  {
    constexpr int width = 32;
    for (int first = 0; first < n_columns; first += width)
      f(first, std::min(width, n_columns - first));
  }

  /// X ← X S for a square S.
  void multiply_in_place(MultiVector &X, const DenseMatrix &S);

  /**
   * ω² [rad²/s²] below which rounding errors of K hide the frequency of a motion of K φ = ω² M φ, independent of the band,
   *
   *   100 ε ρ,   ρ: geometric mean over the rows, weighted by mass, of Σ_j |K_ij| / Σ_j |M_ij|.
   *
   * φᵀKφ of a nearly rigid motion is a sum of cancelling terms of size ρ φᵀMφ, with an error of at most about ε ρ φᵀMφ. The mean is that of
   * the heavy bodies: light stiff ones do not determine such a motion. Collective.
   */
  double unresolved_square(const SparseMatrix &K, const SparseMatrix &M);
} // namespace Squeal
