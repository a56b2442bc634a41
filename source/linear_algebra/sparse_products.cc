#include "sparse_products.h"

#include <squeal/base/tasks.h>

#include <deal.II/base/aligned_vector.h>

// The program is compiled for any processor of its family. A function marked so is compiled for newer ones, too; which of its versions runs is
// chosen when the program starts. What it calls has to be inlined, or is compiled for the oldest processor.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#  define SQUEAL_PROCESSORS __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#  define SQUEAL_PROCESSORS
#endif

namespace Squeal
{
  namespace
  {
    /// Rows of a product that are a task.
    constexpr int rows_of_task = 2048;

    /// Entries of a row of some vectors, in a register of the processor.
    constexpr int  lanes = 8;
    typedef double Lanes __attribute__((vector_size(lanes * sizeof(double))));

    /// Rows [first, end) of A X, @p width registers for a row of X.
    template <int width>
    __attribute__((always_inline)) inline void rows_of_product(const int     first,
                                                               const int     end,
                                                               const int    *start,
                                                               const int    *column,
                                                               const double *value,
                                                               const Lanes  *X,
                                                               Lanes        *Y)
    {
      for (int i = first; i < end; ++i)
        {
          // Two sums side by side, since one has to wait for its last addition
          Lanes even[width] = {}, odd[width] = {};
          int   k = start[i];
          for (; k + 1 < start[i + 1]; k += 2)
            for (int w = 0; w < width; ++w)
              {
                even[w] += value[k] * X[std::size_t(column[k]) * width + w];
                odd[w] += value[k + 1] * X[std::size_t(column[k + 1]) * width + w];
              }
          for (int w = 0; w < width; ++w)
            Y[std::size_t(i) * width + w] =
              even[w] + odd[w] + (k < start[i + 1] ? value[k] * X[std::size_t(column[k]) * width + w] : Lanes{});
        }
    }

    SQUEAL_PROCESSORS void multiply_8(const int     first,
                                      const int     end,
                                      const int    *start,
                                      const int    *column,
                                      const double *value,
                                      const Lanes  *X,
                                      Lanes        *Y)
    {
      rows_of_product<1>(first, end, start, column, value, X, Y);
    }

    SQUEAL_PROCESSORS void multiply_16(const int     first,
                                       const int     end,
                                       const int    *start,
                                       const int    *column,
                                       const double *value,
                                       const Lanes  *X,
                                       Lanes        *Y)
    {
      rows_of_product<2>(first, end, start, column, value, X, Y);
    }
  } // namespace

  void multiply_rows(const SparseRows &A, const Eigen::Ref<const DenseMatrix> &X, Eigen::Ref<DenseMatrix> Y)
  {
    // To put rows of X side by side would cost more than the product
    if (X.cols() == 1 || A.nonZeros() < X.rows())
      {
        run_parts(A.rows(), rows_of_task, [&](const int first, const int n) { Y.middleRows(first, n) = A.middleRows(first, n) * X; });
        return;
      }
    // Rows of some columns side by side, so that the entries of A are read once for all of them
    using SideBySide   = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, Eigen::Aligned64>;
    constexpr int most = 2 * lanes;
    for (Eigen::Index first_column = 0; first_column < X.cols(); first_column += most)
      {
        const Eigen::Index           n_columns = std::min<Eigen::Index>(X.cols() - first_column, most);
        const int                    width     = n_columns <= lanes ? 1 : 2;
        dealii::AlignedVector<Lanes> rows(X.rows() * width), image;
        image.resize_fast(A.rows() * width);
        SideBySide x(reinterpret_cast<double *>(rows.data()), X.rows(), lanes * width);
        SideBySide y(reinterpret_cast<double *>(image.data()), A.rows(), lanes * width);
        run_parts(X.rows(), rows_of_task,
                  [&](const int first, const int n) { x.block(first, 0, n, n_columns) = X.block(first, first_column, n, n_columns); });
        run_parts(A.rows(), rows_of_task, [&](const int first, const int n) {
          (width == 1 ? multiply_8 : multiply_16)(first, first + n, A.outerIndexPtr(), A.innerIndexPtr(), A.valuePtr(), rows.data(),
                                                  image.data());
          Y.block(first, first_column, n, n_columns) = y.block(first, 0, n, n_columns);
        });
      }
  }

  void multiply_transpose(const SparseRows &A, const Eigen::Ref<const DenseMatrix> &X, Eigen::Ref<DenseMatrix> Y)
  {
    run_tasks(static_cast<int>(X.cols()), [&](const int j) { Y.col(j) = A.transpose() * X.col(j); });
  }
} // namespace Squeal
