// SPDX-License-Identifier: GPL-3.0-or-later

#include "faces.h"
#include "solutions.h"

#include <squeal/estimates/body_frames.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  const MaterialParameters materials = mounted();

  /// An annulus with opposite pins, whose polygonal outlines depend on the refinement.
  Mesh mesh(const int refinement, const int n_layers)
  {
    const std::vector<PolarPin> pins = {{Plan::Side::top, -refinement, 2 * refinement, refinement, refinement},
                                        {Plan::Side::bottom, -refinement, 2 * refinement, refinement, refinement}};
    return extrude(polar_plan(0.1505, 0.3155, 3 * refinement, 24 * refinement, pins), layers(n_layers, n_layers + 1));
  }

  Model trilinear(const Mesh &mesh)
  {
    return Model(mesh, Element::trilinear, MPI_COMM_WORLD);
  }

  /// A mesh of three bodies and its common points.
  struct Points
  {
    explicit Points(const int degree = 1)
      : points(common_points(model, materials, degree))
    {}

    Mesh         coarse = mesh(1, 2);
    Model        model  = trilinear(coarse);
    CommonPoints points;
  };
} // namespace

TEST(CommonPoints, HaveTheMassOfEveryBody)
{
  const Points p;
  ASSERT_EQ(p.points.bodies.size(), 3u);
  for (unsigned int body = 0; body < 3; ++body)
    {
      const std::vector<double> &masses = p.points.bodies[body].masses;
      const double               mass   = std::accumulate(masses.begin(), masses.end(), 0.);
      EXPECT_EQ(p.points.bodies[body].name, p.coarse.body_names[body]);
      EXPECT_NEAR(mass, (body == 0 ? materials.disc : materials.pin).density * volume(p.coarse, body), 1e-12 * mass);
    }
  EXPECT_EQ(p.points.n(), 8 * static_cast<int>(p.coarse.cells.size()));

  Mesh other          = p.coarse;
  other.body_names[1] = "pin_elsewhere";
  EXPECT_THROW(displacements_at(p.points, trilinear(other)), MeshError);
}

TEST(CommonPoints, EvaluateMultilinearFieldsExactlyInTheirOwnBodyOnly)
{
  // The finite element space of extruded cells contains this field, which vanishes on the clamped face of the upper pin
  const auto multilinear = [](const Point3 &x) {
    const GeometryParameters parameters;
    const double             z = x[2] - parameters.disc_thickness / 2. - parameters.pin_height;
    return Point3{{z * (1. + 2. * x[0] - x[1]), z * x[1], 3. * z}};
  };
  // Expect √m u(x) at all points; each body has its own field, although faces of disc and pin coincide
  const Points        p;
  std::vector<double> expected;
  for (unsigned int body = 0; body < 3; ++body)
    for (std::size_t q = 0; q < p.points.bodies[body].points.size(); ++q)
      {
        const auto &x = p.points.bodies[body].points[q];
        for (const double value : multilinear({{x[0], x[1], x[2]}}))
          expected.push_back(body == 1 ? std::sqrt(p.points.bodies[body].masses[q]) * value : 0.);
      }
  // Repeat with the same outline, other cells and another order of names
  Mesh fine = extrude(polar_plan(0.1505, 0.3155, 3, 24, {{Plan::Side::top, -1, 2, 1, 1}, {Plan::Side::bottom, -1, 2, 1, 1}}, "bore", "rim"),
                      layers(3, 5));
  for (Mesh::Cell &cell : fine.cells)
    cell.volume = cell.volume == 0 ? 0 : 3 - cell.volume;
  std::swap(fine.volume_names[1], fine.volume_names[2]);
  std::swap(fine.body_names[1], fine.body_names[2]);
  for (const Element element : {Element::trilinear, Element::incompatible_modes, Element::quadratic})
    {
      const Model       model(fine, element, MPI_COMM_WORLD);
      const DenseMatrix found = replicate(*displacements_at(p.points, model) * displacements(model, 2, multilinear));
      EXPECT_LT(max_norm(found - as_column(expected)), 1e-12);
    }
}

TEST(BodyFrames, CarryPointsToTheSamePlacesOfADisc)
{
  // Change the width of the disc and the thickness of all bodies
  const Points p(0);
  const auto   carry = [](const double r, const double theta, const double z) {
    const double carried = 0.1 + 2. * (r - 0.1505);
    return dealii::Point<3>(carried * std::cos(theta), carried * std::sin(theta), 1.5 * z);
  };
  const Mesh             two     = mapped(p.coarse, [&](const Point3 &x) {
    const auto y = carry(std::hypot(x[0], x[1]), std::atan2(x[1], x[0]), x[2]);
    return Point3{{y[0], y[1], y[2]}};
  });
  std::vector<BodyFrame> frames  = body_frames(p.model);
  const CommonPoints     carried = carried_over(p.points, frames, body_frames(trilinear(two)));
  ASSERT_EQ(carried.bodies.size(), 3u);
  EXPECT_EQ(carried.bodies[0].masses, p.points.bodies[0].masses);
  for (std::size_t q = 0; q < p.points.bodies[0].points.size(); ++q)
    {
      const auto &x = p.points.bodies[0].points[q];
      EXPECT_LT(carried.bodies[0].points[q].distance(carry(std::hypot(x[0], x[1]), std::atan2(x[1], x[0]), x[2])), 1e-14);
    }

  // A body that is missing in the other design is omitted
  std::vector<BodyFrame> fewer = frames;
  fewer.erase(fewer.begin() + 1);
  const CommonPoints rest = carried_over(p.points, frames, fewer);
  ASSERT_EQ(rest.bodies.size(), 2u);
  EXPECT_EQ(rest.bodies[1].name, p.points.bodies[2].name);
}

TEST(CylindricalDirections, FollowATurnedScene)
{
  // A displacement that rotates with the model keeps its cylindrical components
  const Points p(0);
  const Model  to     = trilinear(mapped(p.coarse, [](const Point3 &x) { return Point3{{-x[1], x[0], x[2]}}; }));
  CommonPoints turned = p.points;
  for (CommonPoints::Body &body : turned.bodies)
    for (dealii::Point<3> &x : body.points)
      x = dealii::Point<3>(-x[1], x[0], x[2]);
  const auto        field = [](const Point3 &a) { return Point3{{1. + a[0], 2. * a[1] - a[2], 3. + a[0] * a[2]}}; };
  const MultiVector u = displacements(p.model, 0, field), v = displacements(to, 0, [&](const Point3 &b) {
                                                            const Point3 value = field({{b[1], -b[0], b[2]}});
                                                            return Point3{{-value[1], value[0], value[2]}};
                                                          });
  const MultiVector x = *displacements_at(p.points, p.model, Directions::cylindrical) * u,
                    y = *displacements_at(turned, to, Directions::cylindrical) * v;
  EXPECT_GT(max_norm(replicate(x)), 0.1);
  EXPECT_LT(max_norm(replicate(x - y)), 1e-12);
}
