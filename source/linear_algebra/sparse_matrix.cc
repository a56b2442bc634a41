#include "epetra_view.h"
#include "sparse_products.h"
#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <EpetraExt_MatrixMatrix.h>
#include <Epetra_CrsMatrix.h>
#include <Epetra_Import.h>
#include <Epetra_IntVector.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>

namespace Squeal
{
  namespace
  {
    void check_epetra(const int error, const char *operation)
    {
      // Positive values are warnings of Epetra.
      if (error < 0)
        throw SolverError("Epetra returned error " + std::to_string(error), operation,
                          "check that the shapes and distributions of the matrices fit together");
    }

    /// Rows whose columns ascend, given by their numbers, as a matrix of several processes.
    std::unique_ptr<Epetra_CrsMatrix> distributed(const RowMap &rows, const RowMap &columns, const RowArrays &given)
    {
      std::vector<int> lengths(rows.n_local());
      for (int i = 0; i < rows.n_local(); ++i)
        lengths[i] = given.start[i + 1] - given.start[i];
      const Epetra_Map &map    = rows.implementation();
      auto              matrix = std::make_unique<Epetra_CrsMatrix>(Copy, map, lengths.data());
      for (int i = 0; i < rows.n_local(); ++i)
        check_epetra(
          matrix->InsertGlobalValues(rows.number(i), lengths[i], given.value.data() + given.start[i], given.column.data() + given.start[i]),
          "rows of a sparse matrix");
      check_epetra(matrix->FillComplete(columns.implementation(), map), "rows of a sparse matrix");
      return matrix;
    }

    /// Rows whose columns ascend, given by their places where a process is alone, else by their numbers.
    RowArrays filled(const RowMap &rows, const RowMap &columns, const std::function<void(int, SparseMatrix::Row &)> &fill)
    {
      const bool        is_alone = rows.n_processes() == 1;
      SparseMatrix::Row row;
      RowArrays         result{{0}, {}, {}};
      for (int i = 0; i < rows.n_local(); ++i)
        {
          row.clear();
          fill(i, row);
          if (is_alone)
            for (auto &entry : row)
              entry.first = columns.place(entry.first);
          const auto by_column = [](const auto &a, const auto &b) { return a.first < b.first; };
          if (!std::is_sorted(row.begin(), row.end(), by_column))
            std::stable_sort(row.begin(), row.end(), by_column);
          for (const auto &[column, value] : row)
            if (static_cast<int>(result.column.size()) > result.start.back() && result.column.back() == column)
              result.value.back() += value;
            else
              {
                result.column.push_back(column);
                result.value.push_back(value);
              }
          result.start.push_back(static_cast<int>(result.column.size()));
        }
      return result;
    }

    /// Entries of a matrix of one process, or of its transpose.
    struct EntriesHere
    {
      EntriesHere(const SparseMatrix &A, const bool transpose)
        : of_transpose(transpose ? transposed(A.entries()->rows(), A.n_columns()) : RowArrays())
        , rows(transpose ? of_transpose.rows() : A.entries()->rows())
      {}
      EntriesHere(const EntriesHere &)            = delete;
      EntriesHere &operator=(const EntriesHere &) = delete;

      const RowArrays  of_transpose;
      const SparseRows rows;
    };

    /// op(A) op(B), of distributed matrices with Epetra's product.
    std::shared_ptr<SparseMatrix> product(const SparseMatrix &A, const bool transpose_A, const SparseMatrix &B, const bool transpose_B)
    {
      const RowMap &rows    = transpose_A ? A.columns() : A.rows();
      const RowMap &columns = transpose_B ? B.rows() : B.columns();
      if (A.entries() != nullptr)
        return std::make_shared<SparseMatrix>(rows, columns,
                                              product(EntriesHere(A, transpose_A).rows, EntriesHere(B, transpose_B).rows, columns.n()));
      auto C = std::make_unique<Epetra_CrsMatrix>(Copy, rows.implementation(), 0);
      check_epetra(EpetraExt::MatrixMatrix::Multiply(A.implementation(), transpose_A, B.implementation(), transpose_B, *C, false),
                   "product of two sparse matrices");
      check_epetra(C->FillComplete(columns.implementation(), rows.implementation()), "product of two sparse matrices");
      return std::make_shared<SparseMatrix>(std::move(C));
    }

