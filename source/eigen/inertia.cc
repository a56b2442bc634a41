#include "shift_invert.h"

#include <squeal/base/exceptions.h>
#include <squeal/eigen/symmetric_modes.h>
#include <squeal/linear_algebra/sparse_matrix.h>

namespace Squeal
{
  ModeCount count_below(const SparseMatrix &K, const SparseMatrix &M, double limit, const std::string &what)
  {
    // A pivot vanishes where the limit is an eigenvalue: step over it.
    for (int attempt = 0; attempt < 4; ++attempt)
      {
        int       n_null  = 0;
        const int n_modes = count_negative_eigenvalues(*add(1., K, -limit, M), what, &n_null);
        if (n_null == 0)
          return {n_modes, limit};
        limit *= 1. + 1e-8;
      }
    throw SolverError("the modes below " + std::to_string(limit) + " rad²/s² cannot be counted: K - limit M stays singular", what,
                      "check that M is positive definite and that no dof is without stiffness and mass");
  }

  int count_modes(const SparseMatrix &K, const SparseMatrix &M, const double largest_eigenvalue, const std::string &what)
  {
    return count_below(K, M, largest_eigenvalue, what).n_modes;
  }
} // namespace Squeal
