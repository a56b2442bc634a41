#include "cholmod_triangle.h"
#include "elimination_order.h"
#include "libraries.h"
#include "supernodal_solve.h"

#include <squeal/linear_algebra/blas_threads.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <algorithm>
#include <memory>

namespace Squeal
{
  namespace
  {
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
        common.nmethods                   = 1;
        common.method[0].ordering         = CHOLMOD_GIVEN;
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
        solver->apply(X, Y);
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
      /// The lower triangle by columns, which are the rows of the upper one.
      struct Triangle
      {
        explicit Triangle(const SparseMatrix &A)
          : start(1, 0)
          , diagonal(A.n_rows(), 0.)
        {
          const LocalRows rows(A); // gone before anything is factorised
          row.reserve((rows.column.size() + rows.n_rows) / 2);
          value.reserve(row.capacity());
          for (int i = 0; i < rows.n_rows; ++i)
            {
              for (int k = rows.start[i]; k < rows.start[i + 1]; ++k)
                if (rows.column[k] >= i)
                  {
                    row.push_back(rows.column[k]);
                    value.push_back(rows.value[k]);
                    if (rows.column[k] == i)
                      diagonal[i] = rows.value[k];
                  }
              start.push_back(row.size());
            }
        }

        std::vector<int>    start, row;
        std::vector<double> value, diagonal;
      };

      void factorize(const SparseMatrix &A)
      {
        Triangle triangle(A);
        if (!std::all_of(triangle.diagonal.begin(), triangle.diagonal.end(), [](const double d) { return d > 0.; }))
          throw_not_positive_definite("CHOLMOD", what);

        cholmod_sparse               S     = lower_triangle(triangle.start, triangle.row, triangle.value.data());
        std::vector<int>             order = elimination_order(A, what);
        const ThreadsOfFactorization threads(A.n_rows());
        L = cholmod_analyze_p(&S, order.data(), nullptr, 0, &common);
        if (L == nullptr)
          throw_library_failure("CHOLMOD", "status " + std::to_string(common.status) + " of the analysis", what);
        const int success = cholmod_factorize(&S, L, &common);
        if (common.status == CHOLMOD_NOT_POSDEF)
          throw_not_positive_definite("CHOLMOD", what);
        if (success == 0 || common.status < CHOLMOD_OK)
          throw_library_failure("CHOLMOD", "status " + std::to_string(common.status) + " of the factorisation", what);
        if (!(smallest_relative_pivot(triangle.diagonal) > relative_pivot_tolerance))
          throw_not_positive_definite("CHOLMOD", what);
        solver = std::make_unique<SupernodalSolve>(supernodes());
      }

      SupernodalFactor supernodes() const
      {
        SupernodalFactor factor;
        factor.n_rows       = L->n;
        factor.n_supernodes = L->nsuper;
        factor.first_column = static_cast<const int *>(L->super);
        factor.row_start    = static_cast<const int *>(L->pi);
        factor.value_start  = static_cast<const int *>(L->px);
        factor.row          = static_cast<const int *>(L->s);
        factor.permutation  = static_cast<const int *>(L->Perm);
        factor.value        = static_cast<const double *>(L->x);
        return factor;
      }

      /// min L_ii² / A_ii: what the elimination left of the diagonal entries.
      double smallest_relative_pivot(const std::vector<double> &diagonal) const
      {
        const SupernodalFactor factor   = supernodes();
        double                 smallest = 1.;
        for (int s = 0; s < factor.n_supernodes; ++s)
          for (int column = 0; column < factor.n_columns(s); ++column)
            {
              const std::size_t offset = static_cast<std::size_t>(column) * (factor.n_rows_of(s) + 1);
              const double      pivot  = factor.value[factor.value_start[s] + offset];
              smallest                 = std::min(smallest, pivot * pivot / diagonal[factor.permutation[factor.first_column[s] + column]]);
            }
        return smallest;
      }

      void release()
      {
        cholmod_free_factor(&L, &common);
        cholmod_finish(&common);
      }

      const RowMap                           row_map;
      const std::string                      what;
      cholmod_factor                        *L = nullptr;
      cholmod_common                         common;
      std::unique_ptr<const SupernodalSolve> solver;
    };
  } // namespace

  std::unique_ptr<Factorization> cholmod_factorization(const SparseMatrix &A, const std::string &what)
  {
    return std::make_unique<CholmodFactorization>(A, what);
  }
} // namespace Squeal
