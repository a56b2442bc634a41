#include "solutions.h"

#include <squeal/estimates/body_frames.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /// An annulus with a pin on either side.
  HexMesh mesh()
  {
    const std::vector<PolarPin> pins = {{Plan::Side::top, -1, 2, 1, 1}, {Plan::Side::bottom, -1, 2, 1, 1}};
    return extrude(polar_plan(0.15, 0.30, 3, 24, pins), layers(2, 3));
  }

  /// The same with another width of the disc, another thickness of everything, and turned.
  HexMesh other(HexMesh mesh, const double angle)
  {
    for (HexMesh::Point &x : mesh.points)
      {
        const double r = std::hypot(x[0], x[1]), theta = std::atan2(x[1], x[0]) + angle, new_r = 0.1 + 2. * (r - 0.15);
        x = HexMesh::Point(new_r * std::cos(theta), new_r * std::sin(theta), 1.5 * x[2]);
      }
    return mesh;
  }
} // namespace

TEST(BodyFrames, CarryPointsToTheSamePlacesOfADisc)
{
  const HexMesh      one = mesh(), two = other(one, 0.);
  const Model        from(one, Element::trilinear, MPI_COMM_WORLD), to(two, Element::trilinear, MPI_COMM_WORLD);
  const CommonPoints points = common_points(from, mounted(), 1), carried = carried_over(points, body_frames(from), body_frames(to));
  ASSERT_EQ(carried.bodies.size(), 3u);
  EXPECT_EQ(carried.bodies[0].masses, points.bodies[0].masses);
  for (std::size_t q = 0; q < points.bodies[0].points.size(); ++q)
    {
      const auto  &x = points.bodies[0].points[q], &y = carried.bodies[0].points[q];
      const double r = std::hypot(x[0], x[1]);
      EXPECT_NEAR(std::hypot(y[0], y[1]), 0.1 + 2. * (r - 0.15), 1e-14);
      EXPECT_NEAR(std::atan2(y[1], y[0]), std::atan2(x[1], x[0]), 1e-13);
      EXPECT_NEAR(y[2], 1.5 * x[2], 1e-14);
    }
}

TEST(BodyFrames, LeaveOutBodiesThatTheOtherDesignLacks)
{
  const HexMesh          one = mesh();
  const Model            from(one, Element::trilinear, MPI_COMM_WORLD);
  std::vector<BodyFrame> frames = body_frames(from), fewer = frames;
  fewer.erase(fewer.begin() + 1);
  const CommonPoints points = common_points(from, mounted(), 1), carried = carried_over(points, frames, fewer);
  ASSERT_EQ(carried.bodies.size(), 2u);
  EXPECT_EQ(carried.bodies[1].name, points.bodies[2].name);
  EXPECT_EQ(carried.bodies[1].points, points.bodies[2].points);
}

TEST(CylindricalDirections, FollowATurnedScene)
{
  // The same displacement, turned with the scene, has the same components
  const HexMesh one = mesh(), two = [&] {
    HexMesh turned = one;
    for (HexMesh::Point &x : turned.points)
      x = HexMesh::Point(-x[1], x[0], x[2]);
    return turned;
  }();
  const Model  from(one, Element::trilinear, MPI_COMM_WORLD), to(two, Element::trilinear, MPI_COMM_WORLD);
  CommonPoints points = common_points(from, mounted(), 1);
  const auto   E      = displacements_at(points, from, Directions::cylindrical);
  for (CommonPoints::Body &body : points.bodies)
    for (dealii::Point<3> &x : body.points)
      x = dealii::Point<3>(-x[1], x[0], x[2]);
  const auto F      = displacements_at(points, to, Directions::cylindrical);
  const auto field  = [](const Point3 &a) { return Point3{{1. + a[0], 2. * a[1] - a[2], 3. + a[0] * a[2]}}; };
  const auto turned = [&](const Point3 &b) {
    const Point3 value = field({{b[1], -b[0], b[2]}});
    return Point3{{-value[1], value[0], value[2]}};
  };
  const MultiVector u = displacements(from, 0, field), v = displacements(to, 0, turned);
  const MultiVector x = *E * u, y = *F * v;
  EXPECT_GT(x.local().cwiseAbs().maxCoeff(), 0.1);
  EXPECT_LT((x.local() - y.local()).cwiseAbs().maxCoeff(), 1e-12);
}
