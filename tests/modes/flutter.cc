// SPDX-License-Identifier: GPL-3.0-or-later

#include "flutter.h"

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

TEST(Flutter, ClosedForm)
{
  for (const auto &[damping, beta] : {std::make_pair(0., 0.), {0.02, 0.}, {0., 0.03}, {0.01, 0.02}})
    {
      const Flutter flutter{1.3, damping, beta};
      for (const double factor : {0., 0.5, 0.99, 1.01, 2.})
        {
          const double mu = factor * flutter.coalescence();
          for (const auto &values : solutions(flutter.system(), mu))
            EXPECT_LT(largest(distances(values, flutter.lambda(mu))), 1e-12);
        }
    }
}

TEST(Flutter, InstabilityBeginsAtTheThreshold)
{
  // Near coalescence, δλ ~ √ε: the accuracy at a distance of 1e-7 is only about 1e-9
  const Flutter       flutter;
  const CoupledSystem system = flutter.system();
  for (const auto &values : solutions(system, flutter.coalescence() * (1. - 1e-7)))
    for (const Complex &l : values)
      EXPECT_LT(std::abs(l.real()), 1e-8);
  for (const auto &values : solutions(system, flutter.coalescence() * (1. + 1e-7)))
    {
      // The expected growth rate is R ≈ √(k12 k_c δμ) / (2 ω)
      const double omega = std::sqrt(0.5 * (flutter.k11 + flutter.k22));
      const double R     = std::sqrt(flutter.k12 * flutter.k_c * flutter.coalescence() * 1e-7) / (2. * omega);
      ASSERT_EQ(values.size(), 2u);
      EXPECT_NEAR(std::max(values[0].real(), values[1].real()) / R, 1., 1e-3);
      EXPECT_NEAR(std::min(values[0].real(), values[1].real()) / R, -1., 1e-3);
    }
}
