// SPDX-License-Identifier: GPL-3.0-or-later

#include "solutions.h"

#include <squeal/estimates/mode_groups.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  const ModeLabel F1 = {ModeFamily::flexural, 0, 0, 1}, T12 = {ModeFamily::torsional, 0, 0, 12, DoubletSign::plus};
} // namespace

TEST(EnergyShares, AreThoseOfTheRows)
{
  // Two uncoupled bodies with two dofs each, first the disc
  const DenseMatrix       K{{10., -3., 0., 0.}, {-3., 10., 0., 0.}, {0., 0., 10., -3.}, {0., 0., -3., 10.}};
  const RowMap            map = rows(4);
  const SecondOrderSystem bodies{Testing::diagonal(map, [](const int i) { return 1. + i; }), nullptr, sparse(K)};
  const MultiVector       I = unit_vectors(map);
  MultiVector             disc(map, 1), re(map, 3), im(map, 3);
  disc.col(0)                       = I.col(0) + I.col(1);
  re.col(0)                         = I.col(0) + 2. * I.col(1);            // only the disc moves
  re.col(1)                         = I.col(3);                            // only the pins move
  re.col(2)                         = I.col(0) + 2. * I.col(1) - I.col(2); // both move
  im.col(2)                         = 3. * I.col(3) + I.col(1);
  const std::vector<Complex> lambda = {{0., 2.}, {0., 3.}, {-0.5, 2.}};
  const auto                 shares = energy_shares(bodies, disc, lambda, re, im);
  ASSERT_EQ(shares.size(), 3u);
  EXPECT_NEAR(shares[0], 1., 1e-14);
  EXPECT_NEAR(shares[1], 0., 1e-14);
  // Expected sums: uᴴMu, disc 1 + 2 (4 + 1), pins 3 + 4 · 9; uᴴKu, disc 10 (1 + 4 + 1) − 6 · 2, pins 10 (1 + 9); |λ|² = 4.25
  const double of_disc = 4.25 * 11. + 48., of_pins = 4.25 * 39. + 100.;
  EXPECT_NEAR(shares[2], of_disc / (of_disc + of_pins), 1e-14);
}

TEST(ModeGroups, OfTheFrictionlessProblem)
{
  // Energy, not the label, determines whether a mode belongs to the disc
  EXPECT_EQ(frictionless_groups({0.99, 0.1, 0.5, 0.49, 0.}, {F1, F1, F1, T12, T12}),
            (std::vector<std::string>{"disc", "F1", "disc", "T12", "T12"}));
}

TEST(ModeGroups, WithFriction)
{
  const double               omega  = 2e4;
  const auto                 growth = [omega](const double xi) { return Complex(xi * omega, omega); };
  const std::vector<Complex> lambda = {growth(1e-2), growth(1e-2), growth(0.9e-4), growth(1.1e-4), growth(0.), growth(-1e-2)};
  EXPECT_EQ(friction_groups({0.7, 0.3, 0.3, 0.3, 0.3, 0.1}, lambda, {true, true, true, true, false, false}),
            (std::vector<std::string>{"disc", "unstable pins", "weakly unstable pins", "unstable pins", "other pins", "other pins"}));
}
