// SPDX-License-Identifier: GPL-3.0-or-later

#include "sparse_products.h"
#include <squeal/base/exceptions.h>
#include <squeal/base/tasks.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/row_map.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <sstream>

namespace Squeal
{
  struct SparseMatrix::Halo
  {
    std::vector<int> numbers;   ///< global numbers of the columns, ascending
    RowDelivery      delivery;  ///< delivery between the owners of these columns and this process
    long long        n_entries; ///< number of entries on all processes

    int index(const int number) const
    {
      return static_cast<int>(std::lower_bound(numbers.begin(), numbers.end(), number) - numbers.begin());
    }
  };

  namespace
  {
    /// Rows from unordered entries; duplicate entries are added.
    SparseRows filled(const int n_rows, const int n_columns, const std::function<void(int, SparseMatrix::Row &)> &fill)
    {
      SparseRows        result(n_rows, n_columns);
      SparseMatrix::Row row;
      const auto        by_column = [](const auto &a, const auto &b) { return a.first < b.first; };
      for (int i = 0; i < n_rows; ++i)
        {
          row.clear();
          fill(i, row);
          if (!std::is_sorted(row.begin(), row.end(), by_column))
            std::stable_sort(row.begin(), row.end(), by_column);
          result.startVec(i);
          int last = -1;
          for (const auto &[column, value] : row)
            if (column == last)
              result.valuePtr()[result.data().size() - 1] += value;
            else
              result.insertBackByOuterInner(i, last = column) = value;
        }
      result.finalize();
      return result;
    }

    /// Global number of a local column, including the halo.
    int column_number(const SparseMatrix &A, const int place)
    {
      const int n_own = A.columns().n_local();
      return place < n_own ? A.columns().number(place) : A.halo()->numbers[place - n_own];
    }

    /// Calls @p f(local row, global column number, value) for the entries of this process.
    template <typename Function>
    void for_entries(const SparseMatrix &A, const Function &f)
    {
      for (int i = 0; i < A.rows().n_local(); ++i)
        for (SparseRows::InnerIterator entry(A.by_place(), i); entry; ++entry)
          f(i, column_number(A, entry.col()), entry.value());
    }

    /// An entry to be sent to another process.
    struct Entry
    {
      int    i, j;
      double x;

      // Member functions as in Eigen's triplets
      int row() const
      {
        return i;
      }
      int col() const
      {
        return j;
      }
      double value() const
      {
        return x;
      }

      template <typename Archive>
      void serialize(Archive &archive, unsigned int)
      {
        archive &i &j &x;
      }
    };

    /// Entries by destination process.
    using EntriesOfProcesses = std::map<unsigned int, std::vector<Entry>>;

    /// Sends entries to other processes and returns the entries received by this process.
    std::vector<Entry> delivered(const MPI_Comm communicator, EntriesOfProcesses sent)
    {
      std::vector<Entry> result;
      for (const auto &[process, entries] : is_alone(communicator) ? sent : dealii::Utilities::MPI::some_to_some(communicator, sent))
        result.insert(result.end(), entries.begin(), entries.end());
      return result;
    }

    SparseRows rows_of(const std::vector<Entry> &entries, const int n_rows, const int n_columns)
    {
      SparseRows result(n_rows, n_columns);
      result.setFromTriplets(entries.begin(), entries.end());
      return result;
    }

    /// Rows of B that correspond to the local columns of A, in the order of these columns.
    SparseRows rows_for(const SparseMatrix &A, const SparseMatrix &B)
    {
      std::map<unsigned int, std::vector<int>> wanted;
      for (const int number : A.halo()->numbers)
        wanted[B.rows().owner(number)].push_back(number);
      EntriesOfProcesses sent;
      for (const auto &[process, numbers] : dealii::Utilities::MPI::some_to_some(A.communicator(), wanted))
        for (const int number : numbers)
          for (SparseRows::InnerIterator entry(B.by_place(), B.rows().place(number)); entry; ++entry)
            sent[process].push_back({number, column_number(B, entry.col()), entry.value()});
      std::vector<Entry> entries = delivered(A.communicator(), std::move(sent));
      const int          n_own   = A.columns().n_local();
      for (Entry &entry : entries)
        entry.i = n_own + A.halo()->index(entry.i);
      for_entries(B, [&](const int i, const int column, const double value) { entries.push_back({i, column, value}); });
      return rows_of(entries, n_own + static_cast<int>(A.halo()->numbers.size()), B.n_columns());
    }

    [[noreturn]] void throw_misfit(const char *operation)
    {
      throw SolverError("shapes or distributions do not match", operation, "this is an error in the program: please report it");
    }
  } // namespace

  SparseMatrix::SparseMatrix(const RowMap &rows, const RowMap &columns, const std::function<void(int place, Row &row)> &fill)
    : SparseMatrix(rows, columns, filled(rows.n_local(), columns.n(), fill))
  {}

