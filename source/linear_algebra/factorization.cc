// SPDX-License-Identifier: GPL-3.0-or-later

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
                          what, "this is an error in the program: please report it");
    }
  } // namespace

  void throw_not_positive_definite(const std::string &library, const std::string &what)
  {
    throw SolverError("the matrix is not positive definite to working precision (" + library + ")", what,
                      "check the boundary conditions: a body with rigid-body motions has a singular stiffness");
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
    const int n_processes = A.rows().n_processes();
    if (library == FactorizationLibrary::cholmod && n_processes > 1)
      throw SolverError("CHOLMOD was requested on " + std::to_string(n_processes) + " processes, but runs on one only", what,
                        "choose MUMPS or automatic as factorisation library, or run on one process");
    if (library == FactorizationLibrary::mumps || n_processes > 1)
      return mumps_factorization(A, true, what);
    return cholmod_factorization(A, what);
  }

  std::unique_ptr<Factorization> factorize_general(const SparseMatrix &A, const std::string &what)
  {
    check_square(A, what);
    return mumps_factorization(A, false, what);
  }
} // namespace Squeal
