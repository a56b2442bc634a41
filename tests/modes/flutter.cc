#include "solutions.h"

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /**
   * Two degrees of freedom with one contact (N. Hoffmann, M. Fischer, R.
   * Allgaier, L. Gaul, Mech. Res. Comm. 29 (2002) 197):
   *
   *   ẍ + (d + β K̃) ẋ + K̃ x = 0,   K̃ = [ k11   k12 - μ k_c ]
   *                                     [ k12   k22         ]
   *
   * The frequencies coalesce where (k11 - k22)² + 4 k12 (k12 - μ k_c) = 0. β is
   * structural damping, of which friction takes its part: V_C = β V_K.
   */
  struct Flutter
  {
    double k11 = 3., k22 = 2., k12 = 0.7, k_c = 1.3, damping = 0., beta = 0.;

    double threshold() const
    {
      return ((k11 - k22) * (k11 - k22) / (4. * k12) + k12) / k_c;
    }

    /// λ² + (d + β κ) λ + κ = 0 for both eigenvalues κ of the stiffness; those with Im λ > 0.
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

    /// With a damping matrix of its own in place of α M + β K, if there is one.
    CoupledSystem system(std::shared_ptr<const SparseMatrix> C = nullptr) const
    {
      const RowMap map = rows(2), contact = rows(1);
      const auto   M = Testing::diagonal(map, [](int) { return 1.; });
      const auto   K = sparse(map, map, [this](const int i) { return i == 0 ? Row{{0, k11}, {1, k12}} : Row{{0, k12}, {1, k22}}; });
      if (!C && (damping != 0. || beta != 0.))
        C = add(damping, *M, beta, *K);
      return system_of({M, C, K},
                       sparse(contact, map,
                              [](int) {
                                return Row{{0, 1.}};
                              }),
                       sparse(contact, map,
                              [this](int) {
                                return Row{{1, k_c}};
                              }),
                       sparse(contact, map, [this](int) {
                         return Row{{1, beta * k_c}};
                       }));
    }
  };

  std::vector<std::vector<Complex>> solutions(const Flutter &flutter, const double mu)
  {
    return Testing::solutions(flutter.system(), mu);
  }
} // namespace

TEST(Flutter, ClosedForm)
{
  for (const auto &[damping, beta] : {std::make_pair(0., 0.), {0.02, 0.}, {0., 0.03}, {0.01, 0.02}})
    {
      Flutter flutter;
      flutter.damping = damping;
      flutter.beta    = beta;
      for (const double factor : {0., 0.5, 0.99, 1.01, 1.5, 2.})
        {
          const double mu = factor * flutter.threshold();
          for (const auto &values : solutions(flutter, mu))
            EXPECT_LT(largest(distances(values, flutter.lambda(mu))), 1e-12);
        }
    }
}

TEST(Flutter, InstabilityBeginsAtTheThreshold)
{
  // Near the coalescence δλ ~ √ε: 1e-7 from it the values are known to about 1e-9 only.
  const Flutter flutter;
  for (const auto &values : solutions(flutter, flutter.threshold() * (1. - 1e-7)))
    for (const Complex &l : values)
      EXPECT_LT(std::abs(l.real()), 1e-8);
  for (const auto &values : solutions(flutter, flutter.threshold() * (1. + 1e-7)))
    {
      // R ≈ √(k12 k_c δμ) / (2 ω)
      const double omega = std::sqrt(0.5 * (flutter.k11 + flutter.k22));
      const double R     = std::sqrt(flutter.k12 * flutter.k_c * flutter.threshold() * 1e-7) / (2. * omega);
      ASSERT_EQ(values.size(), 2u);
      EXPECT_NEAR(std::max(values[0].real(), values[1].real()) / R, 1., 1e-3);
      EXPECT_NEAR(std::min(values[0].real(), values[1].real()) / R, -1., 1e-3);
    }
}

TEST(Flutter, UnequalDampingLowersTheThreshold)
{
  // λ⁴ + a3 λ³ + a2 λ² + a1 λ + a0, a0 = k11 k22 - k12 (k12 - μ k_c), is stable up to a1 (a3 a2 - a1) = a3² a0 (Hurwitz).
  const Flutter flutter;
  const double  k11 = flutter.k11, k22 = flutter.k22, k12 = flutter.k12;
  for (const auto &[d1, d2] : {std::make_pair(0.02, 0.02), {0.04, 0.}, {0., 0.04}, {0.01, 0.03}})
    {
      const double a3 = d1 + d2, a2 = k11 + k22 + d1 * d2, a1 = d1 * k22 + d2 * k11;
      const double a0        = a1 * (a3 * a2 - a1) / (a3 * a3);
      const double threshold = (k12 - (k11 * k22 - a0) / k12) / flutter.k_c;
      if (d1 == d2)
        EXPECT_GT(threshold, flutter.threshold());
      else
        EXPECT_LT(threshold, 0.99 * flutter.threshold());

      const CoupledSystem system = flutter.system(Testing::diagonal(rows(2), [d1 = d1, d2 = d2](const int i) { return i == 0 ? d1 : d2; }));
      for (const double side : {-1., 1.})
        for (const auto &values : Testing::solutions(system, threshold * (1. + 1e-4 * side)))
          {
            ASSERT_EQ(values.size(), 2u);
            EXPECT_GT(side * std::max(values[0].real(), values[1].real()), 0.);
          }
    }
}
