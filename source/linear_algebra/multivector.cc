// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/tasks.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/row_map.h>

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace Squeal
{
  namespace
  {
    void require(const bool condition, const char *operation)
    {
      if (!condition)
        throw SolverError("the shapes of two sets of vectors or coefficients do not match", operation,
                          "this is an error in the program: please report it");
    }

    void require_same_shape(const MultiVector &X, const MultiVector &Y, const char *operation)
    {
      require(X.n_local_rows() == Y.n_local_rows() && X.n_columns() == Y.n_columns(), operation);
    }

    /// Number of rows in a task; constant, so that rounding errors of sums do not depend on the number of threads.
    constexpr int rows_together = 8192;

    /// Number of columns that are copied together.
    constexpr int columns_of_copy = 8;

    /// Y = X with several threads for large blocks, because the first write to new memory is slow.
    void copy(const Eigen::Ref<const DenseMatrix> &X, Eigen::Ref<DenseMatrix> Y)
    {
      run_parts(static_cast<int>(X.cols()), columns_of_copy,
                [&](const int first, const int n) { Y.middleCols(first, n) = X.middleCols(first, n); });
    }

    /// Mixes 64 bits (the finaliser of SplitMix64).
    std::uint64_t mix(std::uint64_t z)
    {
      z += 0x9e3779b97f4a7c15ull;
      z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
      z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
      return z ^ (z >> 31);
    }
  } // namespace

  MultiVector::MultiVector(const RowMap &map, const int n_columns, const bool zero)
    : row_map(map)
    , n_rows(map.n_local())
    , k(n_columns)
    , own(n_rows, k)
    , values(own.data())
  {
    if (zero)
      own.setZero();
  }

  MultiVector::MultiVector(const RowMap &map, double *values, const int n_columns)
    : row_map(map)
    , n_rows(map.n_local())
    , k(n_columns)
    , values(values)
  {}

  MultiVector::MultiVector(const MultiVector &X)
    : row_map(X.row_map)
    , n_rows(X.n_rows)
    , k(X.k)
    , own(n_rows, k)
    , values(own.data())
  {
    copy(X.local(), own);
  }

  MultiVector::MultiVector(MultiVector &&X)
    : row_map(X.row_map)
    , n_rows(X.n_rows)
    , k(X.k)
  {
    if (X.is_view())
      own = X.local();
    else
      own.swap(X.own);
    values = own.data();
  }

  MultiVector &MultiVector::operator=(const MultiVector &X)
  {
    if (is_view())
      {
        require_same_shape(*this, X, "assignment to columns of a set of vectors");
        copy(X.local(), local());
        return *this;
      }
    return *this = MultiVector(X);
  }

  MultiVector &MultiVector::operator=(MultiVector &&X)
  {
    if (is_view() || X.is_view())
      return *this = static_cast<const MultiVector &>(X);
    row_map = X.row_map;
    n_rows  = X.n_rows;
    k       = X.k;
    own.swap(X.own);
    values   = own.data();
    X.values = X.own.data();
    return *this;
  }

  MultiVector &MultiVector::operator+=(const MultiVector &X)
  {
    require_same_shape(*this, X, "sum of vectors");
    local() += X.local();
    return *this;
  }

  MultiVector &MultiVector::operator-=(const MultiVector &X)
  {
    require_same_shape(*this, X, "difference of vectors");
    local() -= X.local();
    return *this;
  }

  MultiVector &MultiVector::operator*=(const double factor)
  {
    local() *= factor;
    return *this;
  }

  void MultiVector::append(const MultiVector &X)
  {
    require(!is_view() && X.n_local_rows() == n_rows, "appended columns");
    own.conservativeResize(Eigen::NoChange, k + X.k);
    copy(X.local(), own.rightCols(X.k));
    k += X.k;
    values = own.data();
  }

  MultiVector operator*(const double factor, MultiVector X)
  {
    X *= factor;
    return X;
  }

  MultiVector operator+(MultiVector X, const MultiVector &Y)
  {
    X += Y;
    return X;
  }

  MultiVector operator-(MultiVector X, const MultiVector &Y)
  {
    X -= Y;
    return X;
  }

  MultiVector operator*(const MultiVector &X, const DenseMatrix &S)
  {
    MultiVector Y(X.map(), S.cols(), false);
    multiply_add(1., X, S, 0., Y);
    return Y;
  }

  void multiply_add(const double alpha, const MultiVector &X, const DenseMatrix &S, const double beta, MultiVector &Y)
  {
    require(X.n_local_rows() == Y.n_local_rows() && X.n_columns() == S.rows() && Y.n_columns() == S.cols(),
            "linear combination of vectors");
    if (Y.n_local_rows() == 0)
      return;
    const auto x = X.local();
    auto       y = Y.local();
    run_parts(Y.n_local_rows(), rows_together, [&](const int first, const int n) {
      auto image = y.middleRows(first, n);
      if (beta == 0.)
        image.noalias() = alpha * x.middleRows(first, n) * S;
      else
        {
          if (beta != 1.)
            image *= beta;
          image.noalias() += alpha * x.middleRows(first, n) * S;
        }
    });
  }

  DenseMatrix gram(const MultiVector &X, const MultiVector &Y)
  {
    require(X.n_local_rows() == Y.n_local_rows(), "inner products");
    const auto               x = X.local(), y = Y.local();
    std::vector<DenseMatrix> sums(std::max(1, (X.n_local_rows() + rows_together - 1) / rows_together));
    run_parts(X.n_local_rows(), rows_together, [&](const int first, const int n) {
      sums[first / rows_together] = x.middleRows(first, n).transpose() * y.middleRows(first, n);
    });
    if (X.n_local_rows() == 0)
      sums.front().setZero(X.n_columns(), Y.n_columns());
    for (std::size_t part = 1; part < sums.size(); ++part)
      sums.front() += sums[part];
    sum_over_processes(X.communicator(), sums.front().data(), sums.front().size());
    agree(X.communicator(), sums.front());
    return sums.front();
  }

  RealPairs agreed(const MPI_Comm communicator, RealPairs pairs)
  {
    agree(communicator, pairs.vectors);
    agree(communicator, pairs.values.data(), pairs.values.size());
    return pairs;
  }

  MultiVector view(const MultiVector &X, const int first, const int n)
  {
    require(first >= 0 && n >= 0 && first + n <= X.n_columns(), "columns of a set of vectors");
    return MultiVector(X.row_map, X.values + static_cast<std::size_t>(first) * X.n_rows, n);
  }

  MultiVector join(const std::vector<const MultiVector *> &parts)
  {
    int n_columns = 0;
    for (const MultiVector *part : parts)
      n_columns += part->n_columns();
    require(n_columns > 0, "union of sets of vectors");

    MultiVector all(parts.front()->map(), n_columns, false);
    int         column = 0;
    for (const MultiVector *part : parts)
      {
        require(part->n_local_rows() == all.n_local_rows(), "union of sets of vectors");
        copy(part->local(), all.local().middleCols(column, part->n_columns()));
        column += part->n_columns();
      }
    return all;
  }

  MultiVector join_all(const std::vector<MultiVector> &parts)
  {
    std::vector<const MultiVector *> pointers;
    for (const MultiVector &part : parts)
      pointers.push_back(&part);
    return join(pointers);
  }

  std::vector<double> column_products(const MultiVector &X, const MultiVector &Y)
  {
    require_same_shape(X, Y, "inner products");
    std::vector<double> result(X.n_columns());
    run_tasks(X.n_columns(), [&](const int j) { result[j] = X.col(j).dot(Y.col(j)); });
    sum_over_processes(X.communicator(), result.data(), result.size());
    return result;
  }

  std::vector<double> column_norms(const MultiVector &X)
  {
    std::vector<double> norms = column_products(X, X);
    for (double &norm : norms)
      norm = std::sqrt(norm);
    return norms;
  }

  std::vector<int> nonzero_columns(const MultiVector &X)
  {
    const std::vector<double> norms = column_norms(X);
    std::vector<int>          result;
    for (int j = 0; j < X.n_columns(); ++j)
      if (norms[j] != 0.) // true for NaN
        result.push_back(j);
    return result;
  }

  MultiVector selected(const MultiVector &X, const std::vector<int> &columns)
  {
    MultiVector result(X.map(), static_cast<int>(columns.size()), false);
    result.local() = X.local()(Eigen::placeholders::all, columns);
    return result;
  }

  MultiVector unit_vectors(const RowMap &map)
  {
    MultiVector result(map, map.n());
    for (int i = 0; i < map.n_local(); ++i)
      result(i, map.number(i)) = 1.;
    return result;
  }

  MultiVector random_vectors(const RowMap &map, const int n_vectors, const unsigned int seed)
  {
    MultiVector X(map, n_vectors, false);
    for (int j = 0; j < n_vectors; ++j)
      {
        const std::uint64_t stream = mix(mix(seed) + static_cast<std::uint64_t>(j));
        for (int i = 0; i < X.n_local_rows(); ++i)
          {
            const std::uint64_t bits = mix(stream ^ mix(static_cast<std::uint64_t>(map.number(i))));
            // The upper 53 bits are converted to a double in [0, 1)
            X(i, j) = 2. * static_cast<double>(bits >> 11) / 9007199254740992. - 1.;
          }
      }
    return X;
  }

  namespace
  {
    /// Delivery between process 0, which has all rows, and their owners.
    RowDelivery from_root(const RowMap &map)
    {
      std::vector<int> numbers(map.rank() == 0 ? map.n() : 0);
      std::iota(numbers.begin(), numbers.end(), 0);
      return {numbers, map};
    }
  } // namespace

  DenseMatrix replicate(const MultiVector &X)
  {
    DenseMatrix result                                   = DenseMatrix::Zero(X.map().n(), X.n_columns());
    result.middleRows(X.map().first(), X.n_local_rows()) = X.local();
    sum_over_processes(X.communicator(), result.data(), result.size());
    return result;
  }

  MultiVector distribute(const DenseMatrix &X, const RowMap &map)
  {
    MultiVector result(map, X.cols(), false);
    result.local() = X.middleRows(map.first(), map.n_local());
    return result;
  }

  DenseMatrix gather(const MultiVector &X)
  {
    if (is_alone(X.communicator())) // avoids MPI, so that any thread may call gather() in a serial run
      return X.local();
    DenseMatrix whole(X.map().rank() == 0 ? X.map().n() : 0, X.n_columns());
    from_root(X.map()).fetch(X.local(), whole);
    return whole;
  }

  MultiVector scatter(const DenseMatrix &X, const RowMap &map)
  {
    if (is_alone(map.communicator()))
      return distribute(X, map);
    int n_columns = X.cols();
    agree(map.communicator(), &n_columns, 1);
    MultiVector result(map, n_columns, false);
    from_root(map).deliver(map.rank() == 0 ? X : DenseMatrix(0, n_columns), result.local());
    return result;
  }
} // namespace Squeal
