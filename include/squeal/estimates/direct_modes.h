#pragma once

#include <squeal/estimates/judged_modes.h>

#include <optional>

namespace Squeal
{
  /// Complex modes of a system no part of which need be symmetric or definite, with vectors of Euclidean norm one.
  struct DirectModes : JudgedModes
  {
    std::vector<double> backward_errors; ///< η = ‖Q(λ)φ‖ / (w ‖φ‖),  w = |λ|² ‖M‖ + |λ| ‖C‖ + ‖K‖ [-]
    std::optional<int>  n_counted;       ///< by the argument principle in the rectangle of ContourOptions; nothing on several processes
  };

  /**
   * Modes by block Krylov at a real shift s, with LU factors of Q(s), right and left; their number by the argument principle.
   *
   * The eigenvalue has the condition number κ = w ‖ψ‖ ‖φ‖ / (|λ| |ψᵀQ'(λ)φ|) of F. Tisseur, *Backward error and condition of polynomial
   * eigenvalue problems*, Linear Algebra and its Applications 309 (2000) 339–361, with ψ dual to all φ of the band,
   * ψ_iᵀ ((λ_i + λ_j) M + C) φ_j = δ_ij, and the relative error κ max(η, ε), of first order.
   *
   * @param value of the varied parameter
   *
   * Throws SolverError if Q(s) is singular to working precision, if right and left eigenvalues differ in number, or if the count
   * does not agree with the modes found.
   */
  DirectModes direct_modes(const CoupledSystem    &system,
                           double                  value,
                           double                  largest_circular_frequency,
                           const SolverParameters &solvers,
                           Progress               &progress);
} // namespace Squeal
