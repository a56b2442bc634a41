// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/choices.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <memory>
#include <string>

namespace Squeal
{
  /// Inverse of a sparse matrix by a direct factorisation.
  class Factorization : public LinearOperator
  {
  public:
    /// Y = A⁻ᵀ X.
    virtual void apply_transpose(const MultiVector &X, MultiVector &Y) const = 0;

    /// Y = Pᵀ L⁻ᵀ X from factors A = Pᵀ L Lᵀ P: if the entries of X are independent random numbers of unit variance, the columns of Y have
    /// the covariance A⁻¹. Returns false if the library does not support this.
    virtual bool half_solve(const MultiVector &, MultiVector &) const
    {
      return false;
    }

    /// Number of entries of the factors; 0 if the library does not report it.
    virtual double n_factor_entries() const = 0;
  };

  /**
   * Cholesky (CHOLMOD) or LDLᵀ (MUMPS) factors of a symmetric positive definite matrix; only one triangle is read. Throws a SolverError
   * that names @p what if the matrix is not positive definite to working precision (a pivot is negative, or only a rounding error of the
   * diagonal entry) or if the library cannot be used.
   */
  std::unique_ptr<Factorization> factorize_positive_definite(const SparseMatrix &A, FactorizationLibrary library, const std::string &what);

  /// LU factors of a square nonsymmetric matrix (MUMPS). Throws a SolverError that names @p what if the matrix is singular to working
  /// precision.
  std::unique_ptr<Factorization> factorize_general(const SparseMatrix &A, const std::string &what);

  /**
   * Number of negative eigenvalues of a symmetric matrix by Sylvester's law of inertia: the number of negative pivots of LDLᵀ with 2 × 2
   * pivoting (MUMPS). @p n_null receives the number of pivots that vanish to working precision; if it is null, such pivots cause a
   * SolverError that names @p what.
   */
  int count_negative_eigenvalues(const SparseMatrix &A, const std::string &what, int *n_null = nullptr);
} // namespace Squeal
