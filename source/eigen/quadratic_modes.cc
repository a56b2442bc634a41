// SPDX-License-Identifier: GPL-3.0-or-later

#include "inverse_at_shift.h"

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/eigen/compact_krylov.h>
#include <squeal/eigen/quadratic_modes.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// |Im λ| / |λ| up to which λ is real: rounding splits a double real λ into a pair by the square root of rounding errors [-].
    constexpr double nearly_real = 1e-7;
    /// Number of values outside the radius that must converge, as a check that all values inside have been found.
    constexpr int n_beyond = 2;
    /// Number of block steps, from random directions and with the found values deflated, that check for missing values.
    constexpr int n_proving_steps = 8;
    /// Number of such steps if fewer modes were found than expected.
    constexpr int n_searching_steps = 16;

    struct Convergence
    {
      int    n_inside    = 0; ///< Ritz values inside the radius
      int    n_converged = 0; ///< converged Ritz values inside the radius
      double worst       = 0.;
      bool   complete    = false; ///< all values inside the radius, and some outside, have converged
    };

    Convergence convergence(const InverseAtShift &transformation, const RitzPairs &ritz, const double tolerance, const bool exhausted)
    {
      Convergence state;
      int         n_outside = 0;
      bool        covered   = true;
      for (std::size_t i = 0; i < ritz.values.size(); ++i)
        {
          const double estimate = transformation.residual_estimate(ritz.values[i], ritz.errors[i]);
          if (transformation.inside(ritz.values[i]))
            {
              ++state.n_inside;
              state.worst = std::max(state.worst, estimate);
              if (estimate <= tolerance)
                ++state.n_converged;
            }
          else if (n_outside < n_beyond)
            {
              ++n_outside;
              covered = covered && ritz.errors[i] <= std::sqrt(tolerance) * std::abs(ritz.values[i]);
            }
        }
      state.complete = state.n_converged == state.n_inside && (exhausted || (covered && n_outside == n_beyond));
      return state;
    }

    /// A λ of the result before its vectors are computed.
    struct Candidate
    {
      Complex value;
      int     position;  ///< column of the real part among the eigenvectors of the projected matrix
      double  conjugate; ///< sign of the imaginary part; 0 for a real vector
    };

    /// Scales each φ to ‖φ‖₂ = 1 with its entry of largest modulus real and positive.
    void normalize(MultiVector &real, MultiVector &imaginary)
    {
      fix_phase(real, imaginary);
      const std::vector<double> real_norms = column_norms(real), imaginary_norms = column_norms(imaginary);
      for (int j = 0; j < real.n_columns(); ++j)
        if (const double norm = std::hypot(real_norms[j], imaginary_norms[j]); norm > 0.)
          {
            real.col(j) /= norm;
            imaginary.col(j) /= norm;
          }
    }

    /// Sorts the Ritz values inside the radius into oscillating, real and zero eigenvalues; computes vectors and residuals.
    QuadraticModes extract(const QuadraticPencil       &pencil,
                           const InverseAtShift        &transformation,
                           const CompactKrylov         &krylov,
                           const RitzPairs             &ritz,
                           const QuadraticModesOptions &options)
    {
      QuadraticModes         modes;
      std::vector<Candidate> candidates;
      for (std::size_t i = 0; i < ritz.values.size(); ++i)
        {
          const Complex nu     = ritz.values[i];
          const Complex lambda = transformation.value(nu);
          const bool    pair   = nu.imag() != 0.;
          if (!transformation.inside(nu) || std::abs(lambda) > transformation.largest_modulus)
            continue;
          const bool is_real = !(std::abs(lambda.imag()) / std::abs(lambda) > nearly_real);
          // Real λ with a modulus below zero_frequency times the end of the band are creep motions and count as zeros
          if (!(std::norm(lambda) > transformation.zero_square) ||
              (is_real && !(std::abs(lambda) / options.largest_circular_frequency > zero_frequency)))
            modes.n_zero_values += transformation.degree == 1 ? 2 : 1;
          else if (is_real)
            {
              modes.real_values.push_back(lambda.real());
              if (transformation.degree == 1)
                modes.real_values.push_back(-lambda.real());
            }
          else if (lambda.imag() > 0. && lambda.imag() <= options.largest_circular_frequency && lambda.real() >= -options.largest_decay)
            {
              // Both members of a conjugate pair ν use the same two columns; for degree one, both have a λ with Im λ > 0, for degree two
              // only one of them
              candidates.push_back({lambda, ritz.positions[i], !pair ? 0. : nu.imag() > 0. ? 1. : -1.});
            }
        }
      std::sort(modes.real_values.begin(), modes.real_values.end());
      modes.real_values.erase(modes.real_values.begin(),
                              std::lower_bound(modes.real_values.begin(), modes.real_values.end(), -options.largest_decay));
      std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate &a, const Candidate &b) {
        return a.value.imag() != b.value.imag() ? a.value.imag() < b.value.imag() : a.value.real() < b.value.real();
      });

      // ------------------------------------------------- vectors
      const int k          = static_cast<int>(candidates.size());
      modes.real_part      = k > 0 ? std::make_shared<MultiVector>(pencil.mass->map(), k) : nullptr;
      modes.imaginary_part = k > 0 ? std::make_shared<MultiVector>(pencil.mass->map(), k) : nullptr;
      if (k > 0)
        {
          // Process a few modes at a time: there may not be enough memory for two copies of all modes
          constexpr int modes_together = 16;
          for (int first = 0; first < k; first += modes_together)
            {
              std::vector<int> some;
              for (int j = first; j < std::min(k, first + modes_together); ++j)
                {
                  some.push_back(candidates[j].position);
                  if (candidates[j].conjugate != 0.)
                    some.push_back(candidates[j].position + 1);
                }
              const MultiVector vectors = krylov.ritz_vectors(ritz, some);
              int               column  = 0;
              for (int j = first; j < std::min(k, first + modes_together); ++j)
                {
                  const Candidate &candidate = candidates[j];
                  modes.values.push_back(candidate.value);
                  modes.real_part->col(j) = vectors.col(column++);
                  if (candidate.conjugate != 0.)
                    modes.imaginary_part->col(j) = candidate.conjugate * vectors.col(column++);
                }
            }
          normalize(*modes.real_part, *modes.imaginary_part);
          modes.residuals = residuals(pencil, modes.values, *modes.real_part, *modes.imaginary_part);
        }
      modes.radius = transformation.radius;
      return modes;
    }

    std::string scientific(const double x)
    {
      std::ostringstream text;
      text.precision(2);
      text << std::scientific << x;
      return text.str();
    }

    [[noreturn]] void throw_unconverged(const Convergence           &state,
                                        const double                 worst,
                                        const std::string           &reason,
                                        const QuadraticModesOptions &options)
    {
      throw SolverError(std::to_string(state.n_converged) + " of " + std::to_string(state.n_inside) +
                          " eigenvalues inside the radius converged; the largest residual is about " + scientific(worst) +
                          ", the tolerance is " + scientific(options.tolerance) + ": " + reason,
                        "complex modes up to " + scientific(options.largest_circular_frequency) + " rad/s",
                        "raise Complex modes/Tolerance, or lower Band/Maximum frequency");
    }

    void check(const QuadraticPencil &pencil, const LinearOperator &inverse, const QuadraticModesOptions &options)
    {
      const auto refuse = [](const std::string &what, const std::string &change) {
        throw SolverError(what, "options of the complex modes", change);
      };
      if (!(options.largest_circular_frequency > 0.))
        refuse("The largest frequency is " + scientific(options.largest_circular_frequency) + " rad/s, but must be positive",
               "give a positive frequency");
      if (!(options.shift >= 0.))
        refuse("The shift is " + scientific(options.shift) + " 1/s, but must not be negative", "give a positive shift or zero");
      if (!(options.tolerance > 0.) || options.block_size < 1 || options.n_fresh_directions < 0)
        refuse("The tolerance or the block size is not positive, or the number of fresh directions is negative", "give positive values");
      if (inverse.map().n() != pencil.mass->map().n())
        refuse("The operators have different sizes", "pass the inverse of the same pencil");
    }

    /// Extends the Krylov space, restarts it, and checks convergence.
    class Search
    {
    public:
      Search(const QuadraticPencil &pencil, const LinearOperator &inverse, const QuadraticModesOptions &options)
        : options(options)
        , transformation(pencil, inverse, options)
        , n_wanted(std::max(options.expected, 4) * transformation.degree)
        , krylov(pencil.mass->map(), transformation.degree, largest_basis() + 2 * width())
        , tolerance(0.3 * options.tolerance)
      {}

      void grow(const int n_basis)
      {
        while (krylov.dimension < n_basis && !exhausted)
          {
            if (krylov.dimension == 0)
              krylov.inject(first_block());
            if (krylov.block_size == 0)
              {
                exhausted = inject(options.block_size) == 0;
                continue;
              }
            krylov.expand(shift_invert());
            n_basis_largest = std::max(n_basis_largest, krylov.n_vectors);
          }
      }

      void assess()
      {
        worst_before     = state.worst;
        dimension_before = dimension_seen;
        dimension_seen   = krylov.dimension;

        ritz     = krylov.ritz_pairs();
        state    = convergence(transformation, ritz, tolerance, exhausted);
        n_wanted = std::max(n_wanted, state.n_inside);
        if (options.report)
          options.report(text(state.n_converged, " of ", counted(state.n_inside, "eigenvalue"), ", ", counted(krylov.dimension, "vector"),
                              ", ", counted(transformation.n_solves, "solve")));
      }

      /// Size of the space at the next check; restarts if this size exceeds the largest basis.
      int next_size()
      {
        int n_more = n_until_next_look();
        if (krylov.dimension + n_more > largest_basis())
          {
            // Use a third of the space beyond the requested vectors to keep values that are still converging
            const int n_kept = std::min(krylov.dimension, state.n_inside + (largest_basis() - state.n_inside) / 3);
            if (++n_restarts > options.max_restarts)
              throw_unconverged(state, state.worst, "no convergence after " + counted(options.max_restarts, "restart"), options);
            krylov.restart(ritz, n_kept);
            n_more = std::max(n_more, (largest_basis() - krylov.dimension) / 2);
          }
        return krylov.dimension + n_more;
      }

      /// Number of vectors until the next check. Steps cost more than checks, and finally all values converge within a few steps. The
      /// number is therefore extrapolated from the decrease of the largest error since the last check, and reduced to three quarters,
      /// because convergence accelerates at the end.
      int n_until_next_look() const
      {
        const int n_missing = state.n_inside - state.n_converged, least = transformation.degree * std::max(krylov.block_size, 1);
        const int n_new = dimension_seen - dimension_before;
        if (n_new <= 0 || !(state.worst < worst_before))
          return std::max(2 * least, n_missing / 4);
        const double needed = n_new * std::log(state.worst / tolerance) / std::log(worst_before / state.worst);
        return static_cast<int>(std::clamp<double>(0.75 * needed, least, std::max(2 * least, 3 * n_missing / 2)));
      }

      /**
       * Searches for missing eigenvalues inside the radius, for example in a cluster larger than the block. A short process starts from
       * random directions, with all values found inside the radius deflated. If it finds any value, random directions are injected into the
       * block, and the result is false.
       */
      bool proven()
      {
        const int n_fresh = options.n_fresh_directions;
        if (exhausted || n_fresh == 0)
          return true;
        const bool    fewer   = transformation.degree * options.expected > state.n_inside;
        const int     n_steps = fewer ? n_searching_steps : n_proving_steps;
        CompactKrylov proof   = krylov.deflated(ritz, state.n_inside, (n_steps + 1) * n_fresh);
        proof.inject(fresh_vectors(n_fresh));
        for (int step = 0; step < n_steps && proof.block_size > 0; ++step)
          proof.expand(shift_invert());
        const RitzPairs more = proof.ritz_pairs();
        const auto      count =
          std::count_if(more.values.begin(), more.values.end(), [this](const Complex &nu) { return transformation.inside(nu); });
        if (count <= state.n_inside)
          return true;
        if (options.report)
          options.report("random directions reveal at least " + counted(count - state.n_inside, "missing eigenvalue"));
        n_wanted += static_cast<int>(count) - state.n_inside;
        inject(n_fresh);
        return false;
      }

      int width() const
      {
        return options.block_size + options.n_fresh_directions;
      }

      int largest_basis() const
      {
        return options.max_basis > 0 ? std::max(options.max_basis, 2 * width()) : 3 * n_wanted + 8 * width();
      }

      const QuadraticModesOptions &options;
      InverseAtShift               transformation;
      int                          n_wanted; ///< estimated number of basis states for the requested values
      CompactKrylov                krylov;
      double                       tolerance; ///< limit for estimated residuals
      RitzPairs                    ritz;
      Convergence                  state;
      bool                         exhausted  = false; ///< the basis spans all states
      int                          n_restarts = 0, n_basis_largest = 0;

    private:
      /// Random linear combinations of the close vectors, with a small random part that gives the block a component in every mode.
      MultiVector first_block()
      {
        constexpr double share_of_others = 1e-3;
        MultiVector      block           = fresh_vectors(options.block_size);
        if (options.close_vectors == nullptr)
          return block;
        const MultiVector         sums      = *options.close_vectors * gram(*options.close_vectors, block);
        const std::vector<double> all_norms = column_norms(block), norms = column_norms(sums);
        for (int j = 0; j < block.n_columns(); ++j)
          block.col(j) = share_of_others / all_norms[j] * block.col(j) + sums.col(j) / norms[j];
        return block;
      }

      CompactKrylov::Operator shift_invert() const
      {
        return [this](const MultiVector &states, MultiVector &image) { transformation.apply(states, image); };
      }

      MultiVector fresh_vectors(const int n)
      {
        return random_vectors(transformation.pencil.mass->map(), n, options.seed + 7919 * n_injections++);
      }

      int inject(const int n_directions)
      {
        return krylov.inject(fresh_vectors(n_directions));
      }

      int    n_injections   = 0;
      int    dimension_seen = 0, dimension_before = 0; ///< dimension at the last check and at the previous one
      double worst_before = 0.;
    };
  } // namespace

  QuadraticModes quadratic_modes(const QuadraticPencil       &pencil,
                                 const LinearOperator        &inverse_at_shift,
                                 const QuadraticModesOptions &options)
  {
    check(pencil, inverse_at_shift, options);
    Search search(pencil, inverse_at_shift, options);
    int    size = 3 * search.n_wanted / 2 + search.width();
    while (true)
      {
        search.grow(std::min(size, search.largest_basis()));
        search.assess();
        if (search.state.complete)
          {
            QuadraticModes modes = extract(pencil, search.transformation, search.krylov, search.ritz, options);
            correct(pencil, inverse_at_shift, modes, options.tolerance);
            const double excessive = excess(pencil, modes, options);
            if (excessive <= 1.)
              {
                if (!search.proven())
                  {
                    size = search.krylov.dimension + n_proving_steps * search.width();
                    continue;
                  }
                modes.n_solves   = search.transformation.n_solves;
                modes.n_restarts = search.n_restarts;
                modes.n_basis    = search.n_basis_largest;
                return modes;
              }
            // The residual estimate assumes uniform masses and was too small: divide its tolerance by the factor by which the true residual
            // exceeds the limit
            search.tolerance *= 0.3 / excessive;
            if (search.exhausted || search.tolerance < std::numeric_limits<double>::epsilon())
              throw_unconverged(search.state, excessive * options.tolerance, "rounding errors do not allow a smaller residual", options);
          }
        size = search.next_size();
      }
  }

} // namespace Squeal
