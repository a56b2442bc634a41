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

  /// An immutable sparse matrix, distributed by rows.
  class SparseMatrix : public LinearOperator
  {
  public:
    /// Entries of a row: column number and value.
    using Row = std::vector<std::pair<int, double>>;

    /**
     * @param rows    distribution of the rows, and of A X
     * @param columns distribution of X
     * @param fill    appends the entries of a local row to an empty row; duplicate entries are added
     */
    SparseMatrix(const RowMap &rows, const RowMap &columns, const std::function<void(int place, Row &row)> &fill);

    /// Constructs a matrix from the rows of this process, with global column numbers. Collective.
    SparseMatrix(const RowMap &rows, const RowMap &columns, SparseRows by_number);

    /// Columns that occur in the local rows but belong to other processes.
    struct Halo;

    /// Local rows with local column indices; halo columns follow the columns of this process. For use in linear_algebra/ only.
    const SparseRows &by_place() const
    {
      return local;
    }

    /// The halo; null if one process has the whole matrix. For use in linear_algebra/ only.
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

  /// op(A) op(B), where op is the transpose if requested; distributed like the rows of op(A).
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

  /// Σ factor A for one or more matrices of the same shape and distribution.
  std::shared_ptr<SparseMatrix> linear_combination(const std::vector<std::pair<double, const SparseMatrix *>> &summands);

  /// Largest absolute entry.
  double max_norm(const SparseMatrix &A);

  /// Largest sum of absolute entries of a row.
  double row_sum_norm(const SparseMatrix &A);

  /// Dense copy, identical on every process; for small matrices only.
  DenseMatrix to_dense(const SparseMatrix &A);

  /// Rows of this process with global column numbers.
  SparseRows local_rows(const SparseMatrix &A);

  /// Xᵀ A Y. A is applied to a few columns of Y at a time, because A Y would need as much memory as Y.
  DenseMatrix weighted_gram(const MultiVector &X, const SparseMatrix &A, const MultiVector &Y);

  /// Xᵀ A X for a symmetric A; only one half is computed.
  DenseMatrix weighted_gram(const MultiVector &X, const SparseMatrix &A);

  /// Calls f(first, n) for blocks of few columns, which can be copied without using much memory.
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
   * φᵀKφ of a nearly rigid motion is a sum of cancelling terms of size ρ φᵀMφ, with an error of at most about ε ρ φᵀMφ. The weights
   * emphasise heavy bodies, which determine such a motion, rather than light and stiff bodies. Collective.
   */
  double unresolved_square(const SparseMatrix &K, const SparseMatrix &M);
} // namespace Squeal
