// SPDX-License-Identifier: GPL-3.0-or-later

#include "libraries.h"

#include <squeal/linear_algebra/row_map.h>
#include <squeal/linear_algebra/blas_threads.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <dmumps_c.h>
#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace Squeal
{
  namespace
  {
    /// Number of right-hand sides per solve, which limits the memory of MUMPS and the solutions.
    constexpr int block_size = 64;

    enum class MatrixKind
    {
      general           = 0,
      positive_definite = 1,
      symmetric         = 2
    };

    /// Selects whether factors are stored; without them, MUMPS uses much less memory.
    enum class Factors
    {
      kept,
      counted ///< only numbers and signs of pivots are determined
    };

    /// A MUMPS instance with the factors of one matrix.
    class Mumps
    {
    public:
      Mumps(const SparseMatrix &A, const MatrixKind symmetry, const Factors factors, const std::string &what)
        : what(what)
        , map(A.rows())
        , own_rows(A.rows().n_local())
      {
        id.sym          = static_cast<int>(symmetry);
        id.par          = 1;
        id.comm_fortran = MPI_Comm_c2f(map.communicator());
        run(-1);
        try
          {
            factorize(local_rows(A), symmetry != MatrixKind::general, factors);
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
        // MUMPS reports large numbers as negative millions
        return id.infog[28] >= 0 ? id.infog[28] : -1e6 * id.infog[28];
      }

      /// Each process passes its rows of X and receives its rows of Y.
      void solve(const bool transpose, const MultiVector &X, MultiVector &Y)
      {
        for (int first = 0; first < X.n_columns(); first += block_size)
          {
            const int n_columns = std::min(block_size, X.n_columns() - first);
            // MUMPS distributes the rows of the solution like the pivots
            solution.resize(n_solved() * static_cast<std::size_t>(n_columns));
            solved_rows.resize(n_solved());
            id.nrhs      = n_columns;
            id.icntl[8]  = transpose ? 0 : 1;
            id.icntl[19] = 10; // right-hand sides are distributed by rows
            id.nloc_rhs  = static_cast<int>(own_rows.size());
            id.lrhs_loc  = std::max(1, id.nloc_rhs);
            id.irhs_loc  = address(own_rows);
            id.rhs_loc   = id.nloc_rhs > 0 ? const_cast<double *>(X.col(first).data()) : &nothing; // MUMPS does not change it
            id.icntl[20] = 1;                                                                      // solutions are distributed by rows
            id.lsol_loc  = std::max(1, n_solved());
            id.isol_loc  = address(solved_rows);
            id.sol_loc   = solution.empty() ? &nothing : solution.data();
            id.icntl[26] = 32; // number of columns per block in the solution phase
            run(3);
            check("solution");
            for (int &number : solved_rows)
              --number;
            RowDelivery(solved_rows, map)
              .deliver(MultiVector::ConstLocal(solution.data(), n_solved(), n_columns), Y.local().middleCols(first, n_columns));
          }
      }

    private:
      void factorize(const SparseRows &rows, const bool one_triangle, const Factors factors)
      {
        for (int output : {0, 1, 2})
          id.icntl[output] = -1;
        id.icntl[3]  = 0;
        id.icntl[17] = 3;     // matrix entries are distributed
        id.icntl[12] = 1;     // no dense parallel root, which would hide signs of pivots
        id.icntl[23] = 1;     // report null pivots instead of dividing by them
        id.cntl[2]   = 1e-14; // threshold of null pivots, relative to the scaled matrix
        id.icntl[10] = 0;
        id.icntl[30] = factors == Factors::kept ? 0 : 1;

        std::vector<int>    row, column;
        std::vector<double> value;
        // MUMPS requires valid pointers on processes without rows
        row.reserve(1);
        column.reserve(1);
        value.reserve(1);
        std::iota(own_rows.begin(), own_rows.end(), map.first() + 1);
        for (int i = 0; i < rows.rows(); ++i)
          for (SparseRows::InnerIterator entry(rows, i); entry; ++entry)
            if (!one_triangle || entry.col() <= map.number(i))
              {
                row.push_back(map.number(i) + 1);
                column.push_back(entry.col() + 1);
                value.push_back(entry.value());
              }
        id.n       = map.n();
        id.nnz_loc = value.size();
        id.irn_loc = row.data();
        id.jcn_loc = column.data();
        id.a_loc   = value.data();

        run(1);
        check("analysis");
        // Pivoting may need more memory than the analysis has estimated: increase the memory and try again
        for (int attempt = 0; attempt < 6; ++attempt)
          {
            const ThreadsOfFactorization threads(id.n);
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

      int n_solved() const
      {
        return id.info[22];
      }

      /// Address of the first number for MUMPS, which requires a valid pointer even if there are no numbers.
      static int *address(std::vector<int> &numbers)
      {
        numbers.reserve(1);
        return numbers.data();
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
      const RowMap        map;
      std::vector<int>    own_rows, solved_rows; ///< row numbers, which start at 1
      std::vector<double> solution;              ///< solution, n_solved() × columns of a block
      double              nothing = 0.;          ///< target of pointers on processes without rows
      DMUMPS_STRUC_C      id      = {};
    };

    class MumpsFactorization : public Factorization
    {
    public:
      MumpsFactorization(const SparseMatrix &A, const MatrixKind symmetry, const std::string &what)
        : row_map(A.rows())
        , mumps(std::make_unique<Mumps>(A, symmetry, Factors::kept, what))
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
    const Mumps mumps(A, MatrixKind::symmetric, Factors::counted, what);
    if (n_null != nullptr)
      *n_null = mumps.n_null_pivots();
    else if (mumps.n_null_pivots() > 0)
      throw_singular("MUMPS", what);
    return mumps.n_negative_pivots();
  }
} // namespace Squeal
