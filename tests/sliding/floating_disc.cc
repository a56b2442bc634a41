#include "scenes.h"

#include <squeal/base/exceptions.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/sliding/floating_disc.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /// A disc of mass 1 / @p unit² that floats between two backplates, three nodes on each side; entries of the motions off by rounding.
  ContactProblem floating(const double unit, const double tilt, const unsigned int seed, const std::vector<double> &loads)
  {
    constexpr int  n = 6;
    std::mt19937   generator(seed);
    const auto     rounded = [&](const double x) { return x * (1. + 1e-15 * (static_cast<int>(generator() % 7) - 3)); };
    ContactProblem problem{DenseMatrix::Identity(n, n), DenseMatrix::Zero(n, n), 0.,    std::vector<double>(n, 0.),
                           DenseMatrix::Zero(n, 3),     DenseMatrix::Zero(3, n), loads, {}};
    problem.forces.push_back(0.);
    for (int c = 0; c < n; ++c)
      {
        const int side           = c < 3 ? 0 : 1;
        problem.motions(c, side) = rounded(1.);
        problem.motions(c, 2)    = rounded(unit * ((side == 0 ? 1. : -1.) + tilt * c));
        problem.balance(side, c) = -problem.motions(c, side);
        problem.balance(2, c)    = -problem.motions(c, 2);
      }
    return problem;
  }
} // namespace

TEST(FloatingDisc, IsHeldWhateverRoundingLeaves)
{
  // Nothing but the disc's way along its axis is undetermined: reactions are those of a disc that is held
  for (const double unit : {1e-6, 0.07, 1., 1e6})
    for (unsigned int seed = 0; seed < 50; ++seed)
      {
        ContactProblem problem = floating(unit, 0., seed, {600., 600.});
        hold_undetermined_motion(problem, 2);
        ASSERT_EQ(problem.held, std::vector<int>{2}) << unit << ' ' << seed;
        const ContactSolution solution = solve_contact(problem);
        for (const double r : solution.reactions)
          EXPECT_NEAR(r, -200., 1e-9);
      }
}

TEST(FloatingDisc, IsNotHeldWhereGapsDetermineIt)
{
  for (const double unit : {1e-6, 1., 1e6})
    {
      ContactProblem problem = floating(unit, 1e-3, 1, {600., 600.});
      hold_undetermined_motion(problem, 2);
      EXPECT_TRUE(problem.held.empty());
    }
}

TEST(FloatingDisc, RefusesLoadsThatDoNotBalance)
{
  for (const double unit : {1e-6, 1., 1e6})
    {
      ContactProblem problem = floating(unit, 0., 1, {600., 600.000001});
      EXPECT_THROW(hold_undetermined_motion(problem, 2), SolverError);
      problem = floating(unit, 0., 1, {600., 600.00000001}); // equal but for decimals
      EXPECT_NO_THROW(hold_undetermined_motion(problem, 2));
    }
}

TEST(ContactMotions, OfALevelDisc)
{
  // Three motions press the pins, three slide past them, whatever the basis in which they are given
  const std::vector<PolarPin> pins = {{Plan::Side::top, 0, 2, 1, 1}, {Plan::Side::bottom, 5, 2, 1, 1}};
  const Scene                 s(extrude(polar_plan(0.15, 0.3, 3, 12, pins), layers(1, 2)), mounted({}), operating());
  const auto                  N = free_disc_motions(s.model, s.system);
  ASSERT_TRUE(N);
  ASSERT_EQ(N->n_columns(), 6);
  std::mt19937                           generator(1);
  std::uniform_real_distribution<double> uniform(-1., 1.);
  for (int turn = 0; turn < 20; ++turn)
    {
      DenseMatrix S = DenseMatrix::Zero(6, 6);
      for (int j = 0; j < 6; ++j)
        for (int i = 0; i <= j; ++i)
          S(i, j) = S(j, i) = uniform(generator);
      const DenseMatrix orthogonal   = symmetric_eigenpairs(S).vectors;
      const auto [pressing, sliding] = contact_motions(*s.contact.normal, *N * orthogonal);
      ASSERT_TRUE(pressing && sliding);
      EXPECT_EQ(pressing->n_columns(), 3);
      EXPECT_EQ(sliding->n_columns(), 3);
      EXPECT_LT(max_norm(replicate(*s.contact.normal * *sliding)), 1e-13);
      EXPECT_LT(max_norm(gram(*sliding, *s.system.mass * *sliding) - DenseMatrix::Identity(3, 3)), 1e-12);
    }
}

TEST(ContactMotions, OfADiscThatOnlyTurns)
{
  // All free motions slide: nothing but rounding is left along the normals
  const std::vector<PolarPin> pins = {{Plan::Side::top, 0, 2, 1, 1}};
  const Scene s(extrude(polar_plan(0.15, 0.3, 3, 12, pins), layers(1, 2)), mounted({{"disc_bore", 1e10, 0., 1e10}}), operating());
  const auto  N = free_disc_motions(s.model, s.system);
  ASSERT_TRUE(N);
  ASSERT_EQ(N->n_columns(), 1);
  const auto motions = contact_motions(*s.contact.normal, *N);
  EXPECT_FALSE(motions.pressing);
  EXPECT_TRUE(motions.sliding);
}