  SparseMatrix::SparseMatrix(const RowMap &rows, const RowMap &columns, SparseRows by_number)
    : row_map(rows)
    , column_map(columns)
  {
    local.swap(by_number); // swap, because a move in Eigen 3.4 copies
    local.makeCompressed();
    local.data().squeeze();
    if (is_alone(rows.communicator()))
      return;
    const int        n_own = columns.n_local();
    std::vector<int> elsewhere;
    std::copy_if(local.innerIndexPtr(), local.innerIndexPtr() + local.nonZeros(), std::back_inserter(elsewhere),
                 [&](const int number) { return columns.place(number) < 0; });
    std::sort(elsewhere.begin(), elsewhere.end());
    elsewhere.erase(std::unique(elsewhere.begin(), elsewhere.end()), elsewhere.end());
    auto halo =
      std::make_unique<Halo>(Halo{elsewhere, RowDelivery(elsewhere, columns),
                                  static_cast<long long>(dealii::Utilities::MPI::sum<std::uint64_t>(local.nonZeros(), communicator()))});
    local             = filled(rows.n_local(), n_own + static_cast<int>(elsewhere.size()), [&](const int i, Row &row) {
      for (SparseRows::InnerIterator entry(local, i); entry; ++entry)
        {
          const int place = columns.place(entry.col());
          row.emplace_back(place >= 0 ? place : n_own + halo->index(entry.col()), entry.value());
        }
    });
    columns_elsewhere = std::move(halo);
  }

  SparseMatrix::~SparseMatrix() = default;

  long long SparseMatrix::n_entries() const
  {
    return columns_elsewhere ? columns_elsewhere->n_entries : local.nonZeros();
  }

  void SparseMatrix::get_row(const int place, Row &row) const
  {
    row.clear();
    for (SparseRows::InnerIterator entry(local, place); entry; ++entry)
      row.emplace_back(column_number(*this, entry.col()), entry.value());
  }

  void SparseMatrix::multiply(const bool transposed, const MultiVector &X, MultiVector &Y) const
  {
    if (X.n_columns() != Y.n_columns() || X.n_local_rows() != (transposed ? rows() : columns()).n_local() ||
        Y.n_local_rows() != (transposed ? columns() : rows()).n_local())
      throw_misfit("product of a sparse matrix and vectors");
    const auto product = transposed ? multiply_transpose : multiply_rows;
    if (!columns_elsewhere || columns_elsewhere->delivery.empty())
      {
        product(local, X.local(), Y.local());
        return;
      }

    // Local rows of X or Aᵀ X, followed by halo rows
    const RowDelivery &delivery = columns_elsewhere->delivery;
    const int          n_own    = columns().n_local();
    DenseMatrix        here(local.cols(), X.n_columns());
    if (transposed)
      {
        product(local, X.local(), here);
        Y.local() = here.topRows(n_own);
        delivery.add(here.bottomRows(here.rows() - n_own), Y.local());
      }
    else
      {
        here.topRows(n_own) = X.local();
        delivery.fetch(X.local(), here.bottomRows(here.rows() - n_own));
        product(local, here, Y.local());
      }
  }

  MultiVector operator*(const SparseMatrix &A, const MultiVector &X)
  {
    MultiVector Y(A.rows(), X.n_columns(), false);
    A.apply(X, Y);
    return Y;
  }

  MultiVector transpose_times(const SparseMatrix &A, const MultiVector &X)
  {
    MultiVector Y(A.columns(), X.n_columns(), false);
    A.apply_transpose(X, Y);
    return Y;
  }

  std::shared_ptr<SparseMatrix> multiply(const SparseMatrix &A, const SparseMatrix &B, const bool transpose_A, const bool transpose_B)
  {
    if (transpose_A)
      return multiply(*transpose(A), B, false, transpose_B);
    if (transpose_B)
      return multiply(A, *transpose(B));
    if (!(A.columns() == B.rows()))
      throw_misfit("product of two sparse matrices");
    return std::make_shared<SparseMatrix>(A.rows(), B.columns(),
                                          A.halo() ? SparseRows(A.by_place() * rows_for(A, B)) : SparseRows(A.by_place() * B.by_place()));
  }

  std::shared_ptr<SparseMatrix> transpose(const SparseMatrix &A)
  {
    if (A.halo() == nullptr)
      return std::make_shared<SparseMatrix>(A.columns(), A.rows(), SparseRows(A.by_place().transpose()));
    EntriesOfProcesses sent;
    for_entries(A, [&](const int i, const int column, const double value) {
      const int owner = A.columns().owner(column);
      sent[owner].push_back({column, A.rows().number(i), value});
    });
    std::vector<Entry> entries = delivered(A.communicator(), std::move(sent));
    for (Entry &entry : entries)
      entry.i = A.columns().place(entry.i);
    return std::make_shared<SparseMatrix>(A.columns(), A.rows(), rows_of(entries, A.columns().n_local(), A.n_rows()));
  }

  std::shared_ptr<SparseMatrix> congruence(const SparseMatrix &A, const SparseMatrix &T)
  {
    return multiply(T, *multiply(A, T), true, false);
  }

