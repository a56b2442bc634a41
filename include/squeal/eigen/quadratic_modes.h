// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/factorization.h>

#include <complex>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace Squeal
{
  /// Q(λ) = λ² M + λ C + K with real n × n matrices, in general unsymmetric. The operators must outlive the pencil.
  struct QuadraticPencil
  {
    const LinearOperator *mass;      ///< M
    const LinearOperator *damping;   ///< C; null: no damping, which halves the work
    const LinearOperator *stiffness; ///< K
  };

  struct QuadraticModesOptions
  {
    double shift                      = 0.; ///< shift s ≥ 0 of the operator Q(s)⁻¹; s > 0 if K is singular [1/s]
    double largest_circular_frequency = 0.; ///< ω_max: requested λ are real or have 0 < Im λ ≤ ω_max [rad/s]

    /// d in the radius ρ = √(1 + d²) ω_max: the search covers |λ| ≤ ρ and therefore all λ of the band with |Re λ| ≤ d ω_max [-].
    double largest_damping = 0.1;

    double largest_decay = std::numeric_limits<double>::infinity(); ///< modes that decay faster, Re λ < −largest_decay, are omitted [1/s]

    double zero_modulus = 0.; ///< |λ| up to this limit counts as zero [rad/s]; 0: limit of 1e-4 ω_max

    int    expected  = 0;    ///< estimated number of modes, for example the number of real modes
    double tolerance = 1e-9; ///< largest ‖Q(λ)φ‖₂ / ‖Kφ‖₂ [-]

    /// A norm of K. Modes of very low frequency have a small ‖Kφ‖; their residual ‖Q(λ)φ‖ may be as large as the rounding errors, ten times
    /// the machine precision times this norm. 0: no such allowance.
    double stiffness_norm = 0.;
    double damping_norm   = 0.; ///< norm of C, for rounding errors of λCφ

    int block_size = 8; ///< vectors per block solve

    /// Approximate modes, for example modes without friction and damping: the process starts from random linear combinations of them. Null:
    /// none.
    const MultiVector *close_vectors = nullptr;

    /// Number of random vectors for the final search for missing eigenvalues, for example in clusters larger than the block; 0: none.
    int n_fresh_directions = 4;

    int          max_basis    = 0;  ///< largest number of basis vectors before a restart; 0: chosen from the number of modes
    int          max_restarts = 30; ///< maximum number of restarts; then a SolverError is thrown
    unsigned int seed         = 1;  ///< seed of the random first block

    std::function<void(const std::string &)> report; ///< called with the state of the iteration at every check; may be empty
  };

  /// Eigenpairs Q(λ) φ = 0 in a band, and their cost.
  struct QuadraticModes
  {
    std::vector<std::complex<double>> values; ///< requested λ with Im λ > 0 [rad/s], ascending by Im, then Re

    /// φ = real + i imaginary, n × k: ‖φ‖₂ = 1, the entry of largest modulus real and positive.
    std::shared_ptr<MultiVector> real_part, imaginary_part;

    std::vector<double> residuals; ///< ‖Q(λ)φ‖₂ / ‖Kφ‖₂, computed with the pencil itself

    /// Real λ ≠ 0 with |λ| ≤ ρ and λ ≥ −largest_decay (overdamped or divergent), ascending, without vectors.
    std::vector<double> real_values;

    /// Eigenvalues λ = 0 with their multiplicity: two for each rigid-body mode without damping.
    int n_zero_values = 0;

    double radius     = 0.; ///< limit of |λ - s| (no damping: of |λ² - s²|^½) for the search [rad/s]
    int    n_solves   = 0;  ///< number of vectors to which Q(s)⁻¹ was applied
    int    n_restarts = 0;
    int    n_basis    = 0; ///< largest number of vectors in the basis
  };

  /**
   * All eigenpairs of a large real quadratic pencil up to a frequency, by a
   * compact block Krylov–Schur process (CompactKrylov) for the inverse at a
   * real shift s. With damping, λ = s + θ and ν = 1/θ,
   *
   *     Q(s+θ) = θ² M + θ (C + 2 s M) + Q(s),
   *     ν [u; v] = [-Q(s)⁻¹ ((C + 2 s M) u + M v); u],   v = θ u,
   *
   * with θ measured in units of the radius, so that u and v are comparable at
   * the end of the band. Without damping, ν = 1/(λ² - s²) and
   * ν u = -Q(s)⁻¹ M u on vectors of length n: λ → -λ holds exactly.
   *
   * The iteration ends when all Ritz values inside the radius, and some outside, have converged. The residuals are then computed from the
   * pencil; if one exceeds the tolerance, the iteration continues. A short second process from random directions, in which the found values
   * are deflated, then searches for missing values; if it finds any, random directions are added to the block and the iteration continues.
   * This search is reliable for values well inside the radius. A missing member of a cluster at the very end of the band may remain
   * undetected; the block size should therefore be at least the size of clusters.
   *
   * @param inverse_at_shift Q(s)⁻¹ = (s² M + s C + K)⁻¹
   *
   * Throws SolverError with the number of converged values and the largest residual if max_restarts is not sufficient or if rounding errors
   * prevent residuals below the tolerance.
   */
  QuadraticModes quadratic_modes(const QuadraticPencil       &pencil,
                                 const LinearOperator        &inverse_at_shift,
                                 const QuadraticModesOptions &options);

  /// ‖Q(λ_j) φ_j‖₂ / ‖K φ_j‖₂ for each column of φ = real_part + i imaginary_part.
  std::vector<double> residuals(const QuadraticPencil                   &pencil,
                                const std::vector<std::complex<double>> &values,
                                const MultiVector                       &real_part,
                                const MultiVector                       &imaginary_part);

  /// Rotates each complex vector so that its entry of largest modulus is real and positive. If several moduli are equal up to rounding, the
  /// entry with the lowest row number is used.
  void fix_phase(MultiVector &real_part, MultiVector &imaginary_part);
} // namespace Squeal
