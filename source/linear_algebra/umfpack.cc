#include "libraries.h"

#include <squeal/linear_algebra/sparse_matrix.h>

#include <suitesparse/umfpack.h>

namespace Squeal
{
  namespace
  {
    /// Smallest over largest pivot up to which a matrix is singular: Q(λ) close to an eigenvalue is nearly so.
    constexpr double singular_pivot = 1e-16;

    class UmfpackFactorization : public Factorization
    {
    public:
      UmfpackFactorization(const SparseMatrix &A, const std::string &what)
        : row_map(A.rows())
        , what(what)
        , rows(A.by_place())
        , info(UMFPACK_INFO)
        , control(UMFPACK_CONTROL)
      {
        umfpack_di_defaults(control.data());
        // On finite element meshes nested dissection leaves less fill than minimum degree.
        control[UMFPACK_ORDERING] = UMFPACK_ORDERING_METIS;
        // Callers check residuals themselves; a refinement would double the time of every solution.
        control[UMFPACK_IRSTEP] = 0;

        void     *symbolic   = nullptr;
        const int analysed   = umfpack_di_symbolic(rows.rows(), rows.rows(), rows.outerIndexPtr(), rows.innerIndexPtr(), rows.valuePtr(),
                                                   &symbolic, control.data(), info.data());
        int       factorised = UMFPACK_OK;
        if (analysed == UMFPACK_OK)
          factorised = umfpack_di_numeric(rows.outerIndexPtr(), rows.innerIndexPtr(), rows.valuePtr(), symbolic, &numeric, control.data(),
                                          info.data());
        umfpack_di_free_symbolic(&symbolic);

        const bool singular = factorised == UMFPACK_WARNING_singular_matrix ||
                              (factorised == UMFPACK_OK && analysed == UMFPACK_OK && !(info[UMFPACK_RCOND] > singular_pivot));
        if (analysed != UMFPACK_OK || factorised != UMFPACK_OK || singular)
          umfpack_di_free_numeric(&numeric);
        if (singular)
          throw_singular("UMFPACK", what);
        if (analysed != UMFPACK_OK)
          throw_library_failure("UMFPACK", "status " + std::to_string(analysed) + " of the analysis", what);
        if (factorised != UMFPACK_OK)
          throw_library_failure("UMFPACK", "status " + std::to_string(factorised) + " of the factorisation", what);
      }

      ~UmfpackFactorization() override
      {
        umfpack_di_free_numeric(&numeric);
      }

      UmfpackFactorization(const UmfpackFactorization &)            = delete;
      UmfpackFactorization &operator=(const UmfpackFactorization &) = delete;

      // UMFPACK expects columns where our arrays list rows: what it takes for A is Aᵀ.

      void apply(const MultiVector &X, MultiVector &Y) const override
      {
        solve(UMFPACK_At, X, Y);
      }

      void apply_transpose(const MultiVector &X, MultiVector &Y) const override
      {
        solve(UMFPACK_A, X, Y);
      }

      double n_factor_entries() const override
      {
        return info[UMFPACK_LNZ] + info[UMFPACK_UNZ];
      }

      const RowMap &map() const override
      {
        return row_map;
      }

    private:
      void solve(const int system, const MultiVector &X, MultiVector &Y) const
      {
        std::vector<int>    integers(rows.rows());
        std::vector<double> reals(5 * static_cast<std::size_t>(rows.rows())), solve_info(UMFPACK_INFO);
        for (int j = 0; j < X.n_columns(); ++j)
          {
            const int status =
              umfpack_di_wsolve(system, rows.outerIndexPtr(), rows.innerIndexPtr(), rows.valuePtr(), Y.col(j).data(), X.col(j).data(),
                                numeric, control.data(), solve_info.data(), integers.data(), reals.data());
            if (status != UMFPACK_OK)
              throw_library_failure("UMFPACK", "status " + std::to_string(status) + " while solving", what);
          }
      }

      const RowMap        row_map;
      const std::string   what;
      const SparseRows    rows;
      std::vector<double> info, control;
      void               *numeric = nullptr;
    };
  } // namespace

  std::unique_ptr<Factorization> umfpack_factorization(const SparseMatrix &A, const std::string &what)
  {
    return std::make_unique<UmfpackFactorization>(A, what);
  }
} // namespace Squeal
