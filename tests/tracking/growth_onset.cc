#include <squeal/base/conventions.h>
#include <squeal/tracking/branches.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace Squeal;

namespace
{
  using Complex = std::complex<double>;

  /// Modes that do not interact, each with its λ(μ); what is found of them is off by an error of which is known how large it is.
  struct GivenModes
  {
    std::vector<std::function<Complex(double)>> lambda;
    Complex                                     error = 0.; ///< [rad/s]
    ChartOptions                                options{10., 1e-10};

    std::vector<ChartPoint> operator()(const std::vector<double> &values) const
    {
      std::vector<ChartPoint> points;
      for (const double mu : values)
        {
          const int                k = lambda.size();
          const ComplexDenseMatrix I = ComplexDenseMatrix::Identity(k, k);
          std::vector<int>         order(k);
          for (int j = 0; j < k; ++j)
            order[j] = j;
          std::sort(order.begin(), order.end(), [&](const int a, const int b) { return lambda[a](mu).imag() < lambda[b](mu).imag(); });
          ChartPoint point;
          point.friction_coefficient = mu;
          point.right = point.left = I(Eigen::all, order);
          point.corrections        = ComplexDenseMatrix::Zero(k, k);
          for (const int j : order)
            {
              point.lambda.push_back(lambda[j](mu) + error);
              point.uncertainties.push_back(std::abs(error));
              point.errors.push_back(std::abs(error) / std::abs(point.lambda.back()));
              point.verdicts.push_back(verdict_of(point.lambda.back(), std::abs(error)));
            }
          points.push_back(point);
        }
      return points;
    }

    StabilityChart chart(const std::vector<double> &grid) const
    {
      return stability_chart(grid, *this, options);
    }

    std::optional<GrowthOnset> weak(const StabilityChart &chart, const double before = 0.) const
    {
      return onset_beyond(weak_divergence, chart, *this, options, before);
    }
  };

  /// λ at a frequency with ξ = slope (μ − begin).
  std::function<Complex(double)> growing(const double omega, const double slope, const double begin)
  {
    return [=](const double mu) { return Complex(omega * slope * (mu - begin), omega); };
  }
} // namespace

TEST(GrowthOnset, LiesBetweenTheValuesOfTheChart)
{
  // At 0.6 the second mode grows faster, but the first one has reached the level before it, and grows from 0.33 on
  const GivenModes     modes{{growing(5., 1e-3, 0.33), growing(7., 4e-3, 0.41)}};
  const StabilityChart chart = modes.chart({0., 0.3, 0.6});
  const auto           first = first_onset(chart, 10., 0.), weak = modes.weak(chart);
  ASSERT_TRUE(first && weak);
  EXPECT_NEAR(first->friction_coefficient, 0.33, 1e-9);
  EXPECT_NEAR(weak->friction_coefficient, 0.43, 1e-9);
  for (const GrowthOnset &onset : {*first, *weak})
    {
      EXPECT_LT(onset.uncertainty, 1e-8);
      EXPECT_NEAR(onset.lambda.imag(), 5., 1e-12);
      EXPECT_NEAR(chart.points[0].lambda[chart.branches[onset.branch].modes[0]].imag(), 5., 1e-12);
    }
  ASSERT_FALSE(chart.thresholds.empty());
  EXPECT_EQ(first->friction_coefficient, chart.thresholds.front().friction_coefficient);
}

TEST(GrowthOnset, UncertaintyCoversTheErrorOfLambda)
{
  for (const double error : {-1e-6, 1e-5})
    {
      const GivenModes     modes{{growing(5., 1e-3, 0.33)}, error};
      const StabilityChart chart = modes.chart({0., 0.3, 0.6});
      const auto           weak  = modes.weak(chart);
      ASSERT_TRUE(weak);
      EXPECT_GT(std::abs(weak->friction_coefficient - 0.43), 1e-5);
      EXPECT_LE(std::abs(weak->friction_coefficient - 0.43), weak->uncertainty);
      EXPECT_LT(weak->uncertainty, 0.01);
    }
}

TEST(GrowthOnset, GrowthAtTheFirstValueBeganBefore)
{
  const GivenModes     modes{{growing(5., 1e-3, 0.2)}};
  const StabilityChart chart = modes.chart({0.5, 0.6});
  for (const auto &onset : {first_onset(chart, 10., 0.1), modes.weak(chart, 0.1)})
    {
      ASSERT_TRUE(onset);
      EXPECT_EQ(onset->friction_coefficient, 0.5);
      EXPECT_NEAR(onset->uncertainty, 0.4, 1e-15);
    }
}

TEST(GrowthOnset, ModesThatEnterTheBandCountFromThereOn)
{
  // Grows from 0.05 on and reaches the band at 0.25; another mode grows beyond the band only
  const auto           entering = [](const double mu) { return Complex(0.1 * (mu - 0.05), 12. - 8. * mu); };
  const GivenModes     modes{{entering, growing(13., 1e-2, 0.01)}};
  const StabilityChart chart = modes.chart({0., 0.2, 0.4, 0.6});
  for (const auto &onset : {first_onset(chart, 10., 0.), modes.weak(chart)})
    {
      ASSERT_TRUE(onset);
      EXPECT_NEAR(onset->friction_coefficient, 0.25, 1e-9);
      EXPECT_NEAR(onset->lambda.imag(), 10., 2.);
    }
}

TEST(GrowthOnset, NothingWhereGrowthIsUndecidedOrWeak)
{
  const GivenModes undecided{{growing(5., 1e-3, 0.33)}, 1e-2}, weak{{growing(5., 1e-4, 0.33)}};
  EXPECT_FALSE(first_onset(undecided.chart({0., 0.3, 0.6}), 10., 0.));
  const StabilityChart chart = weak.chart({0., 0.3, 0.6});
  EXPECT_TRUE(first_onset(chart, 10., 0.));
  EXPECT_FALSE(weak.weak(chart));
}
