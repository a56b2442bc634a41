#include "sparse_products.h"

#include <squeal/base/tasks.h>

#include <deal.II/base/aligned_vector.h>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    /// Rows of a product that are a task.
    constexpr int rows_of_task = 2048;

    /// Y = A X for a few columns, whose rows are put side by side so that the entries of A are read once for all of them.
    template <int width>
    void multiply_columns(const SparseRows &A, const Eigen::Ref<const DenseMatrix> &X, Eigen::Ref<DenseMatrix> Y)
    {
      const int                             n_columns = static_cast<int>(X.cols());
      dealii::AlignedVector<LaneRow<width>> rows, image;
      rows.resize_fast(X.rows());
      image.resize_fast(A.n_rows);
      run_parts(static_cast<int>(X.rows()), rows_of_task, [&](const int first, const int n_rows) {
        to_lanes(X.data() + first, X.outerStride(), n_rows, n_columns, rows.data() + first);
      });
      run_parts(A.n_rows, rows_of_task, [&](const int first, const int n_rows) {
        set_products({n_rows, A.start + first, A.column, A.value}, rows.data(), image.data() + first);
        from_lanes(image.data() + first, Y.data() + first, Y.outerStride(), n_rows, n_columns);
      });
    }

    /// The same for one column.
    void multiply_column(const SparseRows &A, const Eigen::Ref<const DenseMatrix> &X, Eigen::Ref<DenseMatrix> Y)
    {
      run_parts(A.n_rows, rows_of_task, [&](const int first, const int n_rows) {
        for (int i = first; i < first + n_rows; ++i)
          {
            double sum = 0.;
            for (int k = A.start[i]; k < A.start[i + 1]; ++k)
              sum += A.value[k] * X(A.column[k], 0);
            Y(i, 0) = sum;
          }
      });
    }

    /**
     * Rows [first, last) of a matrix of which each is a sum of multiples of rows of others (F. G. Gustavson, ACM Trans. Math. Softw.
     * 4 (1978) 250).
     *
     * @param add_rows calls add(factor, matrix, row) for each of them
     */
    template <typename AddRows>
    RowArrays some_rows(const int first, const int last, const int n_columns, const AddRows &add_rows)
    {
      RowArrays           result{{0}, {}, {}};
      std::vector<double> sums(n_columns, 0.);
      std::vector<int>    last_row(n_columns, -1), columns; // in which a column occurred
      for (int i = first; i < last; ++i)
        {
          columns.clear();
          add_rows(i, [&](const double factor, const SparseRows &B, const int row) {
            for (int p = B.start[row]; p < B.start[row + 1]; ++p)
              {
                const int j = B.column[p];
                if (last_row[j] != i)
                  {
                    last_row[j] = i;
                    sums[j]     = 0.;
                    columns.push_back(j);
                  }
                sums[j] += factor * B.value[p];
              }
          });
          std::sort(columns.begin(), columns.end());
          for (const int j : columns)
            result.value.push_back(sums[j]);
          result.column.insert(result.column.end(), columns.begin(), columns.end());
          result.start.push_back(static_cast<int>(result.column.size()));
        }
      return result;
    }

    /// All rows, some of them a task.
    template <typename AddRows>
    RowArrays all_rows(const int n_rows, const int n_columns, const AddRows &add_rows)
    {
      std::vector<RowArrays> parts((n_rows + rows_of_task - 1) / rows_of_task);
      run_tasks(static_cast<int>(parts.size()), [&](const int part) {
        parts[part] = some_rows(part * rows_of_task, std::min(n_rows, (part + 1) * rows_of_task), n_columns, add_rows);
      });
      RowArrays   result{{0}, {}, {}};
      std::size_t n_entries = 0;
      for (const RowArrays &part : parts)
        n_entries += part.column.size();
      result.column.reserve(n_entries);
      result.value.reserve(n_entries);
      for (RowArrays &part : parts)
        {
          const int before = result.start.back();
          std::transform(part.start.begin() + 1, part.start.end(), std::back_inserter(result.start),
                         [&](const int end) { return before + end; });
          result.column.insert(result.column.end(), part.column.begin(), part.column.end());
          result.value.insert(result.value.end(), part.value.begin(), part.value.end());
          part = {};
        }
      return result;
    }
  } // namespace

  RowArrays transposed(const SparseRows &A, const int n_columns)
  {
    const int n_entries = A.start[A.n_rows];
    RowArrays result{std::vector<int>(n_columns + 1, 0), std::vector<int>(n_entries), std::vector<double>(n_entries)};
    for (int p = 0; p < n_entries; ++p)
      ++result.start[A.column[p] + 1];
    for (int j = 0; j < n_columns; ++j)
      result.start[j + 1] += result.start[j];
    std::vector<int> next = result.start;
    for (int i = 0; i < A.n_rows; ++i)
      for (int p = A.start[i]; p < A.start[i + 1]; ++p)
        {
          const int place      = next[A.column[p]]++;
          result.column[place] = i;
          result.value[place]  = A.value[p];
        }
    return result;
  }

  RowArrays product(const SparseRows &A, const SparseRows &B, const int n_columns)
  {
    return all_rows(A.n_rows, n_columns, [&](const int i, const auto &add) {
      for (int p = A.start[i]; p < A.start[i + 1]; ++p)
        add(A.value[p], B, A.column[p]);
    });
  }

  RowArrays sum(const std::vector<std::pair<double, SparseRows>> &summands, const int n_columns)
  {
    return all_rows(summands.front().second.n_rows, n_columns, [&](const int i, const auto &add) {
      for (const auto &[factor, A] : summands)
        add(factor, A, i);
    });
  }

  void multiply_rows(const SparseRows &A, const Eigen::Ref<const DenseMatrix> &X, Eigen::Ref<DenseMatrix> Y)
  {
    const Eigen::Index n = X.cols();
    // To put rows of X side by side would cost more than the product
    if (A.start[A.n_rows] < X.rows())
      {
        run_tasks(static_cast<int>(n), [&](const int j) { multiply_column(A, X.col(j), Y.col(j)); });
        return;
      }
    Eigen::Index width;
    for (Eigen::Index first = 0; first < n; first += width)
      {
        width                    = std::min<Eigen::Index>(n - first, 16);
        const auto multiply_some = width == 1 ? multiply_column : width <= 8 ? multiply_columns<8> : multiply_columns<16>;
        multiply_some(A, X.middleCols(first, width), Y.middleCols(first, width));
      }
  }

  void multiply_transpose(const SparseRows &A, const Eigen::Ref<const DenseMatrix> &X, Eigen::Ref<DenseMatrix> Y)
  {
    run_tasks(static_cast<int>(X.cols()), [&](const int j) {
      auto y = Y.col(j);
      y.setZero();
      for (int i = 0; i < A.n_rows; ++i)
        for (int k = A.start[i]; k < A.start[i + 1]; ++k)
          y(A.column[k]) += A.value[k] * X(i, j);
    });
  }
} // namespace Squeal
