// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/conditioning.h>
#include <squeal/modes/system_modes.h>
#include <squeal/modes/complex_modes.h>

#include <complex>
#include <vector>

namespace Squeal
{
  /// Complex modes at one friction coefficient and which of them grow.
  struct JudgedModes
  {
    ComplexModes         modes;
    std::vector<Verdict> verdicts; ///< with the uncertainty of λ
    std::vector<bool>    unstable; ///< beyond their uncertainty
    Conditioning         conditioning;
    int n_slow = 0; ///< pairs of λ that count as zero but belong to no rigid body, such as slow decay against strong dampers

    std::size_t n_unstable() const;

    /// Modes of this verdict.
    std::size_t n_of(Verdict verdict) const;

    /// Real eigenvalues λ > 0: static divergence.
    std::size_t n_growing_real() const;
  };

  /// |λ|² up to this many times what rounding hides: a slow mode, whose digits cancellation takes [-].
  inline constexpr double slow_square = 1e4;

  bool is_slow(const CoupledSystem &system, const std::complex<double> &lambda);

  /// Largest error of the modes that are not slow.
  double largest_error(const CoupledSystem &system, const ComplexModes &modes, const Conditioning &conditioning);

  /// Relative errors of λ by which growth is judged. The largest of all counts for every mode, since that of a single one may be much too
  /// small by chance; but a slow mode, of which cancellation in the stiffness takes many digits, has its own.
  std::vector<double> uncertainties(const CoupledSystem &system, const ComplexModes &modes, const Conditioning &conditioning);

  /// Decides which of @p modes grow, each by its own error in @p conditioning.
  JudgedModes judged_by_errors(ComplexModes modes, Conditioning conditioning, bool has_damping);

  /// Decides which of @p modes grow, however they were found.
  JudgedModes judged_modes(const CoupledSystem &system, const SystemModes &frictionless, ComplexModes modes);

  /// Complex modes of the system, those that the band lists, by the solver that the parameters choose. Throws SolverError if none
  /// oscillates there.
  JudgedModes modes_with_friction(const CoupledSystem    &system,
                                  const SystemModes      &frictionless,
                                  double                  mu,
                                  const Band             &band,
                                  const SolverParameters &solvers,
                                  Progress               &progress);
} // namespace Squeal
