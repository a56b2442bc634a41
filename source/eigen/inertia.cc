#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/eigen/symmetric_modes.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    /// Eigenvalues closer than this part of them are not told apart by counting [-].
    constexpr double cluster_width = 1e-3;
  } // namespace

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

  double end_of_lowest(const SparseMatrix &K,
                       const SparseMatrix &M,
                       const int           n_modes,
                       const double        first,
                       const double        highest,
                       const std::string  &what)
  {
    // A bracket: fewer modes lie below its lower end, enough below its upper one
    ModeCount lower = {0, 0.}, upper = count_below(K, M, std::min(first, highest), what);
    while (upper.n_modes < n_modes)
      {
        if (!(upper.limit < highest))
          throw SolverError(what + ": fewer than " + std::to_string(n_modes) + " lie below " +
                              std::to_string(std::lround(hertz(std::sqrt(highest)))) + " Hz",
                            what, "lower the number of modes");
        lower = upper;
        upper = count_below(K, M, std::min(2. * upper.limit, highest), what);
      }

    // Modes are spread about evenly, so that a straight line leads into the gap; half a mode off either end at least
    while (upper.n_modes > n_modes && upper.limit - lower.limit > cluster_width * upper.limit)
      {
        const double    share                      = (n_modes + 0.5 - lower.n_modes) / (upper.n_modes - lower.n_modes);
        const double    trial                      = lower.limit + std::min(std::max(share, 0.1), 0.9) * (upper.limit - lower.limit);
        const ModeCount middle                     = count_below(K, M, trial, what);
        (middle.n_modes < n_modes ? lower : upper) = middle;
      }
    return upper.limit;
  }
} // namespace Squeal