  std::shared_ptr<SparseMatrix> moduli(const SparseMatrix &A)
  {
    SparseRows rows = local_rows(A);
    rows.coeffs()   = rows.coeffs().abs();
    return std::make_shared<SparseMatrix>(A.rows(), A.columns(), std::move(rows));
  }

  std::shared_ptr<SparseMatrix> scale_rows(const SparseMatrix &A, const std::function<double(int number)> &f)
  {
    return std::make_shared<SparseMatrix>(A.rows(), A.columns(), [&](const int i, SparseMatrix::Row &row) {
      A.get_row(i, row);
      for (auto &entry : row)
        entry.second *= f(A.rows().number(i));
    });
  }

  std::shared_ptr<SparseMatrix> add(const double alpha, const SparseMatrix &A, const double beta, const SparseMatrix &B)
  {
    return linear_combination({{alpha, &A}, {beta, &B}});
  }

  std::shared_ptr<SparseMatrix> linear_combination(const std::vector<std::pair<double, const SparseMatrix *>> &summands)
  {
    const SparseMatrix &first = *summands.front().second;
    for (const auto &[factor, A] : summands)
      if (!(A->rows() == first.rows()) || !(A->columns() == first.columns()))
        throw_misfit("sum of sparse matrices");
    return std::make_shared<SparseMatrix>(first.rows(), first.columns(), [&](const int i, SparseMatrix::Row &row) {
      for (const auto &[factor, A] : summands)
        for (SparseRows::InnerIterator entry(A->by_place(), i); entry; ++entry)
          row.emplace_back(column_number(*A, entry.col()), factor * entry.value());
    });
  }

  double max_norm(const SparseMatrix &A)
  {
    double largest = 0.;
    for_entries(A, [&](int, int, const double value) { largest = std::max(largest, std::abs(value)); });
    return largest_of_processes(A.communicator(), largest);
  }

  double row_sum_norm(const SparseMatrix &A)
  {
    std::vector<double> sums(A.rows().n_local() + 1, 0.);
    for_entries(A, [&](const int i, int, const double value) { sums[i] += std::abs(value); });
    return largest_of_processes(A.communicator(), *std::max_element(sums.begin(), sums.end()));
  }

  DenseMatrix to_dense(const SparseMatrix &A)
  {
    DenseMatrix result = DenseMatrix::Zero(A.n_rows(), A.n_columns());
    for_entries(A, [&](const int i, const int column, const double value) { result(A.rows().number(i), column) = value; });
    sum_over_processes(A.communicator(), result.data(), result.size());
    return result;
  }

  SparseRows local_rows(const SparseMatrix &A)
  {
    if (A.halo() == nullptr)
      return A.by_place();
    return filled(A.rows().n_local(), A.n_columns(), [&](const int i, SparseMatrix::Row &row) { A.get_row(i, row); });
  }

  DenseMatrix weighted_gram(const MultiVector &X, const SparseMatrix &A, const MultiVector &Y)
  {
    DenseMatrix result(X.n_columns(), Y.n_columns());
    for_column_blocks(Y.n_columns(), [&](const int first, const int n) { result.middleCols(first, n) = gram(X, A * view(Y, first, n)); });
    return result;
  }

  DenseMatrix weighted_gram(const MultiVector &X, const SparseMatrix &A)
  {
    const int   k = X.n_columns();
    DenseMatrix result(k, k);
    for_column_blocks(k, [&](const int first, const int n) {
      const int         rows           = first + n;
      const DenseMatrix block          = gram(view(X, 0, rows), A * view(X, first, n));
      result.block(0, first, rows, n)  = block;
      result.block(first, 0, n, first) = block.topRows(first).transpose();
      result.block(first, first, n, n) = 0.5 * (block.bottomRows(n) + block.bottomRows(n).transpose());
    });
    return result;
  }

  void multiply_in_place(MultiVector &X, const DenseMatrix &S)
  {
    constexpr int rows_together = 1024;
    auto          x             = X.local();
    run_parts(X.n_local_rows(), rows_together, [&](const int first, const int n) {
      auto              rows    = x.middleRows(first, n);
      const DenseMatrix product = rows * S;
      rows                      = product;
    });
  }

  double unresolved_square(const SparseMatrix &K, const SparseMatrix &M)
  {
    constexpr double safety   = 100.;
    const auto       row_sums = [](const SparseMatrix &A) -> Eigen::ArrayXd {
      return A.by_place().cwiseAbs() * Eigen::VectorXd::Ones(A.by_place().cols());
    };
    const Eigen::ArrayXd stiffness = row_sums(K), mass = row_sums(M);
    const auto           counts  = mass > 0. && stiffness > 0.;
    double               sums[2] = {counts.select(mass * (stiffness / mass).log(), 0.).sum(), counts.select(mass, 0.).sum()};
    sum_over_processes(K.communicator(), sums, 2);
    return sums[1] > 0. ? safety * std::numeric_limits<double>::epsilon() * std::exp(sums[0] / sums[1]) : 0.;
  }
} // namespace Squeal
