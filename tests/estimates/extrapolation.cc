// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/estimates/discretisation_error.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace Squeal;

namespace
{
  std::vector<double> values(const std::vector<double> &widths, const double limit, const double factor, const double order)
  {
    std::vector<double> result;
    for (const double h : widths)
      result.push_back(limit + factor * std::pow(h, order));
    return result;
  }
} // namespace

TEST(Extrapolation, FindsLimitAndOrderForAnyRatiosOfWidths)
{
  for (const std::vector<double> &widths : {std::vector<double>{4., 2., 1.}, {1., 0.7, 0.4}, {0.02, 0.0115, 0.01}, {3., 2.9, 0.1, 0.05}})
    for (const double order : {0.6, 1., 2., 3.7})
      for (const double factor : {3., -0.2})
        {
          const auto          v = values(widths, 2312., factor, order);
          const Extrapolation e = extrapolate(widths, v, 2.);
          ASSERT_TRUE(e.is_trustworthy) << order;
          EXPECT_NEAR(e.order, order, 1e-4);
          EXPECT_NEAR(e.limit, 2312., 1e-6);
          ASSERT_EQ(e.observed_orders.size(), widths.size() - 2);
          for (const auto &observed : e.observed_orders)
            EXPECT_NEAR(observed.value(), order, 1e-4);
          for (std::size_t k = 0; k < v.size(); ++k)
            EXPECT_NEAR(e.errors[k], std::abs(v[k] - 2312.), 1e-6);
        }
}

TEST(Extrapolation, TakesTheAssumedOrderOfTwoValues)
{
  const Extrapolation e = extrapolate({0.3, 0.1}, values({0.3, 0.1}, -1., 5., 4.), 4.);
  EXPECT_NEAR(e.limit, -1., 1e-14);
  EXPECT_FALSE(e.is_trustworthy);
  EXPECT_GT(e.uncertainty, 0.04);
}

TEST(Extrapolation, DistrustsOscillationDivergenceAndOrdersOutOfRange)
{
  for (const std::vector<double> &v :
       {std::vector<double>{1., 2., 1.5}, {1., 2., 4.}, values({4., 2., 1.}, 0., 1., 9.), values({4., 2., 1.}, 0., 1., 0.1)})
    {
      const Extrapolation e = extrapolate({4., 2., 1.}, v, 2.);
      EXPECT_FALSE(e.is_trustworthy);
      EXPECT_EQ(e.order, 2.);
      EXPECT_FALSE(e.observed_orders[0].has_value());
      EXPECT_NEAR(e.limit, v[2] + (v[2] - v[1]) / 3., 1e-14);
      EXPECT_GE(e.uncertainty, std::abs(v[2] - v[1]));
    }
  // Only the three finest values are used
  const Extrapolation recovered = extrapolate({8., 4., 2., 1.}, {100., 16., 4., 1.}, 2.);
  EXPECT_TRUE(recovered.is_trustworthy);
  EXPECT_NEAR(recovered.limit, 0., 1e-12);
}

TEST(Extrapolation, OfEqualValuesIsThatValue)
{
  for (const std::vector<double> &v : {std::vector<double>{0., 0., 0.}, {7., 7., 7.}, {1., 7., 7.}})
    {
      const Extrapolation e = extrapolate({4., 2., 1.}, v, 2.);
      EXPECT_TRUE(e.is_trustworthy);
      EXPECT_EQ(e.limit, v[2]);
      EXPECT_EQ(e.uncertainty, 0.);
      EXPECT_EQ(e.errors[0], std::abs(v[2] - v[0]));
    }
}

TEST(Extrapolation, UncertaintyCoversTheErrorOfTwoTerms)
{
  // The observed order of v + h² + 0.3 h³ is between 2 and 3
  std::vector<double> widths = {0.5, 0.25, 0.125}, v;
  for (const double h : widths)
    v.push_back(10. + h * h + 0.3 * h * h * h);
  const Extrapolation e = extrapolate(widths, v, 2.);
  EXPECT_TRUE(e.is_trustworthy);
  EXPECT_GT(e.order, 2.);
  EXPECT_LT(e.order, 2.2);
  EXPECT_LT(std::abs(e.limit - 10.), e.uncertainty);
  EXPECT_LT(e.uncertainty, 0.2 * std::abs(v[2] - 10.));
}
