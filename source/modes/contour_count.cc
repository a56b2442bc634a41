// SPDX-License-Identifier: GPL-3.0-or-later

#include "followed_determinant.h"

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/modes/condensed_determinant.h>
#include <squeal/modes/contour_count.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    const char *const place = "count of complex modes by the argument principle";

    /// Largest ‖ΔN N⁻¹‖ at the points of the contour; between the points, N⁻¹ may be twice as large [-].
    constexpr double largest_truncation = 0.25;

    /// Initial and smallest tolerance for the truncation error of N; rounding limits the smallest tolerance [-].
    constexpr double first_tolerance = 1e-7, least_tolerance = 1e-13;

    /// Shorter steps, relative to ω_high, indicate that a zero lies on the contour. Also the smallest distance of a real mode from ω_low
    /// and ω_high [-].
    constexpr double shortest_step = 1e-9;

    /// Corners of the contour, counterclockwise. Without damping, only half of the contour is followed because of symmetry, and it counts
    /// twice.
    struct Contour
    {
      Contour(const ContourOptions &options, const bool damped)
        : high(options.largest_circular_frequency)
        , low(options.lowest_frequency > 0. ? options.lowest_frequency : 1e-3 * high)
        , width(options.largest_growth > 0. ? options.largest_growth : 0.1 * high)
        , multiplicity(damped ? 1 : 2)
      {
        if (!(high > low))
          throw SolverError("the end of the band, " + decimal_text(hertz(high)) + " Hz, is not above its beginning, " +
                              decimal_text(hertz(low)) + " Hz",
                            place, "change Band/Maximum frequency");
        if (damped)
          corners = {{0., low}, {width, low}, {width, high}, {-width, high}, {-width, low}, {0., low}};
        else
          corners = {{0., low}, {width, low}, {width, high}, {0., high}};
      }

      [[noreturn]] void refuse(const std::string &why, const Complex lambda) const
      {
        throw SolverError(text("the count is rejected: ", why, " at ", decimal_text(hertz(lambda.imag())), " Hz with a growth rate of ",
                               lambda.real(), " 1/s"),
                          place, std::abs(lambda.real()) < width ? "change Band/Maximum frequency" : "change Band/Maximum rate");
      }

      double               high, low, width;
      int                  multiplicity;
      std::vector<Complex> corners;
    };

    /// Winding number of the determinant along the contour; updates n_points and largest_phase_step of @p count.
    int turns(FollowedDeterminant  &determinant,
              const Contour        &contour,
              const ContourOptions &options,
              ContourCount         &count,
              Progress             &progress)
    {
      double phase = 0., length = 0.1 * contour.width;
      determinant.start(contour.corners.front());
      for (std::size_t side = 1; side < contour.corners.size(); ++side)
        {
          const Complex from = contour.corners[side - 1], to = contour.corners[side];
          const double  end       = std::abs(to - from);
          const Complex direction = (to - from) / end;
          for (double position = 0.; position < end;)
            {
              const Complex lambda = from + position * direction;
              const double  rest   = end - position;
              length               = std::min({length, rest, determinant.longest_step(lambda)});
              if (length < std::min(rest, shortest_step * contour.high))
                contour.refuse("a mode lies on the contour", lambda);
              if (determinant.n_points >= options.maximum_points)
                contour.refuse("more than " + std::to_string(options.maximum_points) + " points are needed; the count stopped", lambda);

              const bool last = length == rest;
              const Step step = determinant.attempt(last ? to : lambda + length * direction);
              if (step.size <= 1.)
                {
                  determinant.accept();
                  phase += step.phase;
                  count.largest_phase_step = std::max(count.largest_phase_step, step.largest_phase);
                  position                 = last ? end : position + length;
                  length *= std::min(2., 0.8 / std::max(step.size, 0.1));
                }
              else
                length *= std::clamp(0.8 / step.size, 0.1, 0.5);
            }
          progress.update(counted(determinant.n_points, "point") + " of the contour");
        }
      count.n_points += determinant.n_points;

      const double turns = contour.multiplicity * phase / (2. * M_PI), whole = std::round(turns);
      if (!(std::abs(turns - whole) < 1e-3))
        throw SolverError("the phase of the determinant changes by " + text(turns) + " turns along the contour, not by an integer", place,
                          "change Band/Maximum frequency or Band/Maximum rate");
      return whole;
    }

    /// Number of real modes inside the contour, by inertia.
    int n_frictionless_modes(const CoupledSystem &system, const Contour &contour)
    {
      const auto below = [&](const double omega) {
        return count_below(*system.stiffness, *system.mass, omega * omega, "real modes of the coupled system").n_modes;
      };
      return below(contour.high) - below(contour.low);
    }

    /// Checks that no real mode is on the contour, and that the number of real modes inside equals the count by inertia.
    void check_real_modes(const SymmetricModes &modes, const Contour &contour, const int n_frictionless)
    {
      int n_inside = 0;
      for (const double eigenvalue : modes.eigenvalues)
        {
          const double omega = std::sqrt(std::max(0., eigenvalue));
          n_inside += omega > contour.low && omega < contour.high;
          for (const double end : {contour.low, contour.high})
            if (std::abs(omega - end) < shortest_step * contour.high)
              contour.refuse("a real mode lies on the contour", {0., end});
        }
      if (n_inside != n_frictionless)
        throw SolverError(
          text(counted(n_inside, "real mode was", "real modes were"), " found in the band, but the count by inertia is ", n_frictionless),
          place, "change Band/Maximum frequency");
    }

    std::vector<ContourCount> count_condensed(const CoupledSystem       &system,
                                              const std::vector<double> &mu,
                                              const ContourOptions      &options,
                                              const Contour             &contour,
                                              Progress                  &progress)
    {
      const SparseMatrix &K = *system.stiffness, &M = *system.mass;

      // Factorise once: the real modes and the Chebyshev series of CondensedDeterminant use the same factor
      progress.update("real modes beyond the band");
      SymmetricModesOptions real = options.real_modes;
      if (real.what == SymmetricModesOptions().what)
        real.what = "real modes of the coupled system";
      std::unique_ptr<Factorization> factor;
      if (real.inverse == nullptr)
        {
          factor       = factorize_positive_definite(real.shift > 0. ? *add(1., K, real.shift, M) : K, real.library, real.what);
          real.inverse = factor.get();
        }
      const double         deflation_end = std::max(1.05, options.deflation) * std::hypot(contour.width, contour.high); // the largest |λ|
      const SymmetricModes modes         = symmetric_modes(K, M, deflation_end * deflation_end, real);

      const int n_frictionless = n_frictionless_modes(system, contour);
      check_real_modes(modes, contour, n_frictionless);

      CondensedDeterminantRequest request;
      request.lambda = {{0., contour.low}, {contour.width, contour.low}, {contour.width, contour.high}, {0., contour.high}};
      for (const double friction : mu)
        request.largest_friction_coefficient = std::max(request.largest_friction_coefficient, std::abs(friction));
      request.tolerance = first_tolerance;

      std::vector<ContourCount>                   results;
      std::unique_ptr<const CondensedDeterminant> determinant;
      while (results.size() < mu.size())
        {
          if (!determinant)
            {
              progress.update("moments of the complement");
              determinant = std::make_unique<CondensedDeterminant>(system, modes, deflation_end, *real.inverse, real.shift, request);
            }
          const double  friction = mu[results.size()];
          FollowedDense complement(
            [&](const Complex lambda) {
              return FollowedDense::Sample{determinant->complement(lambda, friction), {}, 0., determinant->truncation(lambda, friction)};
            },
            {}, options.largest_phase_step, M.communicator());
          FollowedDense on_modes(
            [&](const Complex lambda) {
              CondensedDeterminant::OnModes sample = determinant->on_modes(lambda, friction);
              const double                  bound  = determinant->truncation(lambda, friction);
              return FollowedDense::Sample{std::move(sample.matrix), std::move(sample.resonances), bound * sample.complement_inverse,
                                           bound * sample.gain};
            },
            determinant->frequencies, options.largest_phase_step, M.communicator());

          ContourCount count;
          count.n_frictionless = n_frictionless;
          count.n_modes        = n_frictionless + turns(complement, contour, options, count, progress);
          count.n_modes += turns(on_modes, contour, options, count, progress);
          count.truncation_bound = std::max(complement.error, on_modes.error);
          count.n_moments        = determinant->n_moments;
          if (count.truncation_bound <= largest_truncation)
            {
              results.push_back(count);
              continue;
            }
          request.tolerance *= 0.2 * largest_truncation / count.truncation_bound;
          if (!(request.tolerance >= least_tolerance))
            throw SolverError(
              "the count is rejected: the determinant is not accurate enough on the contour, which passes too close to a mode", place,
              "change Band/Maximum frequency or Band/Maximum rate");
          determinant.reset();
        }
      return results;
    }

    std::vector<ContourCount> count_sparse(const CoupledSystem       &system,
                                           const std::vector<double> &mu,
                                           const ContourOptions      &options,
                                           const Contour             &contour,
                                           Progress                  &progress)
    {
      const int                 n_frictionless = n_frictionless_modes(system, contour);
      std::vector<ContourCount> results;
      for (const double friction : mu)
        {
          ContourCount count   = count_by_sparse_lu(with_friction(system, friction), options, progress);
          count.n_frictionless = n_frictionless;
          results.push_back(count);
        }
      return results;
    }
  } // namespace

  ContourOptions contour_of_band(const Band &band)
  {
    ContourOptions result;
    result.largest_circular_frequency = band.end;
    result.lowest_frequency           = 1e-3 * band.end;
    result.largest_growth             = band.rate;
    return result;
  }

  int n_in_rectangle(const std::vector<Complex> &lambda, const ContourOptions &contour)
  {
    return std::count_if(lambda.begin(), lambda.end(), [&](const Complex &value) {
      return std::abs(value.real()) <= contour.largest_growth && value.imag() >= contour.lowest_frequency &&
             value.imag() <= contour.largest_circular_frequency;
    });
  }

  void check_count(const int n_counted, const std::vector<Complex> &lambda, const ContourOptions &contour)
  {
    if (const int n_found = n_in_rectangle(lambda, contour); n_found != n_counted)
      throw SolverError(
        text(counted(n_found, "complex mode was", "complex modes were"), " found in the band up to |Re lambda| = ", contour.largest_growth,
             " 1/s, but the count is ", n_counted),
        place,
        "lower Complex modes/Tolerance (or Complex modes/Iteration tolerance for residual iteration), or change Band/Maximum frequency or "
        "Band/Maximum rate");
  }

  ContourCount count_by_sparse_lu(const SecondOrderSystem &matrices, const ContourOptions &options, Progress &progress)
  {
    const Contour           contour(options, matrices.damping != nullptr);
    const SparseDeterminant determinant(*matrices.mass, matrices.damping.get(), *matrices.stiffness);
    FollowedSparse          followed(determinant, options.largest_phase_step);
    ContourCount            count;
    count.n_modes = turns(followed, contour, options, count, progress);
    return count;
  }

  ContourMethod contour_method(const CoupledSystem &system)
  {
    const bool confined = std::all_of(system.terms.begin(), system.terms.end(), [&system](const Term &term) {
      return !term.matrix || term.matrix == system.mass || term.matrix == system.stiffness || term.vanishes(system.values);
    });
    return confined ? ContourMethod::condensed : ContourMethod::sparse_lu;
  }

  bool is_countable(const CoupledSystem &system)
  {
    return system.map().n_processes() == 1 || (system.stiffness && contour_method(system) == ContourMethod::condensed);
  }

  std::vector<ContourCount> count_by_contour(const CoupledSystem       &system,
                                             const std::vector<double> &mu,
                                             const ContourOptions      &options,
                                             Progress                  &progress)
  {
    const Contour contour(options, system.has_damping());
    return options.method == ContourMethod::condensed ? count_condensed(system, mu, options, contour, progress) :
                                                        count_sparse(system, mu, options, contour, progress);
  }
} // namespace Squeal
