#include <squeal/base/conventions.h>
#include <squeal/estimates/discretisation_error.h>

#include <algorithm>
#include <cmath>

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
              if (std::abs(distance - (other(j).imag() - other(k).imag())) >= std::abs(distance)) // they may meet
                error.divergence = std::max({error.divergence, divergence_error(k), is_neutral ? 0.5 * std::abs(distance) / omega : 0.});
            }
        error.verdict = verdict(fine.lambda[j], error.divergence, solver_error);
      }
    return result;
  }
} // namespace Squeal
