// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/eigen/symmetric_modes.h>
#include <squeal/linear_algebra/dense.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <memory>
#include <optional>
#include <vector>

namespace Squeal
{
  /// Systems up to this size are solved densely.
  constexpr int largest_dense_system = 300;

  /// Solves one symmetric eigenproblem, step by step: counts when it is made, then finds, refines and accepts modes.
  class SymmetricSolver
  {
  public:
    /// K, M, and what the options point to must outlive it.
    SymmetricSolver(const SparseMatrix &K, const SparseMatrix &M, double limit, const SymmetricModesOptions &options);

    /// Whether all modes, not those of the band alone, are found, by a dense eigenvalue problem.
    bool is_dense() const;

    /// The dense eigenvalue problem of a process that is alone, ahead of modes(); others may be solved on other threads meanwhile.
    void solve_densely();

    SymmetricModes modes();

  private:
    /// Rayleigh-Ritz approximations in a space, ascending.
    struct RitzPairs
    {
      std::vector<double>        values;
      std::optional<MultiVector> vectors;
    };

    /// Residuals of Ritz pairs, and how they compare with what is accepted.
    struct Residuals
    {
      std::vector<double> values;      ///< as SymmetricModes defines them
      double              excess = 0.; ///< largest ratio of a residual to what is accepted
      int                 worst  = 0;  ///< the mode where it occurs
    };

    RitzPairs rayleigh_ritz(const MultiVector &V) const;

    /// A space that contains approximations of all wanted modes.
    RitzPairs find_all();

    RitzPairs                  dense();
    std::optional<MultiVector> krylov(int n_wanted, unsigned int attempt, int n_fruitless, const std::optional<MultiVector> &deflated);

    /// Puts fresh vectors to the pairs where modes in the band come with them; how many are in the band then.
    int merge(const MultiVector &fresh, RitzPairs &pairs) const;

    /// Where a mode lies on the limit to rounding, count and search may see it on different sides: counts again a little higher. Whether it
    /// did.
    bool lift_limit();

    const LinearOperator &inverse();

    /// Inverse iteration, block-wise, until the residuals are accepted.
    Residuals refine(RitzPairs &pairs);

    Residuals      residuals(const RitzPairs &pairs) const;
    SymmetricModes accept(const RitzPairs &pairs, const Residuals &result) const;

    [[noreturn]] void fail_incomplete(int n_found) const;

    bool is_rigid(double value) const;

    const SparseMatrix            &K, &M;
    SymmetricModesOptions          options;
    double                         shift; ///< s in K + s M, of the factor that is made here [rad²/s²]
    ModeCount                      count;
    const double                   hidden_square; ///< eigenvalues up to this are zero: rounding errors of K
    bool                           lifted = false;
    std::unique_ptr<Factorization> factorization;
    std::optional<RealPairs>       dense_pairs;
  };
} // namespace Squeal
