#pragma once

#include <cmath>
#include <complex>

namespace Squeal
{
  /// Divergence rates that the least structural damping outweighs [-].
  constexpr double weak_divergence = 1e-4;

  /// Rates |Re λ| up to this part of the band's end belong to the band [-].
  inline constexpr double largest_rate_of_band = 0.1;

  /**
   * Radius ρ [1/s] of a band that ends at ω_max [rad/s]: of its eigenvalues are listed all with |λ| ≤ ρ,
   *
   *   ρ = ω_max √(1 + 0.1²),
   *
   * among them all with 0 < Im λ ≤ ω_max and |Re λ| ≤ 0.1 ω_max. What grows or decays faster depends on the mesh.
   */
  inline double band_radius(const double largest_circular_frequency)
  {
    return std::hypot(1., largest_rate_of_band) * largest_circular_frequency;
  }

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
