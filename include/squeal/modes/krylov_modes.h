#pragma once

#include <squeal/base/progress.h>
#include <squeal/modes/complex_modes.h>
#include <squeal/parameters/analysis.h>

namespace Squeal
{
  /**
   * Complex modes at full order by shift-invert block Krylov on the sparse
   * nonsymmetric quadratic pencil at friction coefficient @p mu: the reference.
   *
   * @param inverse    factor and attachment modes of the frictionless system at @p shift
   * @param n_expected real modes in the band, which tells how many to look for
   * @param real_modes these, from which the process then starts; null: none
   *
   * Where the stiffness with friction is almost singular without a shift, a factor with a shift is made for this μ.
   *
   * Throws SolverError if a mode misses the tolerance, or if there is modal damping and the shift is not zero.
   */
  ComplexModes krylov_modes(const CoupledSystem    &system,
                            UpdatedInverse         &inverse,
                            double                  shift,
                            double                  mu,
                            double                  largest_circular_frequency,
                            int                     n_expected,
                            const SolverParameters &parameters,
                            Progress               &progress,
                            const MultiVector      *real_modes = nullptr);
} // namespace Squeal
