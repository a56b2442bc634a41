// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <cmath>
#include <complex>
#include <limits>

namespace Squeal
{
  /// Divergence rates that the least structural damping outweighs [-].
  constexpr double weak_divergence = 1e-4;

  /// Rates |Re λ| up to this part of the band's end belong to the band [-].
  inline constexpr double largest_rate_of_band = 0.1;

  /**
   * The band of a run. The argument principle counts the eigenvalues of its rectangle, Im λ ≤ end and |Re λ| ≤ rate. Those with
   * |λ| ≤ radius(), which contains the rectangle, are listed, except those that decay faster than a given rate. What grows or decays faster
   * than the radius depends on the mesh.
   */
  struct Band
  {
    /// @param given_rate largest |Re λ| [1/s]; 0: the part largest_rate_of_band of the end
    Band(const double end, const double given_rate = 0.)
      : end(end)
      , rate(given_rate > 0. ? given_rate : largest_rate_of_band * end)
      , largest_damping(given_rate > largest_rate_of_band * end ? given_rate / end : largest_rate_of_band)
      , largest_decay(given_rate > 0. ? given_rate : std::numeric_limits<double>::infinity())
    {}

    double end;             ///< largest Im λ [rad/s]
    double rate;            ///< largest |Re λ| of the rectangle [1/s]
    double largest_damping; ///< |Re λ| over the end within reach of the radius [-]
    double largest_decay;   ///< of listed modes [1/s]

    double radius() const
    {
      return std::hypot(1., largest_damping) * end;
    }

    bool lists(const std::complex<double> &lambda) const
    {
      return std::abs(lambda) <= radius() && lambda.real() >= -largest_decay;
    }
  };

  /// Real eigenvalues below this part of the band's end creep, and are not listed [-].
  inline constexpr double zero_frequency = 1e-4;

  /// Circular frequency [rad/s] of a frequency in Hz.
  inline double circular_frequency(const double hertz)
  {
    return 2. * M_PI * hertz;
  }

  /// Frequency [Hz] of a circular frequency in rad/s.
  inline double hertz(const double circular_frequency)
  {
    return circular_frequency / (2. * M_PI);
  }

  /// How an eigenvalue λ = R + iω of Q(λ) = λ² M + λ C + K is reported. This is the only place where rad/s become Hz and rates become per
  /// cent.
  struct ModalQuantities
  {
    double frequency;       ///< ω / 2π [Hz]
    double growth_rate;     ///< R [1/s]; positive: the perturbation grows
    double divergence_rate; ///< ξ = R / ω [-], eq. (11) of the paper; 0 for ω = 0
    double damping_ratio;   ///< industrial damping ratio -2 R / ω [-]; 0 for ω = 0
  };

  /// Quantities of a complex eigenvalue @p lambda [rad/s], of which Im λ ≥ 0.
  inline ModalQuantities modal_quantities(const std::complex<double> &lambda)
  {
    const double R = lambda.real(), omega = lambda.imag();
    // A rigid-body or overdamped mode has no period to which R could be related.
    const double xi = omega > 0. ? R / omega : 0.;
    return {hertz(omega), R, xi, -2. * xi};
  }
} // namespace Squeal