    /// All rows of a matrix of several processes on process 0.
    std::shared_ptr<SparseMatrix> on_root(const SparseMatrix &A)
    {
      std::vector<int> all_rows(A.rows().rank() == 0 ? A.n_rows() : 0);
      std::iota(all_rows.begin(), all_rows.end(), 0);
      const Epetra_CrsMatrix &given  = A.implementation();
      const RowMap            target = RowMap::of(all_rows, A.communicator());
      auto                    result = std::make_unique<Epetra_CrsMatrix>(Copy, target.implementation(), 0);
      check_epetra(result->Import(given, Epetra_Import(target.implementation(), given.RowMap()), Insert), "gathering of a matrix");
      check_epetra(result->FillComplete(given.DomainMap(), target.implementation()), "gathering of a matrix");
      return std::make_shared<SparseMatrix>(std::move(result));
    }

    /// Number of the first local row when the rows of all processes are numbered without gaps.
    int first_number(const RowMap &map)
    {
      const int n_local = map.n_local();
      int       n_upto_here;
      MPI_Scan(&n_local, &n_upto_here, 1, MPI_INT, MPI_SUM, map.communicator());
      return n_upto_here - n_local;
    }

    /// Calls @p f with the entries of every row of this process.
    template <typename Function>
    void for_rows(const SparseMatrix &A, const Function &f)
    {
      SparseMatrix::Row row;
      for (int i = 0; i < A.rows().n_local(); ++i)
        {
          A.get_row(i, row);
          f(i, row);
        }
    }

    double largest_of_all(const SparseMatrix &A, const double local)
    {
      return largest_of_processes(A.communicator(), local);
    }
  } // namespace

  SparseMatrix::SparseMatrix(const RowMap &rows, const RowMap &columns, const std::function<void(int place, Row &row)> &fill)
    : row_map(rows)
    , column_map(columns)
  {
    if (rows.n_processes() == 1)
      arrays = std::make_unique<const RowArrays>(filled(rows, columns, fill));
    else
      matrix = distributed(rows, columns, filled(rows, columns, fill));
  }

  SparseMatrix::SparseMatrix(std::unique_ptr<Epetra_CrsMatrix> given)
    : matrix(std::move(given))
    , row_map(matrix->RangeMap())
    , column_map(matrix->DomainMap())
  {
    if (!matrix->RowMap().PointSameAs(matrix->RangeMap()))
      throw SolverError("a matrix whose rows are distributed differently from its results", "a sparse matrix",
                        "this is a mistake in the program: please report it");
  }

  SparseMatrix::SparseMatrix(const RowMap &rows, const RowMap &columns, RowArrays entries)
    : arrays(std::make_unique<const RowArrays>(std::move(entries)))
    , row_map(rows)
    , column_map(columns)
  {}

  SparseMatrix::~SparseMatrix() = default;

  const Epetra_CrsMatrix &SparseMatrix::implementation() const
  {
    return *matrix;
  }

  const RowArrays *SparseMatrix::entries() const
  {
    return arrays.get();
  }

  long long SparseMatrix::n_entries() const
  {
    return arrays ? static_cast<long long>(arrays->column.size()) : matrix->NumGlobalNonzeros64();
  }

  void SparseMatrix::get_row(const int place, Row &row) const
  {
    row.clear();
    if (arrays)
      {
        for (int k = arrays->start[place]; k < arrays->start[place + 1]; ++k)
          row.emplace_back(column_map.number(arrays->column[k]), arrays->value[k]);
        return;
      }
    int     n;
    double *values;
    int    *columns;
    check_epetra(matrix->ExtractMyRowView(place, n, values, columns), "a row of a sparse matrix");
    for (int k = 0; k < n; ++k)
      row.emplace_back(matrix->GCID(columns[k]), values[k]);
  }

