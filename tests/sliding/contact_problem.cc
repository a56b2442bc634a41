#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/dense_lu.h>
#include <squeal/sliding/contact_problem.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace Squeal;

namespace
{
  DenseMatrix matrix(const std::vector<std::vector<double>> &rows)
  {
    DenseMatrix A = DenseMatrix::Zero(rows.size(), rows.empty() ? 0 : rows.front().size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t j = 0; j < rows[i].size(); ++j)
        A(i, j) = rows[i][j];
    return A;
  }

  /// Nodes pressed by one backplate with a given load.
  ContactProblem pressed(const DenseMatrix         &F_nn,
                         const DenseMatrix         &F_nt,
                         const double               mu,
                         const std::vector<double> &gap,
                         const double               load)
  {
    const int      n = gap.size();
    ContactProblem problem{F_nn, F_nt, mu, gap, DenseMatrix::Zero(n, 1), DenseMatrix::Zero(1, n), {load}, {}};
    for (int c = 0; c < n; ++c)
      {
        problem.motions(c, 0) = 1.;
        problem.balance(0, c) = -1.;
      }
    return problem;
  }

  /// Random flexibilities: F_nn symmetric positive definite, F_nt arbitrary.
  ContactProblem random_problem(const unsigned int seed, const int n, const double mu)
  {
    std::mt19937                           generator(seed);
    std::uniform_real_distribution<double> uniform(-1., 1.);
    DenseMatrix                            X = DenseMatrix::Zero(n, n), F_nt = DenseMatrix::Zero(n, n);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        {
          X(i, j)    = uniform(generator);
          F_nt(i, j) = uniform(generator);
        }
    DenseMatrix F_nn = X.transpose() * X;
    for (int i = 0; i < n; ++i)
      F_nn(i, i) += 1.;
    std::vector<double> gap;
    for (int i = 0; i < n; ++i)
      gap.push_back(-2. * std::abs(uniform(generator)));
    return pressed(F_nn, F_nt, mu, gap, 3.);
  }

  struct Enumerated
  {
    std::vector<std::vector<double>> reactions;
  };

  /// All solutions, from all 2^n active sets.
  Enumerated enumerate(const ContactProblem &problem)
  {
    const int         n = problem.initial_gap.size(), n_z = problem.forces.size();
    const DenseMatrix G = problem.flexibility(problem.friction_coefficient);
    Enumerated        result;
    for (unsigned int set = 0; set < 1u << n; ++set)
      {
        // One equation per node, g = 0 or r = 0, in all unknowns r, z
        DenseMatrix A = DenseMatrix::Zero(n + n_z, n + n_z), b = DenseMatrix::Zero(n + n_z, 1);
        for (int i = 0; i < n; ++i)
          if (set >> i & 1)
            {
              for (int j = 0; j < n; ++j)
                A(i, j) = G(i, j);
              for (int k = 0; k < n_z; ++k)
                A(i, n + k) = problem.motions(i, k);
              b(i, 0) = -problem.initial_gap[i];
            }
          else
            A(i, i) = 1.;
        for (int k = 0; k < n_z; ++k)
          {
            for (int j = 0; j < n; ++j)
              A(n + k, j) = problem.balance(k, j);
            b(n + k, 0) = problem.forces[k];
          }
        try
          {
            b = regular_lu(A, "test").solve(b);
          }
        catch (const SolverError &)
          {
            continue;
          }
        bool admissible = true;
        for (int i = 0; i < n; ++i)
          {
            double g = problem.initial_gap[i];
            for (int j = 0; j < n; ++j)
              g += G(i, j) * b(j, 0);
            for (int k = 0; k < n_z; ++k)
              g += problem.motions(i, k) * b(n + k, 0);
            admissible = admissible && b(i, 0) < 1e-12 && g < 1e-12;
          }
        if (!admissible)
          continue;
        const std::vector<double> r(b.data(), b.data() + n);
        bool                      is_new = true;
        for (const auto &other : result.reactions)
          {
            double difference = 0.;
            for (int i = 0; i < n; ++i)
              difference = std::max(difference, std::abs(other[i] - r[i]));
            is_new = is_new && difference > 1e-9;
          }
        if (is_new)
          result.reactions.push_back(r);
      }
    return result;
  }
} // namespace

