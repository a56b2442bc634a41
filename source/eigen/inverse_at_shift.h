// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/conventions.h>
#include <squeal/eigen/quadratic_modes.h>

#include <cmath>
#include <complex>
#include <limits>

namespace Squeal
{
  /// The operator S and the conversion between λ, θ and ν, in units of the radius ρ: θ = ρ θ̂ with λ = s + θ for degree two, θ = ρ² θ̂ with
  /// λ² = s² + θ for degree one; ν̂ = 1 / θ̂.
  class InverseAtShift
  {
  public:
    InverseAtShift(const QuadraticPencil &pencil, const LinearOperator &inverse, const QuadraticModesOptions &options)
      : pencil(pencil)
      , inverse(inverse)
      , s(options.shift)
      , degree(pencil.damping != nullptr ? 2 : 1)
      , zero_square(options.zero_modulus > 0. ? options.zero_modulus * options.zero_modulus :
                                                std::pow(zero_frequency * options.largest_circular_frequency, 2))
    {
      // The discs |λ - s| ≤ radius and |λ² - s²| ≤ radius² contain every requested λ. The most distant λ is the corner with the largest Im
      // λ for degree one, and -ρ for degree two
      const std::complex<double> corner(-options.largest_damping * options.largest_circular_frequency, options.largest_circular_frequency);
      largest_modulus = std::abs(corner);
      radius          = degree == 2 ? largest_modulus + s : std::sqrt(std::abs(corner * corner - s * s));
    }

    /// Upper part of S x for the states x = [u v] (degree two) or [u] (degree one).
    void apply(const MultiVector &states, MultiVector &image) const
    {
      const int         b = image.n_columns();
      const MultiVector u = view(states, 0, b);
      MultiVector       force(image.map(), b, false);
      if (degree == 1)
        {
          pencil.mass->apply(u, force);
          force *= -radius * radius;
        }
      else
        {
          // ρ (C + 2 s M) u + ρ² M v = ρ C u + M (2 ρ s u + ρ² v)
          MultiVector combined(image.map(), b, false);
          combined.local() = 2. * radius * s * u.local() + radius * radius * view(states, b, b).local();
          pencil.mass->apply(combined, force);
          MultiVector damped(image.map(), b, false);
          pencil.damping->apply(u, damped);
          force.local() = -radius * damped.local() - force.local();
        }
      inverse.apply(force, image);
      n_solves += b;
    }

    /// λ for ν; for degree one, the root with Im λ ≥ 0, and with Re λ ≥ 0 if it is real.
    std::complex<double> value(const std::complex<double> nu) const
    {
      const double               tiny  = std::numeric_limits<double>::min();
      const std::complex<double> theta = std::abs(nu) > tiny ? 1. / nu : std::complex<double>(1. / tiny);
      if (degree == 2)
        return s + radius * theta;
      const std::complex<double> square = s * s + radius * radius * theta;
      // Treat a negative square separately, so that the root does not depend on the sign of a zero imaginary part
      const std::complex<double> root =
        square.imag() == 0. && square.real() < 0. ? std::complex<double>(0., std::sqrt(-square.real())) : std::sqrt(square);
      return root.imag() < 0. ? -root : root;
    }

    bool inside(const std::complex<double> nu) const
    {
      return std::abs(nu) >= 1.;
    }

    /**
     * Estimate of ‖Q(λ)φ‖/‖Kφ‖ for φ = upper part of S x and ‖S x - ν x‖ = ε. With S x = ν x + [r_0; r_1], Q(λ)φ = θ (C + 2 s M) r_0 + θ² M
     * r_0 + ρ θ M r_1 (degree two) or θ M r_0 (degree one): the stiffness is not needed. The estimate divides by |λ²| |ν| ‖M u‖ and assumes
     * uniform masses; modes are accepted by their true residuals.
     */
    double residual_estimate(const std::complex<double> nu, const double epsilon) const
    {
      const double theta  = 1. / std::max(std::abs(nu), std::numeric_limits<double>::min());
      const double square = std::norm(value(nu)), lambda = std::sqrt(square) / radius;
      // For a zero eigenvalue, the error of λ² must be well below the threshold for zeros
      if (square < zero_square)
        return std::max(1., theta * radius * radius * zero_margin / zero_square) * epsilon * theta;
      if (degree == 1)
        return epsilon * theta * theta / (lambda * lambda);
      return epsilon * theta * theta / (lambda * lambda) * (1. + theta + 2. * s / radius) * std::hypot(1., theta);
    }

    /// Safety factor for zero eigenvalues: at a tolerance of 10⁻⁹, the error of λ² stays below 1 % of the threshold [-].
    static constexpr double zero_margin = 1e-7;

    const QuadraticPencil &pencil;
    const LinearOperator  &inverse;
    double                 s, radius;
    double                 largest_modulus; ///< ρ of the requested λ [rad/s]
    int                    degree;
    double                 zero_square; ///< |λ|² up to this limit counts as zero [rad²/s²]
    mutable int            n_solves = 0;
  };

  /// Corrects modes that do not meet the tolerance by minimal-residual steps with Q(s)⁻¹. Modes of very low frequency contain
  /// high-frequency rounding errors, and modes with strong dampers contain high-frequency motions. Both are small in φ but large in Kφ or
  /// Cφ, and for them Q(s)⁻¹ is nearly proportional to Q(λ)⁻¹. Corrections that do not lower the residual of a mode are rejected.
  void correct(const QuadraticPencil &pencil, const LinearOperator &inverse, QuadraticModes &modes, double tolerance);

  /// Largest ratio of a residual to its limit: the tolerance or, if larger, rounding errors of Kφ and λCφ.
  double excess(const QuadraticPencil &pencil, const QuadraticModes &modes, const QuadraticModesOptions &options);
} // namespace Squeal
