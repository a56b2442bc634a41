#include "libraries.h"

#include <squeal/linear_algebra/sparse_matrix.h>

#include <dmumps_c.h>
#include <mpi.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    /// What MUMPS is told about a matrix.
    enum class MatrixKind
    {
      general           = 0,
      positive_definite = 1,
      symmetric         = 2
    };

    /// An instance of MUMPS with the factors of one matrix.
    class Mumps
    {
    public:
      Mumps(const SparseMatrix &A, const MatrixKind symmetry, const std::string &what)
        : what(what)
        , comm(A.communicator())
        , rows(A)
      {
        MPI_Comm_rank(comm, &rank);
        int n_processes;
        MPI_Comm_size(comm, &n_processes);
        row_counts.resize(n_processes);
        first_rows.resize(n_processes);
        n_local_rows = rows.start.size() - 1;
        MPI_Allgather(&n_local_rows, 1, MPI_INT, row_counts.data(), 1, MPI_INT, comm);
        MPI_Allgather(&rows.first_row, 1, MPI_INT, first_rows.data(), 1, MPI_INT, comm);

        id.sym          = static_cast<int>(symmetry);
        id.par          = 1;
        id.comm_fortran = MPI_Comm_c2f(comm);
        run(-1);
        try
          {
            factorize(symmetry != MatrixKind::general);
          }
        catch (...)
          {
            run(-2);
            throw;
          }
      }

      ~Mumps()
      {
        int finalized;
        MPI_Finalized(&finalized);
        if (!finalized)
          run(-2);
      }

      Mumps(const Mumps &)            = delete;
      Mumps &operator=(const Mumps &) = delete;

      int n_negative_pivots() const
      {
        return id.infog[11];
      }

      int n_null_pivots() const
      {
        return id.infog[27];
      }

      double n_factor_entries() const
      {
        // Negative numbers are millions.
        return id.infog[28] >= 0 ? id.infog[28] : -1e6 * id.infog[28];
      }

      void solve(const bool transpose, const MultiVector &X, MultiVector &Y)
      {
        // MUMPS wants right-hand sides whole on one process; a bound on their number bounds its memory there.
        const int block = 64;
        for (int first = 0; first < X.n_columns(); first += block)
          {
            const int n_columns = std::min(block, X.n_columns() - first);
            if (rank == 0)
              centralised.resize(static_cast<std::size_t>(rows.n_rows) * n_columns);
            const auto column = [&](const int j) {
              return rank == 0 ? centralised.data() + static_cast<std::size_t>(rows.n_rows) * j : nullptr;
            };

            for (int j = 0; j < n_columns; ++j)
              MPI_Gatherv(X.col(first + j).data(), n_local_rows, MPI_DOUBLE, column(j), row_counts.data(), first_rows.data(), MPI_DOUBLE, 0,
                          comm);
            id.rhs       = centralised.data();
            id.nrhs      = n_columns;
            id.lrhs      = rows.n_rows;
            id.icntl[8]  = transpose ? 0 : 1;
            id.icntl[26] = 32; // columns that pass through the factors together
            run(3);
            check("solution");
            for (int j = 0; j < n_columns; ++j)
              MPI_Scatterv(column(j), row_counts.data(), first_rows.data(), MPI_DOUBLE, Y.col(first + j).data(), n_local_rows, MPI_DOUBLE,
                           0, comm);
          }
      }

    private:
      void factorize(const bool one_triangle)
      {
        for (int output : {0, 1, 2})
          id.icntl[output] = -1;
        id.icntl[3]  = 0;
        id.icntl[17] = 3;     // every process brings its rows
        id.icntl[12] = 1;     // no dense parallel root, which would hide signs of pivots
        id.icntl[23] = 1;     // pivots that vanish are reported, not divided by ...
        id.cntl[2]   = 1e-14; // ... where they are below this, relative to the scaled matrix
        id.icntl[10] = 0;

        std::vector<int>    row, column;
        std::vector<double> value;
        // MUMPS must not see null pointers on processes without rows.
        row.reserve(1);
        column.reserve(1);
        value.reserve(1);
        for (int i = 0; i < n_local_rows; ++i)
          for (int k = rows.start[i]; k < rows.start[i + 1]; ++k)
            if (!one_triangle || rows.column[k] <= rows.first_row + i)
              {
                row.push_back(rows.first_row + i + 1);
                column.push_back(rows.column[k] + 1);
                value.push_back(rows.value[k]);
              }
        id.n       = rows.n_rows;
        id.nnz_loc = value.size();
        id.irn_loc = row.data();
        id.jcn_loc = column.data();
        id.a_loc   = value.data();

        run(1);
        check("analysis");
        // Pivoting may need more memory than the analysis foresaw: allow for more and try again.
        for (int attempt = 0; attempt < 6; ++attempt)
          {
            run(2);
            const bool too_little_workspace = id.infog[0] == -8 || id.infog[0] == -9;
            if (!too_little_workspace)
              break;
            id.icntl[13] = 2 * std::max<int>(id.icntl[13], 20);
          }
        if (id.infog[0] == -10)
          throw_singular("MUMPS", what);
        if (id.infog[0] == -40)
          throw_not_positive_definite("MUMPS", what);
        check("factorisation");
        id.irn_loc = id.jcn_loc = nullptr;
        id.a_loc                = nullptr;
      }

      void run(const int job)
      {
        id.job = job;
        dmumps_c(&id);
      }

      void check(const std::string &step) const
      {
        if (id.infog[0] < 0)
          throw_library_failure(
            "MUMPS", "INFOG(1) = " + std::to_string(id.infog[0]) + ", INFOG(2) = " + std::to_string(id.infog[1]) + " of the " + step, what);
      }

      const std::string   what;
      const MPI_Comm      comm;
      const LocalRows     rows;
      int                 rank, n_local_rows;
      std::vector<int>    row_counts, first_rows;
      std::vector<double> centralised;
      DMUMPS_STRUC_C      id = {};
    };

    class MumpsFactorization : public Factorization
    {
    public:
      MumpsFactorization(const SparseMatrix &A, const MatrixKind symmetry, const std::string &what)
        : row_map(A.rows())
        , mumps(std::make_unique<Mumps>(A, symmetry, what))
      {
        if (symmetry == MatrixKind::positive_definite && (mumps->n_negative_pivots() > 0 || mumps->n_null_pivots() > 0))
          throw_not_positive_definite("MUMPS", what);
        if (mumps->n_null_pivots() > 0)
          throw_singular("MUMPS", what);
      }

      void apply(const MultiVector &X, MultiVector &Y) const override
      {
        mumps->solve(false, X, Y);
      }

      void apply_transpose(const MultiVector &X, MultiVector &Y) const override
      {
        mumps->solve(true, X, Y);
      }

      double n_factor_entries() const override
      {
        return mumps->n_factor_entries();
      }

      const RowMap &map() const override
      {
        return row_map;
      }

    private:
      const RowMap           row_map;
      std::unique_ptr<Mumps> mumps;
    };
  } // namespace

  std::unique_ptr<Factorization> mumps_factorization(const SparseMatrix &A, const bool positive_definite, const std::string &what)
  {
    return std::make_unique<MumpsFactorization>(A, positive_definite ? MatrixKind::positive_definite : MatrixKind::general, what);
  }

  int count_negative_eigenvalues(const SparseMatrix &A, const std::string &what, int *n_null)
  {
    const Mumps mumps(A, MatrixKind::symmetric, what);
    if (n_null != nullptr)
      *n_null = mumps.n_null_pivots();
    else if (mumps.n_null_pivots() > 0)
      throw_singular("MUMPS", what);
    return mumps.n_negative_pivots();
  }
} // namespace Squeal
