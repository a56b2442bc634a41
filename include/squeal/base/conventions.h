#pragma once

#include <complex>

namespace Squeal
{
  /**
   * How an eigenvalue λ = R + iω of Q(λ) = λ² M + λ C + K is reported. This is
   * the only place where rad/s become Hz and rates become per cent.
   */
  struct ModalQuantities
  {
    double frequency;       ///< ω / 2π [Hz]
    double growth_rate;     ///< R [1/s]; positive: the perturbation grows
    double divergence_rate; ///< ξ = R / ω [-], eq. (11) of the paper; 0 for ω = 0
    double damping_ratio;   ///< industrial damping ratio -2 R / ω [-]; 0 for ω = 0
  };

  /// Quantities of a complex eigenvalue @p lambda [rad/s], of which Im λ ≥ 0.
  ModalQuantities modal_quantities(const std::complex<double> &lambda);

  /// Frequencies below this part of the band's end count as zero: those of a body that can move freely [-].
  inline constexpr double zero_frequency = 1e-4;

  /// Circular frequency [rad/s] of a frequency in Hz.
  double circular_frequency(double hertz);

  /// Frequency [Hz] of a circular frequency in rad/s.
  double hertz(double circular_frequency);
} // namespace Squeal
