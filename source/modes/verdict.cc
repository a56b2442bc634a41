#include <squeal/modes/verdict.h>

#include <cmath>

namespace Squeal
{
  Verdict verdict_of(const std::complex<double> &lambda, const double error, const bool growth_needs_coalescence)
  {
    const double rate = lambda.real(), uncertainty = error_safety * error, negligible = negligible_divergence * lambda.imag();
    if (rate / (negligible + uncertainty) > 1.)
      return Verdict::unstable;
    if (!(rate + (growth_needs_coalescence && !std::isnan(error) ? 0. : uncertainty) <= negligible))
      return Verdict::undecided;
    return rate >= -negligible ? Verdict::neutral : Verdict::stable;
  }
} // namespace Squeal
