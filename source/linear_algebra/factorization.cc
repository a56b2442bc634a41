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
                            " columns cannot be factorised: it is not square, or its rows and columns are distributed differently",
                          what, "this is an error in the program: please report it");
    }
  } // namespace

  void throw_not_positive_definite(const std::string &library, const std::string &what)
  {
    throw SolverError("the matrix is not positive definite to working precision (" + library + ")", what,
                      "check the boundary conditions (a body that can move freely has a singular stiffness) and the materials or matrices");
  }

  void throw_singular(const std::string &library, const std::string &what)
  {
    throw SolverError("the matrix is singular to working precision (" + library + ")", what,
                      "check the boundary conditions, or change Band/Maximum frequency to move the shift away from an eigenvalue");
  }

  void throw_library_failure(const std::string &library, const std::string &failure, const std::string &what)
  {
    throw SolverError(library + " failed: " + failure, what,
                      "use a coarser mesh or a machine with more memory; for a positive definite matrix, try another "
                      "Linear algebra/Factorization");
  }

  std::unique_ptr<Factorization> factorize_positive_definite(const SparseMatrix        &A,
                                                             const FactorizationLibrary library,
                                                             const std::string         &what)
  {
    check_square(A, what);
    const int n_processes = A.rows().n_processes();
    if (library == FactorizationLibrary::cholmod && n_processes > 1)
      throw SolverError("CHOLMOD was requested on " + std::to_string(n_processes) + " processes, but runs on one process only", what,
                        "set Linear algebra/Factorization = MUMPS or automatic, or run on one process");
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
