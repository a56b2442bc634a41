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
  /// Number of eigenvalues of K φ = ω² M φ below a limit.
  struct ModeCount
  {
    int    n_modes;
    double limit; ///< the requested limit, or slightly higher if an eigenvalue coincides with the requested limit [rad²/s²]
  };

  struct SymmetricModesOptions
  {
    RealSolver solver = RealSolver::lanczos;

    /// Largest residual of a mode [-]; see SymmetricModes::residuals.
    double tolerance = 1e-10;

    /// Vectors per step of the block solvers; 0: chosen automatically.
    int block_size = 0;

    /// s ≥ 0 in K + s M, which is factorised [rad²/s²]. 0: K itself or, if K is almost singular or not positive definite, K + s M with s =
    /// end of the band / 100. For bodies with rigid-body motions, a shift avoids a factorisation of K that fails.
    double shift = 0.;

    /// (K + s M)⁻¹ for this shift, if available; null: K + s M is factorised.
    const LinearOperator *inverse = nullptr;

    /// Result of count_below(), if available; must be empty with by_parts.
    std::optional<ModeCount> count;

    /// True if K and M consist of many uncoupled blocks, for example of pins, which are then solved individually; inverse must be null.
    bool by_parts = false;

    FactorizationLibrary library = FactorizationLibrary::automatic;

    /// Seed of the random start vectors; it affects results only by rounding errors.
    unsigned int seed = 1;

    /// Name of the eigenproblem, for error messages.
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

    /// Number of rigid-body motions: eigenvalues that are zero up to rounding errors of K (unresolved_square()).
    int n_rigid_body = 0;

    /// Number of modes in the band by Sylvester's law of inertia; equals the number found.
    int n_counted = 0;
  };

  /**
   * All modes with 0 ≤ ω² ≤ @p largest_eigenvalue [rad²/s²] of K φ = ω² M φ,
   * K symmetric positive semidefinite, M symmetric positive definite.
   *
   * The inertia of K - limit M gives the number of modes. Small problems are solved densely. Otherwise the modes are computed by block
   * Lanczos, block Krylov-Schur (Anasazi) or implicitly restarted Lanczos (ARPACK) for (K + s M)⁻¹ M, followed by a Rayleigh-Ritz
   * projection. If members of multiple eigenvalues are missing, the solver is restarted orthogonally to the modes found.
   *
   * Throws SolverError if modes are missing, or if a residual exceeds both the tolerance and the rounding errors in K φ, 10 ε ‖K‖ ‖φ‖ /
   * ‖Kφ‖; the limit for rigid-body modes is 1e-8. An eigenvalue that equals the limit up to rounding is included.
   */
  SymmetricModes symmetric_modes(const SparseMatrix          &K,
                                 const SparseMatrix          &M,
                                 double                       largest_eigenvalue,
                                 const SymmetricModesOptions &options = {});

  /// Number of eigenvalues ω² ≤ @p limit of K φ = ω² M φ from the inertia of K - limit M: includes multiplicities and rigid-body modes and
  /// does not compute modes. Throws a SolverError that names @p what if K - limit M remains singular.
  ModeCount count_below(const SparseMatrix &K, const SparseMatrix &M, double limit, const std::string &what);

  /**
   * Upper end of a band [rad²/s²] that contains the @p n_modes lowest modes, by inertia counts. The band may contain further modes if their
   * ω² is less than 0.1 % above the highest of these ω², for example members of a multiple eigenvalue.
   *
   * @param first   start of the search [rad²/s²]
   * @param highest limit of the search [rad²/s²]
   *
   * Throws a SolverError that names @p what if fewer than @p n_modes modes lie below @p highest.
   */
  double end_of_lowest(const SparseMatrix &K, const SparseMatrix &M, int n_modes, double first, double highest, const std::string &what);
} // namespace Squeal
