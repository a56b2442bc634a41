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

    /// Counterparts of modes, and what follows from pairs of them.
    class Counterparts
    {
    public:
      Counterparts(const std::vector<PairedMode> &pairs,
                   const std::vector<Complex>    &coarse,
                   const std::vector<Complex>    &fine,
                   const double                   share)
        : pairs(pairs)
        , coarse(coarse)
        , fine(fine)
        , share(share)
      {}

      bool has_counterpart(const std::size_t j) const
      {
        return pairs[j].partner >= 0;
      }

      /// Estimated error of ω [rad/s].
      double frequency_error(const std::size_t j) const
      {
        return share * std::abs(fine[j].imag() - coarse[pairs[j].partner].imag());
      }

      double divergence_error(const std::size_t j) const
      {
        return share * std::abs(divergence_rate(fine[j]) - divergence_rate(coarse[pairs[j].partner]));
      }

      /// Whether the distance of two frequencies changes by itself or more from mesh to mesh.
      bool may_meet(const std::size_t j, const std::size_t k) const
      {
        const double distance = fine[j].imag() - fine[k].imag();
        return std::abs(distance - (coarse[pairs[j].partner].imag() - coarse[pairs[k].partner].imag())) >= std::abs(distance);
      }

      /// Largest divergence rate of two neutral modes, should they meet.
      double divergence_if_they_meet(const std::size_t j, const std::size_t k) const
      {
        return 0.5 * std::abs(fine[j].imag() - fine[k].imag()) / fine[j].imag();
      }

    private:
      const std::vector<PairedMode> &pairs;
      const std::vector<Complex>    &coarse, &fine;
      const double                   share;
    };

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
    const ModePairing  pairing = pair_modes(coarse, fine);
    const Counterparts counterparts(pairing.fine, coarse.lambda, fine.lambda, share);
    const std::size_t  n            = fine.lambda.size();
    const double       solver_error = solver_errors.empty() ? 0. : *std::max_element(solver_errors.begin(), solver_errors.end());
    std::vector<DiscretisationError> result(n);
    for (std::size_t j = 0; j < n; ++j)
      {
        DiscretisationError &error = result[j];
        error.has_counterpart      = counterparts.has_counterpart(j);
        error.in_cluster           = pairing.fine[j].in_cluster;
        error.overlap              = pairing.fine[j].overlap;
        if (!error.has_counterpart)
          continue;
        error.frequency       = counterparts.frequency_error(j) / fine.lambda[j].imag();
        error.divergence      = counterparts.divergence_error(j);
        const bool is_neutral = std::abs(divergence_rate(fine.lambda[j])) <= negligible_divergence;
        for (std::size_t k = 0; k < n; ++k)
          if (k != j && counterparts.has_counterpart(k) && counterparts.may_meet(j, k))
            error.divergence =
              std::max({error.divergence, counterparts.divergence_error(k), is_neutral ? counterparts.divergence_if_they_meet(j, k) : 0.});
        error.verdict = verdict(fine.lambda[j], error.divergence, solver_error);
      }
    return result;
  }
} // namespace Squeal
