#pragma once

#include <squeal/linear_algebra/factorization.h>
#include <squeal/linear_algebra/multigrid.h>

#include <memory>
#include <string>

namespace Squeal
{
  /// The inverse of a symmetric positive definite matrix by iteration, with what it took so far.
  class IterativeInverse : public Factorization
  {
  public:
    /// Steps of blocks of vectors, and vectors, since this was made.
    virtual long long n_steps() const   = 0;
    virtual long long n_vectors() const = 0;

    /// One cycle of multigrid by itself.
    virtual const LinearOperator &preconditioner() const = 0;
  };

  /**
   * A⁻¹ by the block conjugate gradient method with multigrid as preconditioner: memory grows like the entries of A, of which it keeps
   * a copy. Every solution has been checked by its true residual: ‖b − A x‖ ≤ 10⁻¹² ‖b‖ or what rounding in A x allows,
   * ε ‖A‖ ‖x‖. apply() throws SolverError naming @p what where that is not reached, as for a matrix that is not positive definite.
   */
  std::unique_ptr<IterativeInverse> iterative_inverse(const SparseMatrix &A, const NearNullSpace &space, const std::string &what);
} // namespace Squeal
