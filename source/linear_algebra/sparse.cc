#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/linear_algebra/sparse.h>

#include <EpetraExt_MatrixMatrix.h>
#include <Epetra_Comm.h>
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

    /// Number of the first local element when the elements of all processes are numbered without gaps.
    int first_number(const Epetra_Map &map)
    {
      const int n_mine      = map.NumMyElements();
      int       n_upto_mine = 0;
      // ScanSum is not const-correct about its input.
      int n = n_mine;
      map.Comm().ScanSum(&n, &n_upto_mine, 1);
      return n_upto_mine - n_mine;
    }

    /// The unit matrix on a map.
    SparseMatrix unit_matrix(const Epetra_Map &map)
    {
      SparseMatrix result(Copy, map, 1);
      const double one = 1.;
      for (int i = 0; i < map.NumMyElements(); ++i)
        {
          const int row = map.GID(i);
          result.InsertGlobalValues(row, 1, &one, &row);
        }
      result.FillComplete();
      return result;
    }
  } // namespace



  std::shared_ptr<SparseMatrix> multiply(const SparseMatrix &A, const SparseMatrix &B, const bool transpose_A, const bool transpose_B)
  {
    // Where three processes share the rows Epetra's product of two transposed matrices loses entries: (B A)ᵀ I instead
    if (transpose_A && transpose_B)
      return multiply(*multiply(B, A), unit_matrix(B.RangeMap()), true, false);

    const Epetra_Map &rows    = transpose_A ? A.DomainMap() : A.RangeMap();
    const Epetra_Map &columns = transpose_B ? B.RangeMap() : B.DomainMap();
    auto              C       = std::make_shared<SparseMatrix>(Copy, rows, 0);
    check_epetra(EpetraExt::MatrixMatrix::Multiply(A, transpose_A, B, transpose_B, *C, false), "product of two sparse matrices");
    check_epetra(C->FillComplete(columns, rows), "product of two sparse matrices");
    return C;
  }



  std::shared_ptr<SparseMatrix> congruence(const SparseMatrix &A, const SparseMatrix &T)
  {
    return multiply(T, *multiply(A, T), true, false);
  }



  std::shared_ptr<SparseMatrix> add(const double alpha, const SparseMatrix &A, const double beta, const SparseMatrix &B)
  {
    return linear_combination({{alpha, &A}, {beta, &B}});
  }



  std::shared_ptr<SparseMatrix> linear_combination(const std::vector<std::pair<double, const SparseMatrix *>> &summands)
  {
    const SparseMatrix &first = *summands.front().second;
    for (const auto &[factor, A] : summands)
      if (!A->RowMap().SameAs(first.RowMap()) || !A->DomainMap().SameAs(first.DomainMap()))
        throw SolverError("matrices of different shape or distribution", "sum of sparse matrices",
                          "this is a mistake in the program: please report it");

    // Where one pattern contains the other, as those of K and M mostly do,
    // inserting into a copy would fail; summing row by row covers all cases.
    const int        n_rows = first.NumMyRows();
    std::vector<int> row_lengths(n_rows, 0);
    for (const auto &[factor, A] : summands)
      for (int i = 0; i < n_rows; ++i)
        row_lengths[i] += A->NumMyEntries(i);
    auto C = std::make_shared<SparseMatrix>(Copy, first.RowMap(), row_lengths.data());

    std::vector<std::pair<int, double>> entries;
    std::vector<int>                    columns;
    std::vector<double>                 values;
    for (int i = 0; i < n_rows; ++i)
      {
        entries.clear();
        for (const auto &[factor, A] : summands)
          {
            int     n;
            double *value;
            int    *column;
            A->ExtractMyRowView(i, n, value, column);
            for (int k = 0; k < n; ++k)
              entries.emplace_back(A->GCID(column[k]), factor * value[k]);
          }
        std::stable_sort(entries.begin(), entries.end(), [](const auto &a, const auto &b) { return a.first < b.first; });

        columns.clear();
        values.clear();
        for (const auto &[column, value] : entries)
          if (!columns.empty() && columns.back() == column)
            values.back() += value;
          else
            {
              columns.push_back(column);
              values.push_back(value);
            }
        check_epetra(C->InsertGlobalValues(first.GRID(i), columns.size(), values.data(), columns.data()), "sum of sparse matrices");
      }
    check_epetra(C->FillComplete(first.DomainMap(), first.RangeMap()), "sum of sparse matrices");
    return C;
  }



  double max_norm(const SparseMatrix &A)
  {
    double local = 0.;
    for (int i = 0; i < A.NumMyRows(); ++i)
      {
        int     n;
        double *value;
        A.ExtractMyRowView(i, n, value);
        for (int k = 0; k < n; ++k)
          local = std::max(local, std::abs(value[k]));
      }
    double largest = 0.;
    A.Comm().MaxAll(&local, &largest, 1);
    return largest;
  }



  double symmetry_defect(const SparseMatrix &A)
  {
    const double scale = max_norm(A);
    if (scale == 0.)
      return 0.;
    SparseMatrix *difference = nullptr;
    check_epetra(EpetraExt::MatrixMatrix::Add(A, false, 1., A, true, -1., difference), "difference of a matrix and its transpose");
    const std::unique_ptr<SparseMatrix> owner(difference);
    check_epetra(owner->FillComplete(A.DomainMap(), A.RangeMap()), "difference of a matrix and its transpose");
    return max_norm(*owner) / scale;
  }



  DenseMatrix to_dense(const SparseMatrix &A)
  {
    const LocalRows rows(A);
    DenseMatrix     local = DenseMatrix::Zero(rows.n_rows, rows.n_columns), all(rows.n_rows, rows.n_columns);
    for (std::size_t i = 0; i + 1 < rows.start.size(); ++i)
      for (int k = rows.start[i]; k < rows.start[i + 1]; ++k)
        local(rows.first_row + i, rows.column[k]) = rows.value[k];
    A.Comm().SumAll(local.data(), all.data(), rows.n_rows * rows.n_columns);
    return all;
  }



  std::string matrix_market(const SparseMatrix &A, const MatrixMarketSymmetry symmetry)
  {
    const bool is_writer = A.Comm().MyPID() == 0;
    const bool symmetric = symmetry == MatrixMarketSymmetry::symmetric;

    // Global indices are what the file shows: bring all rows to process 0.
    const int        base = A.RowMap().IndexBase();
    std::vector<int> all_rows(is_writer ? A.NumGlobalRows() : 0);
    std::iota(all_rows.begin(), all_rows.end(), base);
    const Epetra_Map target(-1, all_rows.size(), all_rows.data(), base, A.Comm());
    SparseMatrix     gathered(Copy, target, 0);
    check_epetra(gathered.Import(A, Epetra_Import(target, A.RowMap()), Insert), "gathering of a matrix on process 0");
    check_epetra(gathered.FillComplete(A.DomainMap(), target), "gathering of a matrix on process 0");
    if (!is_writer)
      return "";

    std::ostringstream entries;
    entries.precision(std::numeric_limits<double>::max_digits10);
    long long n_entries = 0;
    for (int i = 0; i < gathered.NumMyRows(); ++i)
      {
        int     n;
        double *value;
        int    *column;
        gathered.ExtractMyRowView(i, n, value, column);
        std::map<int, double> row;
        for (int k = 0; k < n; ++k)
          if (const int j = gathered.GCID(column[k]) - base; !symmetric || j <= i)
            row[j] = value[k];
        for (const auto &[j, entry] : row)
          entries << i + 1 << ' ' << j + 1 << ' ' << entry << '\n';
        n_entries += row.size();
      }
    return text("%%MatrixMarket matrix coordinate real ", symmetric ? "symmetric" : "general", "\n", A.NumGlobalRows(), " ",
                A.NumGlobalCols(), " ", n_entries, "\n") +
           entries.str();
  }



  LocalRows::LocalRows(const SparseMatrix &A)
    : first_row(first_number(A.RangeMap()))
    , n_rows(A.RangeMap().NumGlobalElements())
    , n_columns(A.DomainMap().NumGlobalElements())
  {
    if (!A.RowMap().PointSameAs(A.RangeMap()))
      throw SolverError("a matrix whose rows are distributed differently from its results", "access to the rows of a sparse matrix",
                        "this is a mistake in the program: please report it");

    // Number the domain without gaps and look the numbers up for all columns stored here.
    Epetra_IntVector domain_numbers(A.DomainMap());
    std::iota(domain_numbers.Values(), domain_numbers.Values() + domain_numbers.MyLength(), first_number(A.DomainMap()));
    Epetra_IntVector column_numbers(A.ColMap());
    check_epetra(column_numbers.Import(domain_numbers, Epetra_Import(A.ColMap(), A.DomainMap()), Insert),
                 "numbering of the columns of a sparse matrix");

    start.push_back(0);
    std::vector<std::pair<int, double>> row;
    for (int i = 0; i < A.NumMyRows(); ++i)
      {
        int     n;
        double *values;
        int    *columns;
        A.ExtractMyRowView(i, n, values, columns);
        row.clear();
        for (int k = 0; k < n; ++k)
          row.emplace_back(column_numbers[columns[k]], values[k]);
        std::sort(row.begin(), row.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
        for (const auto &[j, entry] : row)
          {
            column.push_back(j);
            value.push_back(entry);
          }
        start.push_back(column.size());
      }
  }
} // namespace Squeal
