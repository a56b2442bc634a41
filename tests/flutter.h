// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include "solutions.h"

#include <cmath>
#include <complex>
#include <memory>
#include <vector>

namespace Squeal::Testing
{
  /**
   * Two degrees of freedom with one contact (N. Hoffmann, M. Fischer, R. Allgaier, L. Gaul, Mech. Res. Comm. 29 (2002) 197):
   *
   *   ẍ + (d + β K̃) ẋ + K̃ x = 0,   K̃ = [ k11   k12 - μ k_c ]
   *                                     [ k12   k22         ]
   *
   * β is the coefficient of structural damping, whose forces also cause friction: V_C = β V_K.
   */
  struct Flutter
  {
    double k_c = 1.3, damping = 0., beta = 0., k11 = 3., k22 = 2., k12 = 0.7;

    /// Friction coefficient at which the undamped frequencies coalesce: (k11 - k22)² + 4 k12 (k12 - μ k_c) = 0.
    double coalescence() const
    {
      return ((k11 - k22) * (k11 - k22) / (4. * k12) + k12) / k_c;
    }

    DenseMatrix stiffness(const double mu) const
    {
      return DenseMatrix{{k11, k12 - mu * k_c}, {k12, k22}};
    }

    /// Roots of λ² + (d + β κ) λ + κ = 0 with Im λ > 0 for both eigenvalues κ of the stiffness.
    std::vector<Complex> lambda(const double mu) const
    {
      std::vector<Complex> result;
      const Complex        root = std::sqrt(Complex((k11 - k22) * (k11 - k22) + 4. * k12 * (k12 - mu * k_c)));
      for (const double sign : {-1., 1.})
        {
          const Complex kappa = 0.5 * (k11 + k22 + sign * root);
          const Complex half  = 0.5 * (damping + beta * kappa);
          const Complex omega = std::sqrt(half * half - kappa);
          for (const double other : {-1., 1.})
            if (const Complex l = -half + other * omega; l.imag() > 0.)
              result.push_back(l);
        }
      return result;
    }

    CoupledSystem system() const
    {
      const auto M = sparse(DenseMatrix::Identity(2, 2)), K = sparse(stiffness(0.));
      return system_of({M, damping != 0. || beta != 0. ? add(damping, *M, beta, *K) : nullptr, K}, sparse(DenseMatrix{{1., 0.}}),
                       sparse(DenseMatrix{{0., k_c}}), sparse(DenseMatrix{{0., beta * k_c}}));
    }
  };
} // namespace Squeal::Testing
