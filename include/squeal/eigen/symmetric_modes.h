// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/choices.h>
#include <squeal/linear_algebra/factorization.h>
#include <squeal/linear_algebra/multivector.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// A limit and the number of eigenvalues of K φ = ω² M φ below it.
  struct ModeCount
  {
    int    n_modes;
    double limit; ///< at or, where an eigenvalue lies on it, slightly above what was asked for [rad²/s²]
  };

  /// How the modes of K φ = ω² M φ are computed.
  struct SymmetricModesOptions
  {
    RealSolver solver = RealSolver::lanczos;

    /// Largest residual of a mode [-]; see SymmetricModes::residuals.
    double tolerance = 1e-10;

    /// Vectors per step of the block solvers; 0: chosen.
    int block_size = 0;

    /// s ≥ 0 in K + s M, which is factorised [rad²/s²]. 0: K itself or, where that is not positive definite or almost singular, s = largest
    /// eigenvalue / 100. Giving a shift avoids an attempt that fails for bodies that can move rigidly.
    double shift = 0.;

    /// (K + s M)⁻¹ for that shift where the caller has it already; null: it is factorised here.
    const LinearOperator *inverse = nullptr;

    /// The count of the modes below the limit where the caller has it already, by count_below(); without by_parts.
    std::optional<ModeCount> count;

    /// K and M fall into many uncoupled parts, such as pins, each of which is solved alone; without inverse.
    bool by_parts = false;

    FactorizationLibrary library = FactorizationLibrary::automatic;

    /// Seed of the random start vectors; results do not depend on it but for rounding.
    unsigned int seed = 1;

    /// Whose modes these are, for error messages.
    std::string what = "a symmetric eigenvalue problem";
  };

  /// Modes of K φ = ω² M φ, lowest first.
  struct SymmetricModes
  {
    /// ω² [rad²/s²], ascending; exactly zero for rigid-body modes.
    std::vector<double> eigenvalues;

    /// Φ with ΦᵀMΦ = I, one column per eigenvalue; null if there is none.
    std::shared_ptr<MultiVector> vectors;

    /// ‖Kφ - ω²Mφ‖ / ‖Kφ‖ [-]; for rigid-body modes ‖Kφ‖ / (largest eigenvalue · ‖Mφ‖).
    std::vector<double> residuals;

    /// Eigenvalues that rounding errors of K hide (unresolved_square()), whatever the band: those of rigid-body motions.
    int n_rigid_body = 0;

    /// Modes that exist in the band, by Sylvester's law of inertia; equals the number found.
    int n_counted = 0;
  };

  /**
   * All modes with 0 ≤ ω² ≤ @p largest_eigenvalue [rad²/s²] of K φ = ω² M φ,
   * K symmetric positive semidefinite, M symmetric positive definite.
   *
   * The inertia of K - limit M tells how many there are. They are computed by
   * shift-invert (K + s M)⁻¹ M, block Lanczos, block Krylov-Schur (Anasazi) or
   * implicitly restarted Lanczos (ARPACK), then by a Rayleigh-Ritz procedure in
   * the space found. Where members of multiple eigenvalues are missing, the solver is
   * started again, orthogonally to what was found.
   *
   * Throws SolverError if fewer modes are found than exist, or if the residual
   * of one exceeds both the tolerance and what rounding in K φ allows,
   * 10 ε ‖K‖ ‖φ‖ / ‖Kφ‖; that of a rigid-body mode may reach 1e-8. An eigenvalue that equals the limit to rounding is
   * included.
   */
  SymmetricModes symmetric_modes(const SparseMatrix          &K,
                                 const SparseMatrix          &M,
                                 double                       largest_eigenvalue,
                                 const SymmetricModesOptions &options = {});

  /// Number of eigenvalues ω² ≤ @p limit of K φ = ω² M φ by the inertia of K - limit M: exact, multiplicities and rigid-body modes
  /// included, without computing any mode. Throws SolverError naming @p what.
  ModeCount count_below(const SparseMatrix &K, const SparseMatrix &M, double limit, const std::string &what);

  /**
   * An end of the band [rad²/s²] below which the @p n_modes lowest modes lie and no other, found by inertia alone. Others that are
   * closer to the last of them than 10⁻³ of its ω², as members of a multiple eigenvalue are, may lie below it, too.
   *
   * @param first   where the search begins [rad²/s²]
   * @param highest where it is given up [rad²/s²]
   *
   * Throws SolverError naming @p what if there are fewer modes below @p highest.
   */
  double end_of_lowest(const SparseMatrix &K, const SparseMatrix &M, int n_modes, double first, double highest, const std::string &what);
} // namespace Squeal
