// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense_eigenproblems.h>
#include <squeal/linear_algebra/row_map.h>

#include <optional>
#include <vector>

namespace Squeal
{
  /// Vectors in bulk: n × k, distributed by rows, the columns of a process one after the other. A view refers to columns of another one; a
  /// copy of a view has columns of its own, and an assignment to a view changes what it refers to.
  class MultiVector
  {
  public:
    using Local      = Eigen::Map<DenseMatrix>;
    using ConstLocal = Eigen::Map<const DenseMatrix>;

    /// @param zero whether the entries are zero; else what they are is open
    MultiVector(const RowMap &map, int n_columns, bool zero = true);

    /// A view of numbers that belong to somebody else, n_local × k.
    MultiVector(const RowMap &map, double *values, int n_columns);

    MultiVector(const MultiVector &X);
    MultiVector(MultiVector &&X);

    /// Throws SolverError if this is a view and X has another shape.
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

    /// Entry of the row at place @p i of this process.
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

    /// Puts the columns of X behind those that are there. Large blocks grow without being copied. Views of this cease to be valid.
    void append(const MultiVector &X);

    /// Columns [first, first + n), n ≥ 0, as a view; this must outlive it.
    friend MultiVector view(const MultiVector &X, int first, int n);

  private:
    bool is_view() const
    {
      return values != own.data();
    }

    RowMap      row_map;
    int         n_rows, k;
    DenseMatrix own; ///< empty for a view
    double     *values;
  };

  /// XᵀY, k_X × k_Y, the same on every process.
  DenseMatrix gram(const MultiVector &X, const MultiVector &Y);

  /// The small dense result of process 0, on all. Rounding of the same LAPACK call may differ between processes, with the alignment of
  /// memory for instance; eigenvectors of a multiple eigenvalue then differ altogether.
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
  MultiVector view(const MultiVector &&, int, int) = delete; ///< a view of what ceases to be

  /// [X Y ...]: the columns of all, copied.
  MultiVector join(const std::vector<const MultiVector *> &parts);
  MultiVector join_all(const std::vector<MultiVector> &parts);

  /// x_jᵀ y_j of corresponding columns.
  std::vector<double> column_products(const MultiVector &X, const MultiVector &Y);

  /// Euclidean norms of the columns.
  std::vector<double> column_norms(const MultiVector &X);

  /// Numbers of the columns that are not zero.
  std::vector<int> nonzero_columns(const MultiVector &X);

  /// Some columns, copied, by their numbers.
  MultiVector selected(const MultiVector &X, const std::vector<int> &columns);

  /// The identity matrix as vectors, for maps of a few rows (contact nodes).
  MultiVector unit_vectors(const RowMap &map);

  /// Deterministic pseudo-random entries in [-1, 1], the same vectors however the rows are distributed.
  MultiVector random_vectors(const RowMap &map, int n_vectors, unsigned int seed = 1);

  /// A linear map on distributed vectors, y = A x, for many vectors at once.
  class LinearOperator
  {
  public:
    virtual ~LinearOperator() = default;

    /// Y = A X; X and Y have the same map and number of columns and do not alias.
    virtual void apply(const MultiVector &X, MultiVector &Y) const = 0;

    /// Distribution of the rows of Y, and of those of X where A is square.
    virtual const RowMap &map() const = 0;
  };

  /// All rows of a short distributed X (contact nodes, not dofs) on every process.
  DenseMatrix replicate(const MultiVector &X);

  /// The rows of a replicated matrix that @p map owns here.
  MultiVector distribute(const DenseMatrix &X, const RowMap &map);

  /// All rows of X on process 0, in the order of their numbers; no rows on the others.
  DenseMatrix gather(const MultiVector &X);

  /// The rows of a matrix on process 0 that @p map owns here; @p X does not matter on the other processes.
  MultiVector scatter(const DenseMatrix &X, const RowMap &map);
} // namespace Squeal