TEST(ContactProblem, TwoSpringsClosedForm)
{
  // Springs of flexibility 1 and 2 under one plate, the second with a gap of 3: it closes when the first is compressed by 3.
  const DenseMatrix F = matrix({{1., 0.}, {0., 2.}}), zero = DenseMatrix::Zero(2, 2);
  const auto        light = solve_contact(pressed(F, zero, 0.4, {0., -3.}, 2.));
  EXPECT_EQ(light.closed, (std::vector<bool>{true, false}));
  EXPECT_DOUBLE_EQ(light.reactions[0], -2.);
  EXPECT_EQ(light.reactions[1], 0.);
  EXPECT_DOUBLE_EQ(light.motions[0], 2.);
  EXPECT_DOUBLE_EQ(light.gaps[1], -1.);

  // 1·r_1 = d, 2·r_2 = d − 3, r_1 + r_2 = 9: d = 7
  const auto heavy = solve_contact(pressed(F, zero, 0.4, {0., -3.}, 9.));
  EXPECT_DOUBLE_EQ(heavy.motions[0], 7.);
  EXPECT_DOUBLE_EQ(heavy.reactions[0], -7.);
  EXPECT_DOUBLE_EQ(heavy.reactions[1], -2.);
  EXPECT_EQ(heavy.gaps[1], 0.);
}

TEST(ContactProblem, FrictionTiltsABlock)
{
  // A rigid block that is free to turn, on two springs at ±a, pushed at height h: moments about that height give
  // r_{1,2} = −½ (1 ± μ h/a), and beyond μ h = a the block topples.
  const double a = 1., h = 2.;
  for (const double mu : {0., 0.2, 0.4, 0.6})
    {
      const ContactProblem problem{matrix({{1., 0.}, {0., 1.}}),
                                   DenseMatrix::Zero(2, 2),
                                   mu,
                                   {0., 0.},
                                   matrix({{1., a}, {1., -a}}),
                                   matrix({{-1., -1.}, {-(a - mu * h), a + mu * h}}),
                                   {1., 0.},
                                   {}};
      if (mu * h < a)
        {
          const auto solution = solve_contact(problem);
          EXPECT_NEAR(solution.reactions[0], -0.5 * (1. + mu * h / a), 1e-15);
          EXPECT_NEAR(solution.reactions[1], -0.5 * (1. - mu * h / a), 1e-15);
        }
      else
        EXPECT_THROW(solve_contact(problem), SolverError); // it topples: no state at all
    }
}

TEST(ContactProblem, FindsWhatEnumerationFinds)
{
  int n_unique = 0, n_several = 0;
  for (unsigned int seed = 1; seed <= 200; ++seed)
    {
      const double         mu         = 0.03 * seed;
      const ContactProblem problem    = random_problem(seed, 6, mu);
      const Enumerated     enumerated = enumerate(problem);
      SCOPED_TRACE(seed);
      const auto solution   = solve_contact(problem);
      const auto uniqueness = contact_uniqueness(problem, solution, 20);
      double     smallest   = 1.;
      for (const auto &r : enumerated.reactions)
        {
          double difference = 0.;
          for (int i = 0; i < 6; ++i)
            difference = std::max(difference, std::abs(r[i] - solution.reactions[i]));
          smallest = std::min(smallest, difference);
        }
      EXPECT_LT(smallest, 1e-9);
      for (int c = 0; c < 6; ++c)
        {
          EXPECT_LE(solution.reactions[c], 0.);
          EXPECT_LE(solution.gaps[c], 0.);
          EXPECT_EQ(solution.reactions[c] * solution.gaps[c], 0.);
        }
      if (uniqueness.is_certified)
        {
          EXPECT_EQ(enumerated.reactions.size(), 1u);
          ++n_unique;
        }
      if (uniqueness.found_other)
        {
          EXPECT_GT(enumerated.reactions.size(), 1u);
          ++n_several;
        }
    }
  // Both cases must have occurred, or the test shows nothing.
  EXPECT_GT(n_unique, 10);
  EXPECT_GT(n_several, 0);
}

TEST(ContactProblem, BoundOfUniquenessIsWhereTheSymmetricPartLosesDefiniteness)
{
  // G = [1 μ; −3μ 1]: the symmetric part has eigenvalues 1 ± μ
  const DenseMatrix F_nn = matrix({{1., 0.}, {0., 1.}}), F_nt = matrix({{0., 1.}, {-3., 0.}});
  for (const double mu : {0.5, 0.99, 1.01})
    {
      const ContactProblem problem    = pressed(F_nn, F_nt, mu, {0., 0.}, 1.);
      const auto           uniqueness = contact_uniqueness(problem, solve_contact(problem));
      EXPECT_NEAR(uniqueness.unique_below, 1., 1e-14);
      EXPECT_EQ(uniqueness.is_certified, mu < 1.);
    }
}
