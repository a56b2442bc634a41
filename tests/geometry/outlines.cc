// SPDX-License-Identifier: GPL-3.0-or-later

#include "../scenes.h"
#include "scenes.h"

#include <squeal/geometry/pin_grid.h>
#include <squeal/geometry/polygon.h>

using namespace Scenes;

namespace
{

  /// Area [m²] and polar moment about the centroid [m⁴] of an outline.
  std::pair<double, double> area_and_polar_moment(const std::vector<Plan::Edge> &outline, const std::vector<Plan::Point> &points)
  {
    double      area = 0., moment = 0.;
    Plan::Point first;
    for (const auto &[i, j] : outline)
      {
        const Plan::Point &p = points[i], &q = points[j];
        const double       cross = p[0] * q[1] - p[1] * q[0];
        area += cross / 2.;
        first += cross / 6. * (p + q);
        moment += cross / 12. * (p * p + p * q + q * q);
      }
    return {area, moment - first * first / area};
  }

  /// A round plan with polygonal outlines, without curves, and two pins on the same faces.
  Plan polygon_pins(const unsigned int k, const double radius)
  {
    Plan plan   = Testing::round_plan(0.2, radius, k);
    plan.curves = {};
    plan.pins.push_back(plan.pins[0]);
    return plan;
  }

  using Points = std::vector<dealii::Point<2>>;

  /// Points at the given angles on an ellipse whose centre is at (3, −2) radii.
  Points on_ellipse(const double radius, const double ratio, const std::vector<double> &angles)
  {
    Points points;
    for (const double angle : angles)
      points.emplace_back(radius * (3. + std::cos(angle)), radius * (-2. + ratio * std::sin(angle)));
    return points;
  }
} // namespace

TEST(Outlines, RoundPinsGetAreaAndMomentOfTheirCircle)
{
  const double r = 0.026, area = M_PI * r * r, moment = area * r * r / 2.;
  for (const unsigned int k : {1u, 4u})
    {
      const Plan inscribed = polygon_pins(k, r);
      Plan       enlarged  = inscribed;
      enlarge_to_true_area(enlarged);
      const double theta    = M_PI / (3. * k);
      const auto [A_i, J_i] = area_and_polar_moment(boundary_edges(inscribed.faces), inscribed.points);
      const auto [A, J]     = area_and_polar_moment(boundary_edges(enlarged.faces), enlarged.points);
      EXPECT_NEAR(A / area, 1., 1e-13);
      EXPECT_NEAR(J / moment - 1., std::pow(theta, 4) / 180., 0.2 * std::pow(theta, 4) / 180.) << k;
      EXPECT_NEAR(1. - A_i / area, theta * theta / 6., 0.1 * theta * theta) << k;
      EXPECT_NEAR(1. - J_i / moment, theta * theta / 3., 0.1 * theta * theta) << k;
    }
}

TEST(Outlines, MeshesHaveTheVolumeOfDiscAndPins)
{
  GeometryParameters parameters = one_pin();
  parameters.outlines           = Outlines::true_area;
  const Mesh   mesh             = generate_mesh(parameters);
  const double r                = parameters.pin_diameter / 2.;
  EXPECT_NEAR(volume(mesh, "pin_") / (M_PI * r * r * parameters.pin_height), 1., 1e-12);
  const double annulus = M_PI * (std::pow(parameters.disc_outer_radius, 2) - std::pow(parameters.disc_inner_radius, 2));
  EXPECT_NEAR(volume(mesh, "disc") / (annulus * parameters.disc_thickness), 1., 1e-12);
}

TEST(Outlines, OtherShapesStayAsTheyAre)
{
  // A square, an ellipse and an open curve are not circles
  Plan plan = polygon_pins(2, 0.026);
  for (Plan::Point &point : plan.points)
    point[1] *= 1.01;
  plan.curves = {{"disc_rim", {{{0, 1}}, {{1, 2}}}}};
  plan.points.insert(plan.points.end(), {Plan::Point(1., 0.), Plan::Point(0., 1.), Plan::Point(-1., 0.), Plan::Point(0., -1.)});
  const unsigned int n = plan.points.size();
  plan.curves.push_back({"square", {{{n - 4, n - 3}}, {{n - 3, n - 2}}, {{n - 2, n - 1}}, {{n - 1, n - 4}}}});
  const std::vector<Plan::Point> before = plan.points;
  enlarge_to_true_area(plan);
  EXPECT_EQ(plan.points, before);
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

  // No circle is found for points on an ellipse, or for too few, coincident or collinear points
  const std::vector<double> angles = {0., 1., 2., 3., 4., 5.};
  EXPECT_TRUE(circle_through(on_ellipse(0.026, 1. + 1e-7, angles)));
  EXPECT_FALSE(circle_through(on_ellipse(0.026, 1. + 1e-5, angles)));
  const Points line = {{0., 0.}, {1., 1.}, {2., 2.}, {3., 3.}, {4., 4.}, {5., 5.}};
  for (const Points &points : {Points(), Points(6, {1., 2.}), line})
    EXPECT_FALSE(circle_through(points));
}
