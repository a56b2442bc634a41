// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <cmath>
#include <complex>
#include <limits>

namespace Squeal
{
  /// Divergence rate below which slight structural damping stabilises a mode [-].
  constexpr double weak_divergence = 1e-4;

  /// Default of the largest |Re λ| in the band, as a fraction of the upper end of the band [-].
  inline constexpr double largest_rate_of_band = 0.1;

  /**
   * Frequency band of a run. The argument principle counts the eigenvalues in the rectangle Im λ ≤ end, |Re λ| ≤ rate; modes with |Re λ| >
   * rate depend on the mesh. The run lists the eigenvalues with |λ| ≤ radius(), a circle that encloses the rectangle, and Re λ ≥
   * −largest_decay.
   */
  struct Band
  {
    /// @param given_rate largest |Re λ| [1/s]; 0: largest_rate_of_band times the end
    Band(const double end, const double given_rate = 0.)
      : end(end)
      , rate(given_rate > 0. ? given_rate : largest_rate_of_band * end)
      , largest_damping(given_rate > largest_rate_of_band * end ? given_rate / end : largest_rate_of_band)
      , largest_decay(given_rate > 0. ? given_rate : std::numeric_limits<double>::infinity())
    {}

    double end;             ///< largest Im λ [rad/s]
    double rate;            ///< largest |Re λ| of the rectangle [1/s]
    double largest_damping; ///< largest |Re λ| within the radius at Im λ = end, relative to the end [-]
    double largest_decay;   ///< largest −Re λ of listed modes [1/s]

    double radius() const
    {
      return std::hypot(1., largest_damping) * end;
    }

    bool lists(const std::complex<double> &lambda) const
    {
      return std::abs(lambda) <= radius() && lambda.real() >= -largest_decay;
    }
  };

  /// Real eigenvalues with a modulus below this fraction of the end of the band are creep motions and are not listed [-].
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

  /// Reported quantities of an eigenvalue λ = R + iω of Q(λ) = λ² M + λ C + K.
  struct ModalQuantities
  {
    double frequency;       ///< ω / 2π [Hz]
    double growth_rate;     ///< R [1/s]; positive: the perturbation grows
    double divergence_rate; ///< ξ = R / ω [-], eq. (11) of the paper; 0 for ω = 0
    double damping_ratio;   ///< effective damping ratio −2R/ω [-]; 0 for ω = 0
  };

  /// Quantities of a complex eigenvalue @p lambda [rad/s] with Im λ ≥ 0.
  inline ModalQuantities modal_quantities(const std::complex<double> &lambda)
  {
    const double R = lambda.real(), omega = lambda.imag();
    // Report zero for rigid-body and overdamped modes (ω = 0), for which ξ is undefined
    const double xi = omega > 0. ? R / omega : 0.;
    return {hertz(omega), R, xi, -2. * xi};
  }
} // namespace Squeal
