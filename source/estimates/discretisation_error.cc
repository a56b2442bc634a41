// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/estimates/discretisation_error.h>

#include <boost/math/tools/roots.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    double divergence_rate(const Complex &lambda)
    {
      return modal_quantities(lambda).divergence_rate;
    }

    Verdict verdict(const Complex &lambda, const double divergence_error, const double solver_error)
    {
      const Verdict by_solver = verdict_of(lambda, solver_error * std::abs(lambda));
      const double  xi        = divergence_rate(lambda);
      if (by_solver == Verdict::unstable && xi > divergence_error)
        return Verdict::unstable;
      const bool is_neutral = std::abs(xi) <= negligible_divergence;
      if (is_neutral ? divergence_error <= weak_divergence : xi + divergence_error <= 0. && by_solver == Verdict::stable)
        return Verdict::stable;
      return Verdict::undecided;
    }
  } // namespace

  bool DiscretisationError::is_within(const double frequency_limit, const double divergence_limit) const
  {
    return has_counterpart && frequency <= frequency_limit && divergence <= divergence_limit;
  }

  std::vector<DiscretisationError> discretisation_errors(const ModesAtPoints       &coarse,
                                                         const ModesAtPoints       &fine,
                                                         const double               share,
                                                         const std::vector<double> &solver_errors)
  {
    const ModePairing              pairing = pair_modes(coarse, fine);
    const std::vector<PairedMode> &pairs   = pairing.fine;
    const std::size_t              n       = fine.lambda.size();
    const double solver_error              = solver_errors.empty() ? 0. : *std::max_element(solver_errors.begin(), solver_errors.end());
    const auto   other                     = [&](const std::size_t j) { return coarse.lambda[pairs[j].partner]; };
    const auto   divergence_error          = [&](const std::size_t j) {
      return share * std::abs(divergence_rate(fine.lambda[j]) - divergence_rate(other(j)));
    };
    std::vector<DiscretisationError> result(n);
    for (std::size_t j = 0; j < n; ++j)
      {
        DiscretisationError &error = result[j];
        error.has_counterpart      = pairs[j].partner >= 0;
        error.in_cluster           = pairs[j].in_cluster;
        error.overlap              = pairs[j].overlap;
        if (!error.has_counterpart)
          continue;
        const double omega    = fine.lambda[j].imag();
        error.frequency       = share * std::abs(omega - other(j).imag()) / omega;
        error.divergence      = divergence_error(j);
        const bool is_neutral = std::abs(divergence_rate(fine.lambda[j])) <= negligible_divergence;
        for (std::size_t k = 0; k < n; ++k)
          if (k != j && pairs[k].partner >= 0)
            {
              const double distance = omega - fine.lambda[k].imag();
              if (std::abs(distance - (other(j).imag() - other(k).imag())) >= std::abs(distance)) // j and k may coalesce
                error.divergence = std::max({error.divergence, divergence_error(k), is_neutral ? 0.5 * std::abs(distance) / omega : 0.});
            }
        error.verdict = verdict(fine.lambda[j], error.divergence, solver_error);
      }
    return result;
  }

  namespace
  {
    /// Relative differences of values up to this limit are rounding errors [-].
    constexpr double rounding = 1e-13;

    /// Extrapolated limit of the two finest values for order p.
    double limit(const std::vector<double> &widths, const std::vector<double> &values, const double p)
    {
      const std::size_t n     = values.size();
      const double      ratio = std::pow(widths[n - 1] / widths[n - 2], p);
      return values[n - 1] + (values[n - 1] - values[n - 2]) * ratio / (1. - ratio);
    }

    /// Order of convergence from three values; empty if no order in the range agrees with them.
    std::optional<double> observed_order(const double *h, const double *v, const OrderRange &plausible)
    {
      const double quotient = (v[0] - v[1]) / (v[1] - v[2]);
      if (!(quotient > 0.))
        return {};
      // f increases with p
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
