#include <squeal/base/conventions.h>

#include <cmath>

namespace Squeal
{
  double circular_frequency(const double hertz)
  {
    return 2. * M_PI * hertz;
  }

  double hertz(const double circular_frequency)
  {
    return circular_frequency / (2. * M_PI);
  }

  double band_radius(const double largest_circular_frequency)
  {
    return std::hypot(1., largest_rate_of_band) * largest_circular_frequency;
  }

  ModalQuantities modal_quantities(const std::complex<double> &lambda)
  {
    const double R = lambda.real(), omega = lambda.imag();
    // A rigid-body or overdamped mode has no period to which R could be related.
    const double xi = omega > 0. ? R / omega : 0.;
    return {hertz(omega), R, xi, -2. * xi};
  }
} // namespace Squeal
