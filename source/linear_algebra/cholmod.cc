#include "libraries.h"

#include <squeal/base/decision.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <algorithm>
#include <suitesparse/cholmod.h>

namespace Squeal
{
  namespace
  {
    const Decision definite("smallest pivot / diagonal entry of a Cholesky factor", relative_pivot_tolerance);

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
        // Both orderings are computed and the one with less fill is taken.
        common.nmethods           = 2;
        common.method[0].ordering = CHOLMOD_AMD;
        common.method[1].ordering = CHOLMOD_METIS;
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
        // Wide enough for matrix-matrix kernels, narrow enough to stay in the cache.
        const int block = 32;
        for (int first = 0; first < X.n_columns(); first += block)
          {
            const int n_columns = std::min(block, X.n_columns() - first);
            for (int j = 0; j < n_columns; ++j)
              std::copy_n(X.col(first + j).begin(), row_map.n_local(), right_hand_side(j, n_columns));
            if (cholmod_solve2(CHOLMOD_A, L, B, nullptr, &solution, nullptr, &workspace_y, &workspace_e, &common) == 0)
              throw_library_failure("CHOLMOD", "status " + std::to_string(common.status) + " while solving", what);
            const double *values = static_cast<const double *>(solution->x);
            for (int j = 0; j < n_columns; ++j)
              std::copy_n(values + j * solution->d, row_map.n_local(), Y.col(first + j).begin());
          }
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
      void factorize(const SparseMatrix &A)
      {
        const LocalRows rows(A);
        const int       n = rows.n_rows;

        // Row i of the upper triangle is column i of the lower one.
        std::vector<int>    start(1, 0), row;
        std::vector<double> value, diagonal(n);
        for (int i = 0; i < n; ++i)
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
        if (!std::all_of(diagonal.begin(), diagonal.end(), [](const double d) { return d > 0.; }))
          throw_not_positive_definite("CHOLMOD", what);

        cholmod_sparse S = {};
        S.nrow = S.ncol = n;
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

        L = cholmod_analyze(&S, &common);
        if (L == nullptr)
          throw_library_failure("CHOLMOD", "status " + std::to_string(common.status) + " of the analysis", what);
        const int success = cholmod_factorize(&S, L, &common);
        if (common.status == CHOLMOD_NOT_POSDEF)
          throw_not_positive_definite("CHOLMOD", what);
        if (success == 0 || common.status < CHOLMOD_OK)
          throw_library_failure("CHOLMOD", "status " + std::to_string(common.status) + " of the factorisation", what);
        if (!definite.exceeded_by(smallest_relative_pivot(diagonal)))
          throw_not_positive_definite("CHOLMOD", what);
      }

      /// min L_ii² / A_ii: what the elimination left of the diagonal entries.
      double smallest_relative_pivot(const std::vector<double> &diagonal) const
      {
        const int    *super       = static_cast<const int *>(L->super);
        const int    *row_start   = static_cast<const int *>(L->pi);
        const int    *value_start = static_cast<const int *>(L->px);
        const double *value       = static_cast<const double *>(L->x);
        const int    *permutation = static_cast<const int *>(L->Perm);

        double smallest = 1.;
        for (std::size_t s = 0; s < L->nsuper; ++s)
          {
            const int n_rows = row_start[s + 1] - row_start[s];
            for (int column = super[s]; column < super[s + 1]; ++column)
              {
                const std::size_t offset = static_cast<std::size_t>(column - super[s]) * (n_rows + 1);
                const double      pivot  = value[value_start[s] + offset];
                smallest                 = std::min(smallest, pivot * pivot / diagonal[permutation[column]]);
              }
          }
        return smallest;
      }

      /// Column @p j of a right-hand side of @p n_columns.
      double *right_hand_side(const int j, const int n_columns) const
      {
        if (B == nullptr || static_cast<int>(B->ncol) != n_columns)
          {
            cholmod_free_dense(&B, &common);
            B = cholmod_allocate_dense(L->n, n_columns, L->n, CHOLMOD_REAL, &common);
            if (B == nullptr)
              throw_library_failure("CHOLMOD", "no memory for right-hand sides", what);
          }
        return static_cast<double *>(B->x) + static_cast<std::size_t>(j) * B->d;
      }

      void release()
      {
        cholmod_free_dense(&B, &common);
        cholmod_free_dense(&solution, &common);
        cholmod_free_dense(&workspace_y, &common);
        cholmod_free_dense(&workspace_e, &common);
        cholmod_free_factor(&L, &common);
        cholmod_finish(&common);
      }

      const RowMap      row_map;
      const std::string what;
      cholmod_factor   *L = nullptr;

      // CHOLMOD counts and allocates also while it solves.
      mutable cholmod_common common;
      mutable cholmod_dense *B           = nullptr;
      mutable cholmod_dense *solution    = nullptr;
      mutable cholmod_dense *workspace_y = nullptr;
      mutable cholmod_dense *workspace_e = nullptr;
    };
  } // namespace

  std::unique_ptr<Factorization> cholmod_factorization(const SparseMatrix &A, const std::string &what)
  {
    return std::make_unique<CholmodFactorization>(A, what);
  }
} // namespace Squeal
