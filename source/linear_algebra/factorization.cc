#include "libraries.h"

#include <squeal/base/exceptions.h>

namespace Squeal
{
  namespace
  {
    void check_square(const SparseMatrix &A, const std::string &what)
    {
      if (!(A.columns() == A.rows()))
        throw SolverError("a matrix of " + std::to_string(A.n_rows()) + " rows and " + std::to_string(A.n_columns()) +
                            " columns, or with rows and columns distributed differently, cannot be factorised",
                          what, "this is a mistake in the program: please report it");
    }

    void check_one_process(const SparseMatrix &A, const FactorizationLibrary library, const std::string &what)
    {
      if (A.rows().n_processes() > 1)
        throw SolverError(to_string(library) + " was asked for on " + std::to_string(A.rows().n_processes()) +
                            " processes but works on one",
                          what, "choose MUMPS or automatic as factorisation library, or run on one process");
    }
  } // namespace

  void throw_not_positive_definite(const std::string &library, const std::string &what)
  {
    throw SolverError("the matrix is not positive definite to working precision (" + library + ")", what,
                      "check the boundary conditions: a body that can move rigidly has a singular stiffness");
  }

  void throw_singular(const std::string &library, const std::string &what)
  {
    throw SolverError("the matrix is singular to working precision (" + library + ")", what,
                      "check the boundary conditions, or move the shift away from an eigenvalue");
  }

  void throw_library_failure(const std::string &library, const std::string &failure, const std::string &what)
  {
    throw SolverError(library + " failed: " + failure, what,
                      "choose another factorisation library, a coarser mesh, or a machine with more memory");
  }

  std::unique_ptr<Factorization> factorize_positive_definite(const SparseMatrix        &A,
                                                             const FactorizationLibrary library,
                                                             const std::string         &what)
  {
    check_square(A, what);
    switch (library)
      {
        case FactorizationLibrary::automatic:
          if (A.rows().n_processes() == 1)
            return cholmod_factorization(A, what);
          return mumps_factorization(A, true, what);
        case FactorizationLibrary::cholmod:
          check_one_process(A, library, what);
          return cholmod_factorization(A, what);
        case FactorizationLibrary::umfpack:
          // LU factors serve as well but cannot tell whether the matrix is positive definite.
          check_one_process(A, library, what);
          if (count_negative_eigenvalues(A, what) > 0)
            throw_not_positive_definite("UMFPACK", what);
          return umfpack_factorization(A, what);
        case FactorizationLibrary::mumps:
          break;
      }
    return mumps_factorization(A, true, what);
  }

  std::unique_ptr<Factorization> factorize_general(const SparseMatrix &A, const FactorizationLibrary library, const std::string &what)
  {
    check_square(A, what);
    switch (library)
      {
        case FactorizationLibrary::automatic:
          if (A.rows().n_processes() == 1)
            return umfpack_factorization(A, what);
          break;
        case FactorizationLibrary::umfpack:
          check_one_process(A, library, what);
          return umfpack_factorization(A, what);
        case FactorizationLibrary::cholmod:
          throw SolverError(to_string(library) + " was asked for but serves positive definite matrices only", what,
                            "choose automatic, UMFPACK or MUMPS as factorisation library");
        case FactorizationLibrary::mumps:
          break;
      }
    return mumps_factorization(A, false, what);
  }
} // namespace Squeal
