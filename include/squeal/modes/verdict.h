#pragma once

#include <squeal/base/enum_table.h>

#include <complex>

namespace Squeal
{
  /// Whether a mode grows. Tables call a neutral mode stable.
  enum class Verdict
  {
    stable, ///< it decays
    unstable,
    undecided, ///< at the accuracy of λ
    neutral    ///< it neither grows nor decays but by rounding errors
  };

  template <>
  inline constexpr EnumName<Verdict> enum_table<Verdict>[] = {{Verdict::stable, "stable"},
                                                              {Verdict::unstable, "unstable"},
                                                              {Verdict::undecided, "undecided"},
                                                              {Verdict::neutral, "stable"}};

  /// Divergence rates |ξ| up to this are rounding errors of a neutral mode [-].
  inline constexpr double negligible_divergence = 1e-8;

  /// An estimated error of λ may be that much too small [-].
  inline constexpr double error_safety = 3.;

  /**
   * Whether a mode with λ = R + iω, ω ≥ 0, grows, where λ is known up to @p error [rad/s]. With u = 3 error and ε = 10⁻⁸
   * it is
   *
   *   unstable   if R − u > ε ω,
   *   stable     if R + u ≤ ε ω, and neutral if moreover |R| ≤ ε ω,
   *   undecided  otherwise, and if λ or the error is NaN.
   *
   * Without an error rounding alone decides, as while a branch is followed: R = ± ε ω is neutral still.
   *
   * @param growth_needs_coalescence Without damping −λ̄ is an eigenvalue beside λ: R = 0 stays zero, whatever the error of
   *   ω, unless two modes coalesce. If none is within reach, u does not count against R ≤ ε ω.
   */
  Verdict verdict_of(const std::complex<double> &lambda, double error = 0., bool growth_needs_coalescence = false);
} // namespace Squeal
