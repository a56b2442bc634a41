// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/dense_lu.h>
#include <squeal/sliding/contact_problem.h>
#include <squeal/sliding/floating_disc.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace Squeal;

namespace
{
  /// Nodes pressed by one backplate with a given load.
  ContactProblem pressed(const DenseMatrix         &F_nn,
                         const DenseMatrix         &F_nt,
                         const double               mu,
                         const std::vector<double> &gap,
                         const double               load)
  {
    const int n = gap.size();
    return {F_nn, F_nt, mu, gap, DenseMatrix::Ones(n, 1), -DenseMatrix::Ones(1, n), {load}, {}};
  }

  /// A disc of mass 1 / @p unit² that floats between two backplates, with three nodes per side and rounding errors in the rigid-body
  /// motions.
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

  /// Random flexibilities: F_nn symmetric positive definite, F_nt arbitrary.
  ContactProblem random_problem(const unsigned int seed, const int n, const double mu)
  {
    std::mt19937                           generator(seed);
    std::uniform_real_distribution<double> uniform(-1., 1.);
    const auto                             random = [&](int, int) { return uniform(generator); };
    const DenseMatrix                      X = DenseMatrix::NullaryExpr(n, n, random), F_nt = DenseMatrix::NullaryExpr(n, n, random);
    std::vector<double>                    gap;
    for (int i = 0; i < n; ++i)
      gap.push_back(-2. * std::abs(uniform(generator)));
    return pressed(X.transpose() * X + DenseMatrix::Identity(n, n), F_nt, mu, gap, 3.);
  }

  /// Reactions of all solutions, from all 2^n active sets.
  std::vector<DenseMatrix> enumerate(const ContactProblem &problem)
  {
    const int                n = problem.initial_gap.size(), n_z = problem.forces.size();
    const DenseMatrix        G = problem.flexibility(problem.friction_coefficient), gap = as_column(problem.initial_gap);
    std::vector<DenseMatrix> result;
    for (unsigned int set = 0; set < 1u << n; ++set)
      {
        // One equation for each node, g = 0 or r = 0, in the unknowns r and z
        DenseMatrix A = DenseMatrix::Zero(n + n_z, n + n_z), b = DenseMatrix::Zero(n + n_z, 1);
        for (int i = 0; i < n; ++i)
          if (set >> i & 1)
            {
              A.row(i) << G.row(i), problem.motions.row(i);
              b(i, 0) = -gap(i, 0);
            }
          else
            A(i, i) = 1.;
        A.bottomLeftCorner(n_z, n) = problem.balance;
        b.bottomRows(n_z)          = as_column(problem.forces);
        try
          {
            b = regular_lu(A, "test").solve(b);
          }
        catch (const SolverError &)
          {
            continue;
          }
        const DenseMatrix r = b.topRows(n), g = gap + G * r + problem.motions * b.bottomRows(n_z);
        if (r.maxCoeff() < 1e-12 && g.maxCoeff() < 1e-12 &&
            std::all_of(result.begin(), result.end(), [&](const DenseMatrix &other) { return max_norm(other - r) > 1e-9; }))
          result.push_back(r);
      }
    return result;
  }
} // namespace

TEST(ContactProblem, TwoSpringsClosedForm)
{
  // Springs of flexibility 1 and 2 under one plate; the second has a gap of 3 and closes when the first is compressed by 3
  const DenseMatrix F{{1., 0.}, {0., 2.}}, zero = DenseMatrix::Zero(2, 2);
  const auto        light = solve_contact(pressed(F, zero, 0.4, {0., -3.}, 2.));
  EXPECT_EQ(light.closed, (std::vector<bool>{true, false}));
  EXPECT_DOUBLE_EQ(light.reactions[0], -2.);
  EXPECT_EQ(light.reactions[1], 0.);
  EXPECT_DOUBLE_EQ(light.motions[0], 2.);
  EXPECT_DOUBLE_EQ(light.gaps[1], -1.);

  // Expect 1·r_1 = d, 2·r_2 = d − 3, r_1 + r_2 = 9, hence d = 7
  const auto heavy = solve_contact(pressed(F, zero, 0.4, {0., -3.}, 9.));
  EXPECT_DOUBLE_EQ(heavy.motions[0], 7.);
  EXPECT_DOUBLE_EQ(heavy.reactions[0], -7.);
  EXPECT_DOUBLE_EQ(heavy.reactions[1], -2.);
  EXPECT_EQ(heavy.gaps[1], 0.);
}