  void SparseMatrix::multiply(const bool transposed, const MultiVector &X, MultiVector &Y) const
  {
    if (X.n_columns() != Y.n_columns() || X.n_local_rows() != (transposed ? rows() : columns()).n_local() ||
        Y.n_local_rows() != (transposed ? columns() : rows()).n_local())
      throw SolverError("the shapes of a matrix and of vectors do not fit together", "product of a sparse matrix and vectors",
                        "this is a mistake in the program: please report it");
    if (X.n_columns() == 0)
      return;
    if (arrays)
      {
        if (transposed)
          multiply_transpose(arrays->rows(), X.local(), Y.local());
        else
          multiply_rows(arrays->rows(), X.local(), Y.local());
        return;
      }

    const char *operation = "product of a sparse matrix and vectors";
    int        *start, *columns;
    double     *values;
    if (transposed || !matrix->StorageOptimized() || matrix->ExtractCrsDataPointers(start, columns, values) != 0)
      {
        Epetra_MultiVector image = epetra_view(Y);
        check_epetra(matrix->Multiply(transposed, epetra_view(X), image), operation);
        return;
      }

    const SparseRows A{matrix->NumMyRows(), start, columns, values};
    if (const Epetra_Import *importer = matrix->Importer())
      {
        Epetra_MultiVector here(matrix->ColMap(), X.n_columns(), false);
        check_epetra(here.Import(epetra_view(X), *importer, Insert), operation);
        multiply_rows(A, Eigen::Map<const DenseMatrix>(here.Values(), matrix->NumMyCols(), X.n_columns()), Y.local());
      }
    else
      multiply_rows(A, X.local(), Y.local());
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
    // Where three processes share the rows Epetra's product of two transposed matrices loses entries: (B A)ᵀ instead
    if (transpose_A && transpose_B)
      return transpose(*multiply(B, A));
    return product(A, transpose_A, B, transpose_B);
  }

  std::shared_ptr<SparseMatrix> transpose(const SparseMatrix &A)
  {
    const RowMap      &rows = A.rows();
    const SparseMatrix unit(rows, rows, [&](const int i, SparseMatrix::Row &row) { row = {{rows.number(i), 1.}}; });
    return product(A, true, unit, false);
  }

  std::shared_ptr<SparseMatrix> congruence(const SparseMatrix &A, const SparseMatrix &T)
  {
    if (T.entries() == nullptr)
      return multiply(T, *multiply(A, T), true, false);
    const EntriesHere from_left(T, true), from_right(T, false);
    const int         n  = T.n_columns();
    const RowArrays   AT = product(EntriesHere(A, false).rows, from_right.rows, n);
    return std::make_shared<SparseMatrix>(T.columns(), T.columns(), product(from_left.rows, AT.rows(), n));
  }

  std::shared_ptr<SparseMatrix> moduli(const SparseMatrix &A)
  {
    if (A.entries() != nullptr)
      {
        RowArrays result = *A.entries();
        for (double &value : result.value)
          value = std::abs(value);
        return std::make_shared<SparseMatrix>(A.rows(), A.columns(), std::move(result));
      }
    auto result = std::make_unique<Epetra_CrsMatrix>(A.implementation());
    for (int i = 0; i < result->NumMyRows(); ++i)
      {
        int     n;
        double *values;
        check_epetra(result->ExtractMyRowView(i, n, values), "a row of a sparse matrix");
        std::transform(values, values + n, values, [](const double value) { return std::abs(value); });
      }
    return std::make_shared<SparseMatrix>(std::move(result));
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
        throw SolverError("matrices of different shape or distribution", "sum of sparse matrices",
                          "this is a mistake in the program: please report it");

    if (first.entries() != nullptr)
      {
        std::vector<std::pair<double, SparseRows>> rows;
        for (const auto &[factor, A] : summands)
          rows.emplace_back(factor, A->entries()->rows());
        return std::make_shared<SparseMatrix>(first.rows(), first.columns(), sum(rows, first.n_columns()));
      }
    SparseMatrix::Row part;
    return std::make_shared<SparseMatrix>(first.rows(), first.columns(), [&](const int i, SparseMatrix::Row &row) {
      for (const auto &[factor, A] : summands)
        {
          A->get_row(i, part);
          for (const auto &[column, value] : part)
            row.emplace_back(column, factor * value);
        }
    });
  }

