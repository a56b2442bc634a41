#pragma once

#include <squeal/eigen/quadratic_modes.h>

namespace Squeal
{
  /**
   * One step φ ← φ - Q(s)⁻¹ Q(λ) φ for the modes that miss the tolerance: a
   * mode far below the others keeps rounding errors of high frequency, small
   * in φ but large in Kφ, where Q(s)⁻¹ nearly inverts Q(λ). A step that does
   * not lower the residual is not taken.
   */
  void correct(const QuadraticPencil &pencil, const LinearOperator &inverse, QuadraticModes &modes, double tolerance);

  /// Largest ratio of a residual to what is accepted: the tolerance or, where that is more, rounding errors of Kφ.
  double excess(const QuadraticPencil &pencil, const QuadraticModes &modes, const QuadraticModesOptions &options);
} // namespace Squeal
