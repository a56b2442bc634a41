#pragma once

#include <squeal/eigen/quadratic_modes.h>

namespace Squeal
{
  /**
   * Some steps of minimal residuals with Q(s)⁻¹ for the modes that miss the tolerance: a
   * mode far below the others keeps rounding errors of high frequency, and one
   * with strong dampers keeps motions of these, small
   * in φ but large in Kφ or Cφ, where Q(s)⁻¹ nearly inverts Q(λ) but for a factor.
   * What does not lower the residual is not taken.
   */
  void correct(const QuadraticPencil &pencil, const LinearOperator &inverse, QuadraticModes &modes, double tolerance);

  /// Largest ratio of a residual to what is accepted: the tolerance or, where that is more, rounding errors of Kφ and λCφ.
  double excess(const QuadraticPencil &pencil, const QuadraticModes &modes, const QuadraticModesOptions &options);
} // namespace Squeal
