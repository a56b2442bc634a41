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

  /// Solves one symmetric eigenproblem: counts the modes on construction, then finds, refines and checks them.
  class SymmetricSolver
  {
  public:
    /// K, M, and objects in the options must outlive the solver.
    SymmetricSolver(const SparseMatrix &K, const SparseMatrix &M, double limit, const SymmetricModesOptions &options);

    /// True if the system is small and all its modes are computed by a dense eigensolver.
    bool is_dense() const;

    /// Solves the dense eigenproblem on a single process in advance of modes(); several solvers may do this concurrently.
    void solve_densely();

    SymmetricModes modes();

  private:
    /// Rayleigh-Ritz approximations of modes, ascending.
    struct RitzPairs
    {
      std::vector<double>        values;
      std::optional<MultiVector> vectors;
    };

    /// Residuals of Ritz pairs relative to their limits.
    struct Residuals
    {
      std::vector<double> values;      ///< see SymmetricModes::residuals
      double              excess = 0.; ///< largest ratio of a residual to its limit
      int                 worst  = 0;  ///< index of the mode with this ratio
    };

    RitzPairs rayleigh_ritz(const MultiVector &V) const;

    RitzPairs find_all();

    RitzPairs                  dense();
    std::optional<MultiVector> krylov(int n_wanted, unsigned int attempt, int n_fruitless, const std::optional<MultiVector> &deflated);

    /// Adds new vectors to the pairs if they contain new modes in the band; returns the number of modes in the band.
    int merge(const MultiVector &fresh, RitzPairs &pairs) const;

    /// Counts again at a slightly higher limit if a mode coincides with the limit up to rounding, because count and search may treat this
    /// mode differently. Returns true if the limit was raised.
    bool lift_limit();

    const LinearOperator &inverse();

    /// Performs at most three steps of block inverse iteration, until the residuals meet their limits.
    Residuals refine(RitzPairs &pairs);

    Residuals      residuals(const RitzPairs &pairs) const;
    SymmetricModes accept(const RitzPairs &pairs, const Residuals &result) const;

    [[noreturn]] void fail_incomplete(int n_found) const;

    bool is_rigid(double value) const;

    const SparseMatrix            &K, &M;
    SymmetricModesOptions          options;
    double                         shift; ///< s in K + s M, which this object factorises [rad²/s²]
    ModeCount                      count;
    const double                   hidden_square; ///< eigenvalues up to this limit count as zero: rounding errors of K
    bool                           lifted = false;
    std::unique_ptr<Factorization> factorization;
    std::optional<RealPairs>       dense_pairs;
  };
} // namespace Squeal
