#pragma once

#include "shift_invert.h"

namespace Squeal
{
  /// What is asked of a solver that improves a space by preconditioned residuals.
  struct PreconditionedRequest
  {
    int          n_wanted;
    double       tolerance; ///< on ‖Kφ - ω²Mφ‖ / ‖Kφ‖ [-]
    double       limit;     ///< pairs above are only found roughly [rad²/s²]
    unsigned int seed;
    std::string  what;
  };

  /**
   * Approximate eigenvectors of the lowest eigenvalues of K φ = ω² M φ, M-orthogonal to @p deflated (M-orthonormal; may be null),
   * lowest first: those of n_wanted that converged, nothing if none did.
   *
   * LOBPCG (A. Knyazev, 2001): a Rayleigh-Ritz procedure in the space of current Ritz vectors, preconditioned residuals and Ritz vectors
   * of the step before. Residuals of the lowest unfinished vectors are added, some at a time, to an orthonormal basis that grows until it is
   * full and then restarts from these (thick restart with the locally optimal directions; A. Stathopoulos, 2007).
   */
  std::optional<MultiVector> lobpcg_vectors(const SparseMatrix          &K,
                                            const SparseMatrix          &M,
                                            const LinearOperator        &preconditioner,
                                            const MultiVector           *deflated,
                                            const PreconditionedRequest &request);
} // namespace Squeal
