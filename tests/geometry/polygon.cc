#include <squeal/geometry/polygon.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace Squeal;

namespace
{
  using Points = std::vector<dealii::Point<2>>;
  using Nodes  = std::vector<unsigned int>;

  /// Points of an ellipse about (3, -2) radii, seen under the given angles.
  Points on_ellipse(const double radius, const double ratio, const std::vector<double> &angles)
  {
    Points points;
    for (const double angle : angles)
      points.emplace_back(radius * (3. + std::cos(angle)), radius * (-2. + ratio * std::sin(angle)));
    return points;
  }
} // namespace

TEST(Polygon, EdgesOfAClosedCurveAreTracedInAnyOrderAndSense)
{
  EXPECT_EQ(closed_polygon({{{7, 4}}, {{2, 9}}, {{4, 2}}, {{9, 7}}}), (Nodes{2, 9, 7, 4}));
  EXPECT_EQ(closed_polygon({{{5, 6}}, {{6, 8}}, {{8, 5}}}), (Nodes{5, 6, 8}));
}

TEST(Polygon, OpenCurvesBranchesAndTwoCurvesAreNone)
{
  EXPECT_TRUE(closed_polygon({}).empty());
  EXPECT_TRUE(closed_polygon({{{0, 1}}, {{1, 2}}}).empty());
  EXPECT_TRUE(closed_polygon({{{0, 1}}, {{1, 2}}, {{2, 0}}, {{2, 3}}}).empty());
  EXPECT_TRUE(closed_polygon({{{0, 1}}, {{1, 2}}, {{2, 0}}, {{3, 4}}, {{4, 5}}, {{5, 3}}}).empty());
}

TEST(Polygon, AreaHasTheSignOfTheSense)
{
  const Points points = {{0., 0.}, {2., 0.}, {2., 3.}, {1., 1.}};
  EXPECT_DOUBLE_EQ(signed_area(Nodes{0, 1, 2, 3}, points), 2.5);
  EXPECT_DOUBLE_EQ(signed_area(std::array<unsigned int, 4>{{3, 2, 1, 0}}, points), -2.5);
}

TEST(Polygon, CirclesAreFoundInAnyUnitOfLengthAndFromArcs)
{
  for (const double radius : {2.6e-8, 0.026, 1.5e5})
    for (const double step : {1., 0.1})
      {
        const auto circle = circle_through(on_ellipse(radius, 1., {0., step, 2. * step, 3. * step, 4. * step, 5. * step}));
        ASSERT_TRUE(circle) << radius << ", " << step;
        EXPECT_NEAR(circle->radius / radius, 1., 1e-10);
        EXPECT_NEAR(circle->centre[0] / radius, 3., 1e-10);
        EXPECT_NEAR(circle->centre[1] / radius, -2., 1e-10);
      }
}

TEST(Polygon, WhatIsNotRoundOrHasTooFewPointsGivesNoCircle)
{
  const std::vector<double> angles = {0., 1., 2., 3., 4., 5.};
  EXPECT_TRUE(circle_through(on_ellipse(0.026, 1. + 1e-7, angles)));
  EXPECT_FALSE(circle_through(on_ellipse(0.026, 1. + 1e-5, angles)));
  EXPECT_FALSE(circle_through({}));
  // Corners of a square, each twice; one point; a straight line
  EXPECT_FALSE(circle_through({{0., 0.}, {1., 0.}, {1., 1.}, {0., 1.}, {0., 0.}, {1., 0.}, {1., 1.}, {0., 1.}}));
  EXPECT_FALSE(circle_through(Points(6, {1., 2.})));
  EXPECT_FALSE(circle_through({{0., 0.}, {1., 1.}, {2., 2.}, {3., 3.}, {4., 4.}, {5., 5.}, {6., 6.}}));
}