  double max_norm(const SparseMatrix &A)
  {
    double largest = 0.;
    for_rows(A, [&](int, const SparseMatrix::Row &row) {
      for (const auto &[column, value] : row)
        largest = std::max(largest, std::abs(value));
    });
    return largest_of_all(A, largest);
  }

  double row_sum_norm(const SparseMatrix &A)
  {
    double largest = 0.;
    for_rows(A, [&](int, const SparseMatrix::Row &row) {
      largest = std::max(largest, std::accumulate(row.begin(), row.end(), 0.,
                                                  [](const double sum, const auto &entry) { return sum + std::abs(entry.second); }));
    });
    return largest_of_all(A, largest);
  }

  double symmetry_defect(const SparseMatrix &A)
  {
    const double scale = max_norm(A);
    return scale == 0. ? 0. : max_norm(*add(1., A, -1., *transpose(A))) / scale;
  }

  DenseMatrix to_dense(const SparseMatrix &A)
  {
    const LocalRows rows(A);
    DenseMatrix     local = DenseMatrix::Zero(rows.n_rows, rows.n_columns);
    for (std::size_t i = 0; i + 1 < rows.start.size(); ++i)
      for (int k = rows.start[i]; k < rows.start[i + 1]; ++k)
        local(rows.first_row + i, rows.column[k]) = rows.value[k];
    sum_over_processes(A.communicator(), local.data(), local.size());
    return local;
  }

  std::string matrix_market(const SparseMatrix &A, const MatrixMarketSymmetry symmetry)
  {
    const bool is_writer = A.rows().rank() == 0;
    const bool symmetric = symmetry == MatrixMarketSymmetry::symmetric;

    // Global numbers are what the file shows
    const auto          gathered = A.entries() != nullptr ? nullptr : on_root(A);
    const SparseMatrix &whole    = gathered ? *gathered : A;
    if (!is_writer)
      return "";

    std::ostringstream entries;
    entries.precision(std::numeric_limits<double>::max_digits10);
    long long         n_entries = 0;
    SparseMatrix::Row row;
    for (int i = 0; i < whole.n_rows(); ++i)
      {
        whole.get_row(whole.rows().place(i), row);
        std::sort(row.begin(), row.end());
        for (const auto &[j, entry] : row)
          if (!symmetric || j <= i)
            {
              entries << i + 1 << ' ' << j + 1 << ' ' << entry << '\n';
              ++n_entries;
            }
      }
    return text("%%MatrixMarket matrix coordinate real ", symmetric ? "symmetric" : "general", "\n", A.n_rows(), " ", A.n_columns(), " ",
                n_entries, "\n") +
           entries.str();
  }

  LocalRows::LocalRows(const SparseMatrix &A)
    : first_row(A.entries() != nullptr ? 0 : first_number(A.rows()))
    , n_rows(A.n_rows())
    , n_columns(A.n_columns())
  {
    if (const RowArrays *entries = A.entries())
      {
        start  = entries->start;
        column = entries->column;
        value  = entries->value;
        return;
      }

    // Number the columns without gaps and look the numbers up for all columns stored here.
    const Epetra_CrsMatrix &matrix = A.implementation();
    Epetra_IntVector        own(matrix.DomainMap()), here(matrix.ColMap());
    std::iota(own.Values(), own.Values() + own.MyLength(), first_number(A.columns()));
    check_epetra(here.Import(own, Epetra_Import(matrix.ColMap(), matrix.DomainMap()), Insert),
                 "numbering of the columns of a sparse matrix");

    start.push_back(0);
    for_rows(A, [&](int, SparseMatrix::Row &row) {
      for (auto &entry : row)
        entry.first = here[matrix.LCID(entry.first)];
      std::sort(row.begin(), row.end());
      for (const auto &[j, entry] : row)
        {
          column.push_back(j);
          value.push_back(entry);
        }
      start.push_back(column.size());
    });
  }
} // namespace Squeal
