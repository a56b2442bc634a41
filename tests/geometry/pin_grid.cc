// SPDX-License-Identifier: GPL-3.0-or-later

#include "scenes.h"

#include <squeal/geometry/mesh_check.h>
#include <squeal/geometry/pin_grid.h>
#include <squeal/geometry/polygon.h>

#include <numeric>

using namespace Scenes;

namespace
{

  /// Nodes on a circle of radius 1 about (3, 4).
  std::vector<Plan::Point> circle(const unsigned int n)
  {
    std::vector<Plan::Point> points;
    for (unsigned int i = 0; i < n; ++i)
      points.emplace_back(3. + std::cos(2. * M_PI * i / n), 4. + std::sin(2. * M_PI * i / n));
    return points;
  }

  std::vector<unsigned int> first(const unsigned int n)
  {
    std::vector<unsigned int> nodes(n);
    std::iota(nodes.begin(), nodes.end(), 0);
    return nodes;
  }

  /// Smallest and largest angle between the edges of faces [degree].
  std::pair<double, double> angles(const std::vector<Plan::Face> &faces, const std::vector<Plan::Point> &points)
  {
    double least = 360., most = 0.;
    for (const Plan::Face &face : faces)
      for (unsigned int v = 0; v < 4; ++v)
        {
          const Corner corner(face, v, points);
          double       angle = std::atan2(corner.cross, corner.a * corner.b) * 180. / M_PI;
          angle += angle < 0. ? 360. : 0.;
          least = std::min(least, angle);
          most  = std::max(most, angle);
        }
    return {least, most};
  }
} // namespace

TEST(PinGrid, RingsFillTheOutlineWithoutFlatCorners)
{
  for (const unsigned int k : {1u, 2u, 5u})
    for (const unsigned int rings : {1u, 4u})
      {
        SCOPED_TRACE("k = " + std::to_string(k) + ", " + std::to_string(rings) + " rings");
        std::vector<Plan::Point> points = circle(6 * k);
        const PinGrid            grid   = fill_pin(first(6 * k), {rings, 1.5}, points);
        EXPECT_EQ(points.size(), 3 * k * (k + 1) + 1 + 6 * k * rings);
        EXPECT_EQ(grid.faces.size(), 3 * k * k + 6 * k * rings);
        EXPECT_EQ(grid.ring_nodes.size(), 6 * k * rings);

        double area = 0.;
        for (const Plan::Face &face : grid.faces)
          area += signed_area(face, points);
        EXPECT_NEAR(area, 3. * k * std::sin(M_PI / (3. * k)), 1e-13);
        EXPECT_EQ(boundary_edges(grid.faces).size(), 6 * k);

        const auto [least, most] = angles(grid.faces, points);
        EXPECT_GT(least, 45.);
        EXPECT_LT(most, 135.);
      }
}

TEST(PinGrid, PinsOfASceneHaveRingsAndThinnerLayersAtTheirHeldEnd)
{
  GeometryParameters parameters;
  parameters.pin_rings   = 3;
  parameters.pin_layers  = 3;
  parameters.pin_grading = 2.;
  parameters.bottom      = {{0.1970, 0.2585}, {-10., 12.}}; // offset from the upper pins
  const Mesh mesh        = generate_mesh(parameters);
  EXPECT_GT(check_mesh(mesh).worst_scaled_jacobian, 0.1);
  const double z_face = parameters.disc_thickness / 2.;
  for (const double side : {1., -1.})
    {
      // Layer heights have the ratios 4 : 2 : 1 from the face upwards
      std::set<double> heights;
      for (const Mesh::Point &p : mesh.points)
        if (side * p[2] >= z_face)
          heights.insert(std::round(1e9 * (side * p[2] - z_face) / parameters.pin_height) / 1e9);
      ASSERT_EQ(heights.size(), 4u);
      EXPECT_NEAR(*std::next(heights.begin()), 4. / 7., 1e-8);
      EXPECT_NEAR(*std::next(heights.begin(), 2), 6. / 7., 1e-8);
      EXPECT_EQ(*heights.rbegin(), 1.);
    }
  // Every pin has the same ring radii on both sides
  for (std::size_t pin = 0; pin < 2; ++pin)
    {
      const double      angle = parameters.bottom.angles[pin] * M_PI / 180., radius = parameters.pin_diameter / 2.;
      const Plan::Point axis(parameters.bottom.radii[pin] * std::cos(angle), parameters.bottom.radii[pin] * std::sin(angle));
      unsigned int      n_found = 0;
      for (const Mesh::Point &p : mesh.points)
        if (p[2] < -z_face - parameters.pin_height / 2.)
          for (const double end : graded_intervals(2, 2.))
            n_found += std::abs(std::hypot(p[0] - axis[0], p[1] - axis[1]) / radius - 0.8 - 0.2 * end) < 1e-9;
      // Three of four node layers lie in the outer half of the pin
      EXPECT_EQ(n_found, 3u * 3u * 12u) << pin;
    }
}
