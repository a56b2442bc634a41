// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/judged_modes.h>

#include <string>

namespace Squeal
{
  /**
   * Complex modes of a system without a symmetric or definite part, by right and left block Krylov methods at a real shift s with LU
   * factors of Q(s). The right vectors have Euclidean norm one.
   *
   * The condition number of an eigenvalue is κ = w ‖ψ‖ ‖φ‖ / (|λ| |ψᵀQ'(λ)φ|) (F. Tisseur, *Backward error and condition of polynomial
   * eigenvalue problems*, Linear Algebra and its Applications 309 (2000) 339–361), with w as in backward_errors() and ψ dual to all φ of
   * the band, ψ_iᵀ ((λ_i + λ_j) M + C) φ_j = δ_ij. The first-order relative error is κ max(η, ε).
   *
   * @param value  value of the varied parameter
   * @param source origin of the system, for messages: "file brake/system.json"
   *
   * If no mode oscillates in the band, the result contains only real eigenvalues.
   *
   * Throws SolverError if Q(s) is singular to working precision, or if the numbers of right and left eigenvalues differ.
   */
  JudgedModes direct_modes(const CoupledSystem    &system,
                           double                  value,
                           const Band             &band,
                           const SolverParameters &solvers,
                           const std::string      &source,
                           Progress               &progress);

  /// ω_max² MᵀM at a value of the varied parameter: an inner product for bases of systems without a definite part. It ignores massless dofs
  /// and constraint forces, because vectors that contain only these would make a projection singular.
  std::shared_ptr<const SparseMatrix> inertia_square(const CoupledSystem &system, double value, double omega_max);
} // namespace Squeal
