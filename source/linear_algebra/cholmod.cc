// SPDX-License-Identifier: GPL-3.0-or-later

#include "libraries.h"

#include <squeal/base/tasks.h>
#include <squeal/linear_algebra/blas_threads.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <cholmod.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace Squeal
{
  namespace
  {
    /// Matrix size below which the total time is shorter with minimum degree than with nested dissection.
    constexpr int rows_for_dissection = 2000;

    /// Number of right-hand sides per task: small enough to occupy all threads, but several, because every task reads the whole factor.
    int columns_of_task(const int n_columns)
    {
      constexpr int fewest = 4, most = 32;
      const int     n_threads = static_cast<int>(n_task_threads());
      return std::clamp((n_columns + n_threads - 1) / n_threads, n_threads == 1 ? most : fewest, most);
    }

    class CholmodFactorization : public Factorization
    {
    public:
      CholmodFactorization(const SparseMatrix &A, const std::string &what)
        : row_map(A.rows())
        , what(what)
      {
        cholmod_start(&common);
        common.print                      = 0;
        common.supernodal                 = CHOLMOD_SUPERNODAL;
        common.final_ll                   = 1;
        common.quick_return_if_not_posdef = 1;
        common.nmethods                   = A.n_rows() < rows_for_dissection ? 1 : 2;
        common.method[0].ordering         = CHOLMOD_AMD;
        common.method[1].ordering         = CHOLMOD_METIS;
        try
          {
            factorize(A);
          }
        catch (...)
          {
            release();
            throw;
          }
      }

      ~CholmodFactorization() override
      {
        release();
      }

      CholmodFactorization(const CholmodFactorization &)            = delete;
      CholmodFactorization &operator=(const CholmodFactorization &) = delete;

      void apply(const MultiVector &X, MultiVector &Y) const override
      {
        solve(CHOLMOD_A, X, Y);
      }

      bool half_solve(const MultiVector &X, MultiVector &Y) const override
      {
        solve(CHOLMOD_Lt, X, Y);
        solve(CHOLMOD_Pt, MultiVector(Y), Y);
        return true;
      }

      void apply_transpose(const MultiVector &X, MultiVector &Y) const override
      {
        apply(X, Y);
      }

      double n_factor_entries() const override
      {
        return common.lnz;
      }

      const RowMap &map() const override
      {
        return row_map;
      }

    private:
      /// Solves a system of equations with the factors for Y; @p system: CHOLMOD_A, CHOLMOD_Lt or CHOLMOD_Pt.
      void solve(const int system, const MultiVector &X, MultiVector &Y) const
      {
        run_parts(X.n_columns(), columns_of_task(X.n_columns()), [&](const int first, const int n) {
          cholmod_common own;
          cholmod_start(&own);
          cholmod_dense  right_sides = columns(X, first, n);
          cholmod_dense *solutions = nullptr, *permuted = nullptr, *front = nullptr;
          const int      success = cholmod_solve2(system, L, &right_sides, nullptr, &solutions, nullptr, &permuted, &front, &own);
          for (int j = 0; success != 0 && j < n; ++j)
            std::copy_n(static_cast<const double *>(solutions->x) + j * solutions->d, L->n, Y.col(first + j).data());
          for (cholmod_dense **vectors : {&solutions, &permuted, &front})
            cholmod_free_dense(vectors, &own);
          const int status = own.status;
          cholmod_finish(&own);
          if (success == 0)
            throw_library_failure("CHOLMOD", "status " + std::to_string(status) + " of the solution", what);
        });
      }

      /// View of columns for CHOLMOD, which does not change them.
      static cholmod_dense columns(const MultiVector &X, const int first, const int n)
      {
        cholmod_dense view = {};
        view.nrow = view.d = X.n_local_rows();
        view.ncol          = n;
        view.nzmax         = view.d * n;
        view.x             = const_cast<double *>(X.col(first).data());
        view.xtype         = CHOLMOD_REAL;
        view.dtype         = CHOLMOD_DOUBLE;
        return view;
      }

      /// Lower triangle in column-major form: the rows of the upper triangle of a symmetric matrix.
      struct Triangle
      {
        explicit Triangle(const SparseMatrix &A)
          : start(1, 0)
          , diagonal(A.n_rows(), 0.)
        {
          row.reserve((A.n_entries() + A.n_rows()) / 2);
          value.reserve(row.capacity());
          for (int i = 0; i < A.n_rows(); ++i)
            {
              for (SparseRows::InnerIterator entry(A.by_place(), i); entry; ++entry)
                if (entry.col() >= i)
                  {
                    row.push_back(entry.col());
                    value.push_back(entry.value());
                    if (entry.col() == i)
                      diagonal[i] = entry.value();
                  }
              start.push_back(row.size());
            }
        }

        cholmod_sparse view()
        {
          cholmod_sparse S = {};
          S.nrow = S.ncol = diagonal.size();
          S.nzmax         = row.size();
          S.p             = start.data();
          S.i             = row.data();
          S.x             = value.data();
          S.stype         = -1;
          S.itype         = CHOLMOD_INT;
          S.xtype         = CHOLMOD_REAL;
          S.dtype         = CHOLMOD_DOUBLE;
          S.sorted        = 1;
          S.packed        = 1;
          return S;
        }

        std::vector<int>    start, row;
        std::vector<double> value, diagonal;
      };

      void factorize(const SparseMatrix &A)
      {
        Triangle triangle(A);
        if (!std::all_of(triangle.diagonal.begin(), triangle.diagonal.end(), [](const double d) { return d > 0.; }))
          throw_not_positive_definite("CHOLMOD", what);

        cholmod_sparse               S = triangle.view();
        const ThreadsOfFactorization threads(A.n_rows());
        L = cholmod_analyze(&S, &common);
        if (L == nullptr)
          throw_library_failure("CHOLMOD", "status " + std::to_string(common.status) + " of the analysis", what);
        const int success = cholmod_factorize(&S, L, &common);
        if (common.status == CHOLMOD_NOT_POSDEF)
          throw_not_positive_definite("CHOLMOD", what);
        if (success == 0 || common.status < CHOLMOD_OK)
          throw_library_failure("CHOLMOD", "status " + std::to_string(common.status) + " of the factorisation", what);
        if (!(smallest_relative_pivot(triangle.diagonal) > relative_pivot_tolerance))
          throw_not_positive_definite("CHOLMOD", what);
      }

      /// min L_ii² / A_ii: smallest relative pivot.
      double smallest_relative_pivot(const std::vector<double> &diagonal) const
      {
        const auto *first_column = static_cast<const int *>(L->super), *row_start = static_cast<const int *>(L->pi),
                   *value_start = static_cast<const int *>(L->px), *permutation = static_cast<const int *>(L->Perm);
        double smallest = 1.;
        for (std::size_t s = 0; s < L->nsuper; ++s)
          for (int column = first_column[s]; column < first_column[s + 1]; ++column)
            {
              const std::size_t n_rows = row_start[s + 1] - row_start[s], offset = (column - first_column[s]) * (n_rows + 1);
              const double      pivot = static_cast<const double *>(L->x)[value_start[s] + offset];
              smallest                = std::min(smallest, pivot * pivot / diagonal[permutation[column]]);
            }
        return smallest;
      }

      void release()
      {
        cholmod_free_factor(&L, &common);
        cholmod_finish(&common);
      }

      const RowMap      row_map;
      const std::string what;
      cholmod_factor   *L = nullptr;
      cholmod_common    common;
    };
  } // namespace

  std::unique_ptr<Factorization> cholmod_factorization(const SparseMatrix &A, const std::string &what)
  {
    return std::make_unique<CholmodFactorization>(A, what);
  }
} // namespace Squeal
