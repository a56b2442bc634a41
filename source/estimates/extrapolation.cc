#include <squeal/estimates/extrapolation.h>

#include <boost/math/tools/roots.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Squeal
{
  namespace
  {
    /// Differences of values up to this part of them are rounding errors [-].
    constexpr double rounding = 1e-13;

    /// Limit of the two finest values with order p.
    double limit(const std::vector<double> &widths, const std::vector<double> &values, const double p)
    {
      const std::size_t n     = values.size();
      const double      ratio = std::pow(widths[n - 1] / widths[n - 2], p);
      return values[n - 1] + (values[n - 1] - values[n - 2]) * ratio / (1. - ratio);
    }

    /// Order of three values; nothing if there is none in the range.
    std::optional<double> observed_order(const double *h, const double *v, const OrderRange &plausible)
    {
      const double quotient = (v[0] - v[1]) / (v[1] - v[2]);
      if (!(quotient > 0.))
        return {};
      // Ascends with p
      const auto f = [&](const double p) { return std::log((std::pow(h[0] / h[1], p) - 1.) / (1. - std::pow(h[2] / h[1], p)) / quotient); };
      const double f_at_smallest = f(plausible.smallest), f_at_largest = f(plausible.largest);
      if (!(f_at_smallest <= 0. && f_at_largest >= 0.))
        return {};
      std::uintmax_t iterations = 100;
      const auto [below, above] = boost::math::tools::toms748_solve(f, plausible.smallest, plausible.largest, f_at_smallest, f_at_largest,
                                                                    boost::math::tools::eps_tolerance<double>(), iterations);
      return 0.5 * (below + above);
    }
  } // namespace

  Extrapolation extrapolate(const std::vector<double> &widths,
                            const std::vector<double> &values,
                            const double               assumed_order,
                            const OrderRange          &plausible)
  {
    const std::size_t n = values.size();
    Extrapolation     result{values.back(), assumed_order, {}, false, 0., {}};
    for (std::size_t k = 2; k < n; ++k)
      result.observed_orders.push_back(observed_order(&widths[k - 2], &values[k - 2], plausible));

    const double difference = std::abs(values[n - 1] - values[n - 2]);
    double       largest    = 0.;
    for (const double value : values)
      largest = std::max(largest, std::abs(value));
    if (difference <= rounding * largest)
      {
        result.is_trustworthy = true;
        result.uncertainty    = difference;
      }
    else
      {
        const double assumed = limit(widths, values, assumed_order);
        if (n > 2 && result.observed_orders.back())
          {
            result.order          = *result.observed_orders.back();
            result.is_trustworthy = true;
          }
        result.limit       = limit(widths, values, result.order);
        result.uncertainty = std::abs(result.limit - assumed) + (result.is_trustworthy ? 0. : difference);
      }
    for (const double value : values)
      result.errors.push_back(std::abs(value - result.limit));
    return result;
  }
} // namespace Squeal
