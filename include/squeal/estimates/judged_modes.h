// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/conditioning.h>
#include <squeal/modes/system_modes.h>
#include <squeal/modes/complex_modes.h>

#include <complex>
#include <vector>

namespace Squeal
{
  /// Complex modes at one friction coefficient with their verdicts.
  struct JudgedModes
  {
    ComplexModes         modes;
    std::vector<Verdict> verdicts; ///< verdict on each mode, allowing for the uncertainty of λ
    std::vector<bool>    unstable; ///< true if the growth of the mode exceeds the uncertainty
    Conditioning         conditioning;
    int n_slow = 0; ///< number of pairs of λ that count as zero but are not rigid-body modes, usually because strong dampers slow the decay

    std::size_t n_unstable() const;

    std::size_t n_of(Verdict verdict) const;

    /// Number of real eigenvalues λ > 0: static divergence.
    std::size_t n_growing_real() const;
  };

  /// A mode is slow if |λ|² is at most this multiple of CoupledSystem::hidden_square: cancellation in the stiffness costs digits [-].
  inline constexpr double slow_square = 1e4;

  bool is_slow(const CoupledSystem &system, const std::complex<double> &lambda);

  /// Largest relative error |δλ| / |λ| of all modes that are not slow [-].
  double largest_error(const CoupledSystem &system, const ComplexModes &modes, const Conditioning &conditioning);

  /// Relative errors of λ for the verdicts. Slow modes, which lose digits by cancellation in the stiffness, have individual errors. The
  /// largest error of the other modes applies to all of them, because an individual estimate may be far too small by chance.
  std::vector<double> uncertainties(const CoupledSystem &system, const ComplexModes &modes, const Conditioning &conditioning);

  /// Verdicts on @p modes, each with its individual error in @p conditioning.
  JudgedModes judged_by_errors(ComplexModes modes, Conditioning conditioning, bool has_damping);

  /// Verdicts on @p modes of any solver, with uncertainties().
  JudgedModes judged_modes(const CoupledSystem &system, const SystemModes &frictionless, ComplexModes modes);

  /// Complex modes of the system in the band, by the solver chosen in the parameters. Throws SolverError if no mode oscillates in the band.
  JudgedModes modes_with_friction(const CoupledSystem    &system,
                                  const SystemModes      &frictionless,
                                  double                  mu,
                                  const Band             &band,
                                  const SolverParameters &solvers,
                                  Progress               &progress);
} // namespace Squeal
