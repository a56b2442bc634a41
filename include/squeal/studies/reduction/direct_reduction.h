// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/studies/reduction/reduction_tables.h>
#include <squeal/studies/steps/imported_modes.h>

namespace Squeal
{
  /**
   * POD of a system without a definite part: a Galerkin projection on principal axes of right and left modes at the snapshots of the plan,
   * compared with the modes at full order. A step of the run.
   *
   * Uses the inner product of inertia_square(). Errors of λ are estimated with the inverse of Q(s) at a real shift s instead of K_c⁻¹, and
   * ε_res is the backward error.
   */
  MeasuredBasis direct_pod(const GivenSystem &given, const ReductionPlan &plan, const ComplexModes &reference, Run &run);
} // namespace Squeal
