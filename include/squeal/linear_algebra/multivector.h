// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense_eigenproblems.h>
#include <squeal/linear_algebra/row_map.h>

#include <optional>
#include <vector>

namespace Squeal
{
  /// A block of k vectors, n × k, distributed by rows and stored by columns. A view refers to columns of another block. A copy of a view
  /// owns its columns; an assignment to a view changes the original block.
  class MultiVector
  {
  public:
    using Local      = Eigen::Map<DenseMatrix>;
    using ConstLocal = Eigen::Map<const DenseMatrix>;

    /// @param zero true: initialise the entries with zeros; false: leave them uninitialised
    MultiVector(const RowMap &map, int n_columns, bool zero = true);

    /// A view of external data, n_local × k.
    MultiVector(const RowMap &map, double *values, int n_columns);

    MultiVector(const MultiVector &X);
    MultiVector(MultiVector &&X);

    /// Copies X; throws SolverError if this is a view and the shape of X differs.
    MultiVector &operator=(const MultiVector &X);
    MultiVector &operator=(MultiVector &&X);

    int n_columns() const
    {
      return k;
    }

    int n_local_rows() const
    {
      return n_rows;
    }

    const RowMap &map() const
    {
      return row_map;
    }

    MPI_Comm communicator() const
    {
      return row_map.communicator();
    }

    /// Rows of this process, n_local × k.
    Local local()
    {
      return {values, n_rows, k};
    }

    ConstLocal local() const
    {
      return {values, n_rows, k};
    }

    /// Column @p j of the rows of this process.
    Eigen::Map<Eigen::VectorXd> col(const int j)
    {
      return {values + static_cast<std::size_t>(j) * n_rows, n_rows};
    }

    Eigen::Map<const Eigen::VectorXd> col(const int j) const
    {
      return {values + static_cast<std::size_t>(j) * n_rows, n_rows};
    }

    /// Entry in the local row @p i of this process.
    double &operator()(const int i, const int j)
    {
      return values[i + static_cast<std::size_t>(j) * n_rows];
    }

    double operator()(const int i, const int j) const
    {
      return values[i + static_cast<std::size_t>(j) * n_rows];
    }

    MultiVector &operator+=(const MultiVector &X);
    MultiVector &operator-=(const MultiVector &X);
    MultiVector &operator*=(double factor);

    /// Appends the columns of X; large blocks normally grow without copying. Views of this block become invalid.
    void append(const MultiVector &X);

    /// View of columns [first, first + n), n ≥ 0; X must outlive the view.
    friend MultiVector view(const MultiVector &X, int first, int n);

  private:
    bool is_view() const
    {
      return values != own.data();
    }

    RowMap      row_map;
    int         n_rows, k;
    DenseMatrix own; ///< entries owned by this block; empty for a view
    double     *values;
  };

  /// XᵀY, k_X × k_Y, identical on every process.
  DenseMatrix gram(const MultiVector &X, const MultiVector &Y);

  /// Broadcasts the result of process 0. The same LAPACK call may round differently on different processes, for example because of the
  /// alignment of memory; eigenvectors of a multiple eigenvalue may then be completely different.
  RealPairs agreed(MPI_Comm communicator, RealPairs pairs);

  /// Y = alpha X S + beta Y; X and Y must not share memory.
  void multiply_add(double alpha, const MultiVector &X, const DenseMatrix &S, double beta, MultiVector &Y);

  /// X S.
  MultiVector operator*(const MultiVector &X, const DenseMatrix &S);

  /// factor X, X + Y and X − Y.
  MultiVector operator*(double factor, MultiVector X);
  MultiVector operator+(MultiVector X, const MultiVector &Y);
  MultiVector operator-(MultiVector X, const MultiVector &Y);

  MultiVector view(const MultiVector &X, int first, int n);
  MultiVector view(const MultiVector &&, int, int) = delete; ///< a view of a temporary would dangle

  /// [X Y ...]: copies of the columns of all parts.
  MultiVector join(const std::vector<const MultiVector *> &parts);
  MultiVector join_all(const std::vector<MultiVector> &parts);

  /// x_jᵀ y_j of each pair of columns.
  std::vector<double> column_products(const MultiVector &X, const MultiVector &Y);

  std::vector<double> column_norms(const MultiVector &X);

  std::vector<int> nonzero_columns(const MultiVector &X);

  /// Copy of selected columns.
  MultiVector selected(const MultiVector &X, const std::vector<int> &columns);

  /// Identity matrix as vectors, for maps with few rows (contact nodes).
  MultiVector unit_vectors(const RowMap &map);

  /// Deterministic pseudo-random entries in [-1, 1], independent of the distribution of the rows.
  MultiVector random_vectors(const RowMap &map, int n_vectors, unsigned int seed = 1);

  /// A linear operator on distributed vectors, Y = A X, applied to blocks of vectors.
  class LinearOperator
  {
  public:
    virtual ~LinearOperator() = default;

    /// Y = A X; X and Y have the same map and number of columns and do not alias.
    virtual void apply(const MultiVector &X, MultiVector &Y) const = 0;

    /// Distribution of the rows of Y, and of X if A is square.
    virtual const RowMap &map() const = 0;
  };

  /// All rows of a short distributed X (contact nodes, not dofs) on every process.
  DenseMatrix replicate(const MultiVector &X);

  /// Distributes a replicated matrix: each process keeps the rows that it owns in @p map.
  MultiVector distribute(const DenseMatrix &X, const RowMap &map);

  /// All rows of X on process 0, by row number; no rows on the other processes.
  DenseMatrix gather(const MultiVector &X);

  /// Distributes the rows of a matrix on process 0; @p X is ignored on the other processes.
  MultiVector scatter(const DenseMatrix &X, const RowMap &map);
} // namespace Squeal
