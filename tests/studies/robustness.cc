// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/studies/robustness/uncertainty.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace Squeal;

namespace
{
  const Squeal::Distribution from_minus_pi = {DistributionKind::uniform, {-M_PI, M_PI}};

  RobustnessParameters with(const std::string &distributions, const std::string &correlations = "")
  {
    RobustnessParameters result;
    result.distributions = distributions;
    result.correlations  = correlations;
    return result;
  }

  double mean(const Eigen::VectorXd &x)
  {
    return x.mean();
  }

  double deviation(const Eigen::VectorXd &x)
  {
    return std::sqrt((x.array() - x.mean()).square().mean());
  }
} // namespace

// Test function of Ishigami and Homma (1990), sin x + a sin² y + b z⁴ sin x
TEST(Robustness, SobolIndicesOfIshigami)
{
  constexpr double  a = 7., b = 0.1;
  const DenseMatrix samples = saltelli_samples({from_minus_pi, from_minus_pi, from_minus_pi}, 6000, 1);
  ASSERT_EQ(samples.rows(), 6000 * 5);
  std::vector<double> outputs;
  for (Eigen::Index i = 0; i < samples.rows(); ++i)
    outputs.push_back(std::sin(samples(i, 0)) * (1. + b * std::pow(samples(i, 2), 4)) + a * std::pow(std::sin(samples(i, 1)), 2));
  const SobolIndices found = sobol_indices(samples, outputs);

  const double x = 0.5 * std::pow(1. + b * std::pow(M_PI, 4) / 5., 2), y = a * a / 8., xz = b * b * std::pow(M_PI, 8) * 8. / 225.;
  const std::vector<double> first = {x, y, 0.}, total = {x + xz, y, xz};
  for (const std::size_t i : {0, 1, 2})
    for (const auto &[estimate, exact] : {std::make_pair(found.first[i], first[i]), {found.total[i], total[i]}})
      {
        EXPECT_GE(exact / (x + y + xz), estimate.lower) << i;
        EXPECT_LE(exact / (x + y + xz), estimate.upper) << i;
        EXPECT_LT(estimate.upper - estimate.lower, 0.15);
      }
}

TEST(Robustness, SamplesHaveTheirDistributions)
{
  const std::vector<Squeal::Distribution> distributions = {{DistributionKind::uniform, {1., 3.}},
                                                           {DistributionKind::normal, {5., 0.5}},
                                                           {DistributionKind::normal, {0., 1., 0., 9.}},
                                                           {DistributionKind::lognormal, {2., 0.4}},
                                                           {DistributionKind::table, {1., 2., 6.}}};
  DenseMatrix                             correlations  = DenseMatrix::Identity(5, 5);
  correlations(0, 1) = correlations(1, 0) = 0.8;
  const DenseMatrix X                     = independent_samples(distributions, correlations, 40000, 3);
  EXPECT_EQ(X, independent_samples(distributions, correlations, 40000, 3));
  const double means[]      = {2., 5., std::sqrt(2. / M_PI), 2., 3.};
  const double deviations[] = {2. / std::sqrt(12.), 0.4933, std::sqrt(1. - 2. / M_PI), 0.4, std::sqrt(14. / 3.)};
  for (const int j : {0, 1, 2, 3, 4})
    {
      EXPECT_NEAR(mean(X.col(j)), means[j], 4. * deviations[j] / 200.) << j;
      EXPECT_NEAR(deviation(X.col(j)), deviations[j], 0.03 * deviations[j]) << j;
    }
  EXPECT_LE(X.col(1).maxCoeff(), 6.5);
  EXPECT_GE(X.col(2).minCoeff(), 0.);
  const Eigen::VectorXd x = X.col(0).array() - X.col(0).mean(), y = X.col(1).array() - X.col(1).mean();
  // A uniform and a normal variable with normal-score correlation 0.8 have the correlation 0.8 √(3/π), apart from truncation
  EXPECT_NEAR(x.dot(y) / (x.norm() * y.norm()), 0.8 * std::sqrt(3. / M_PI), 0.02);
  correlations(0, 2) = correlations(2, 0) = 0.9;
  EXPECT_THROW(independent_samples(distributions, correlations, 10, 0), ParameterError);
}

TEST(Robustness, ProbabilityWithItsInterval)
{
  const Estimate some = probability(20, 100); // from the tables of Clopper and Pearson
  EXPECT_NEAR(some.lower, 0.1267, 5e-5);
  EXPECT_NEAR(some.upper, 0.2918, 5e-5);
  EXPECT_EQ(probability(0, 50).lower, 0.);
  EXPECT_NEAR(probability(0, 50).upper, 1. - std::pow(0.025, 1. / 50.), 1e-12);
  EXPECT_EQ(quantile({1., 2., 4.}, 0.5), 2.);
  EXPECT_EQ(quantile({1., 2., 4.}, 0.75), 3.);
}

TEST(Robustness, Distributions)
{
  const auto found = with("A/B = uniform 80 % to 120 %; A/C = normal 5, 1 in 4 to 7 for each pin; D = table 1, 2").uncertain_parameters();
  ASSERT_EQ(found.size(), 3u);
  EXPECT_TRUE(found[0].is_relative);
  EXPECT_EQ(found[1].distribution.numbers, (std::vector<double>{5., 1., 4., 7.}));
  EXPECT_TRUE(found[1].for_each_pin);
  EXPECT_EQ(found[2].distribution.kind, DistributionKind::table);
  EXPECT_EQ(with("a = uniform 0 to 1; b = uniform 0 to 1", "a, b = -0.5").parsed_correlations().front().value, -0.5);
  for (const char *wrong :
       {"", "A", "A = ", "A = gaussian 1, 2", "A = uniform 1", "A = uniform 2 to 1", "A = uniform 1 to 1", "A = normal 1, 0",
        "A = normal 1, nan", "A = lognormal -1, 1", "A = table 1", "A = uniform 80 % to 120", "A = uniform 0 to 1 in 0 to 2",
        "A = normal 0, 1 in 3 to 2", "A = normal 0, 1 in 50 to 60", "A = uniform 0 to 1; A = uniform 0 to 2", "= uniform 0 to 1"})
    EXPECT_THROW(with(wrong).uncertain_parameters(), ParameterError) << wrong;
  for (const char *wrong : {"a, b = 1", "a = 0.5", "a, c = 0.5", "a, a = 0.5", "a, b = x"})
    EXPECT_THROW(with("a = uniform 0 to 1; b = uniform 0 to 1", wrong).parsed_correlations(), ParameterError) << wrong;
}