TEST(ContactProblem, FrictionTiltsABlock)
{
  // A rigid block on two springs at ±a, pushed at height h: moment balance gives r_{1,2} = −½ (1 ± μ h/a). For μ h > a, the block topples.
  const double      a = 1., h = 2.;
  const DenseMatrix F = DenseMatrix::Identity(2, 2), zero = DenseMatrix::Zero(2, 2), motions{{1., a}, {1., -a}};
  for (const double mu : {0., 0.2, 0.4, 0.6})
    {
      const DenseMatrix    balance{{-1., -1.}, {-(a - mu * h), a + mu * h}};
      const ContactProblem problem{F, zero, mu, {0., 0.}, motions, balance, {1., 0.}, {}};
      if (mu * h < a)
        {
          const auto solution = solve_contact(problem);
          EXPECT_NEAR(solution.reactions[0], -0.5 * (1. + mu * h / a), 1e-15);
          EXPECT_NEAR(solution.reactions[1], -0.5 * (1. - mu * h / a), 1e-15);
        }
      else
        EXPECT_THROW(solve_contact(problem), SolverError);
    }
}

TEST(ContactProblem, FindsWhatEnumerationFinds)
{
  int n_unique = 0, n_several = 0;
  for (unsigned int seed = 1; seed <= 200; ++seed)
    {
      SCOPED_TRACE(seed);
      const ContactProblem problem    = random_problem(seed, 6, 0.03 * seed);
      const auto           all        = enumerate(problem);
      const auto           solution   = solve_contact(problem);
      const auto           uniqueness = contact_uniqueness(problem, solution, 20);
      EXPECT_TRUE(
        std::any_of(all.begin(), all.end(), [&](const DenseMatrix &r) { return max_norm(r - as_column(solution.reactions)) < 1e-9; }));
      for (int c = 0; c < 6; ++c)
        {
          EXPECT_LE(solution.reactions[c], 0.);
          EXPECT_LE(solution.gaps[c], 0.);
          EXPECT_EQ(solution.reactions[c] * solution.gaps[c], 0.);
        }
      EXPECT_TRUE(!uniqueness.meets_condition || all.size() == 1);
      EXPECT_TRUE(!uniqueness.found_other || all.size() > 1);
      n_unique += uniqueness.meets_condition;
      n_several += uniqueness.found_other;
    }
  // The test is meaningful only if both cases occur
  EXPECT_GT(n_unique, 10);
  EXPECT_GT(n_several, 0);
}

TEST(ContactProblem, BoundOfUniquenessIsWhereTheSymmetricPartLosesDefiniteness)
{
  // G = [1 μ; −3μ 1]: the symmetric part has eigenvalues 1 ± μ
  for (const double mu : {0.5, 0.99, 1.01})
    {
      const ContactProblem problem    = pressed(DenseMatrix::Identity(2, 2), DenseMatrix{{0., 1.}, {-3., 0.}}, mu, {0., 0.}, 1.);
      const auto           uniqueness = contact_uniqueness(problem, solve_contact(problem));
      EXPECT_NEAR(uniqueness.unique_below, 1., 1e-14);
      EXPECT_EQ(uniqueness.meets_condition, mu < 1.);
    }
}

TEST(FloatingDisc, IsHeldWhateverRoundingLeaves)
{
  // Only the axial travel of the disc is undetermined: holding the disc does not change the reactions
  for (const double unit : {1e-6, 0.07, 1., 1e6})
    {
      for (unsigned int seed = 0; seed < 50; ++seed)
        {
          ContactProblem problem = floating(unit, 0., seed, {600., 600.});
          hold_undetermined_motion(problem, 2);
          ASSERT_EQ(problem.held, std::vector<int>{2}) << unit << ' ' << seed;
          for (const double r : solve_contact(problem).reactions)
            EXPECT_NEAR(r, -200., 1e-9);
        }
      // The travel of a tilted disc changes the gaps and is therefore determined
      ContactProblem tilted = floating(unit, 1e-3, 1, {600., 600.});
      hold_undetermined_motion(tilted, 2);
      EXPECT_TRUE(tilted.held.empty());
      // Loads that do not balance, and loads that balance within the tolerance
      ContactProblem unbalanced = floating(unit, 0., 1, {600., 600.000001}), balanced = floating(unit, 0., 1, {600., 600.00000001});
      EXPECT_THROW(hold_undetermined_motion(unbalanced, 2), SolverError);
      EXPECT_NO_THROW(hold_undetermined_motion(balanced, 2));
    }
}
