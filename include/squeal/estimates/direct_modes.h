// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/judged_modes.h>

#include <string>

namespace Squeal
{
  /**
   * Complex modes of a system without a symmetric or definite part, with right vectors of Euclidean norm one: right and left block Krylov
   * at a real shift s with LU factors of Q(s).
   *
   * Condition number of an eigenvalue: κ = w ‖ψ‖ ‖φ‖ / (|λ| |ψᵀQ'(λ)φ|) of F. Tisseur, *Backward error and condition of polynomial
   * eigenvalue problems*, Linear Algebra and its Applications 309 (2000) 339–361, with ψ dual to all φ of the band,
   * ψ_iᵀ ((λ_i + λ_j) M + C) φ_j = δ_ij, w as in backward_errors(), and the relative error κ max(η, ε), of first order.
   *
   * @param value  of the varied parameter
   * @param source origin of the system, for messages: "file brake/system.json"
   *
   * Empty if no mode oscillates in the band.
   *
   * Throws SolverError if Q(s) is singular to working precision, or if the numbers of right and left eigenvalues differ.
   */
  JudgedModes direct_modes(const CoupledSystem    &system,
                           double                  value,
                           const Band             &band,
                           const SolverParameters &solvers,
                           const std::string      &source,
                           Progress               &progress);

  /// ω_max² MᵀM at a value of the varied parameter: an inner product for bases of such systems, which ignores massless dofs and forces of
  /// constraints; combinations of modes that consist of these only make a projection singular.
  std::shared_ptr<const SparseMatrix> inertia_square(const CoupledSystem &system, double value, double omega_max);
} // namespace Squeal
