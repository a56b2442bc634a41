#include "scenes.h"

#include <squeal/geometry/outlines.h>
#include <squeal/geometry/pin_grid.h>

using namespace Squeal;
using namespace Scenes;

namespace
{
  constexpr double pi = 3.14159265358979323846;

  /// Area and polar moment about the centroid of faces of a plan [m², m⁴].
  std::pair<double, double> area_and_polar_moment(const std::vector<Plan::Edge> &outline, const std::vector<Plan::Point> &points)
  {
    // Green's theorem, edge by edge
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

  Plan polygon_pin(const unsigned int k, const Plan::Point &centre, const double radius)
  {
    Plan                      plan;
    std::vector<unsigned int> loop;
    for (unsigned int i = 0; i < 6 * k; ++i)
      {
        loop.push_back(i);
        plan.points.emplace_back(centre[0] + radius * std::cos(pi * i / (3. * k)), centre[1] + radius * std::sin(pi * i / (3. * k)));
      }
    plan.faces = fill_with_o_grid(loop, plan.points);
    plan.pins.resize(2);
    for (unsigned int face = 0; face < plan.faces.size(); ++face)
      for (Plan::Pin &pin : plan.pins)
        pin.faces.push_back(face);
    return plan;
  }
} // namespace

TEST(Outlines, RoundPinsGetAreaAndMomentOfTheirCircle)
{
  const double r = 0.026, area = pi * r * r, moment = area * r * r / 2.;
  for (const unsigned int k : {1u, 2u, 3u, 4u})
    {
      const Plan inscribed = polygon_pin(k, Plan::Point(0.2, -0.07), r);
      Plan       enlarged  = inscribed;
      enlarge_to_true_area(enlarged);
      const double theta    = pi / (3. * k);
      const auto [A_i, J_i] = area_and_polar_moment(boundary_edges(inscribed.faces), inscribed.points);
      const auto [A, J]     = area_and_polar_moment(boundary_edges(enlarged.faces), enlarged.points);
      EXPECT_NEAR(A / area, 1., 1e-13);
      EXPECT_NEAR(J / moment - 1., std::pow(theta, 4) / 180., 0.2 * std::pow(theta, 4) / 180.) << k;
      EXPECT_NEAR(1. - A_i / area, theta * theta / 6., 0.1 * theta * theta) << k;
      EXPECT_NEAR(1. - J_i / moment, theta * theta / 3., 0.1 * theta * theta) << k;

      // Inner nodes keep their place relative to the outline, the centre where it is
      const double factor = std::sqrt(area / A_i);
      for (std::size_t node = 0; node < inscribed.points.size(); ++node)
        EXPECT_LT(enlarged.points[node].distance(
                    Plan::Point(Plan::Point(0.2, -0.07) + factor * (inscribed.points[node] - Plan::Point(0.2, -0.07)))),
                  1e-14);
    }
}

TEST(Outlines, MeshesHaveTheVolumeOfDiscAndPins)
{
  GeometryParameters parameters = one_pin();
  parameters.outlines           = Outlines::true_area;
  const HexMesh mesh            = generate_mesh(parameters);
  const auto    volume_of       = [&](const unsigned int body) {
    double sum = 0.;
    for (const HexMesh::Hexahedron &hexahedron : mesh.hexahedra)
      if (hexahedron.volume == body)
        {
          // Of a prism: area of the lower face times height
          const auto  &n  = hexahedron.nodes;
          const auto   at = [&](const int i) { return mesh.points[n[i]]; };
          const double area = 0.5 * std::abs((at(2)[0] - at(0)[0]) * (at(3)[1] - at(1)[1]) - (at(2)[1] - at(0)[1]) * (at(3)[0] - at(1)[0]));
          sum += area * std::abs(at(4)[2] - at(0)[2]);
        }
    return sum;
  };
  const double r = parameters.pin_diameter / 2.;
  EXPECT_NEAR(volume_of(1) / (pi * r * r * parameters.pin_height), 1., 1e-12);
  const double annulus = pi * (std::pow(parameters.disc_outer_radius, 2) - std::pow(parameters.disc_inner_radius, 2));
  EXPECT_NEAR(volume_of(0) / (annulus * parameters.disc_thickness), 1., 1e-12);
  parameters.outlines = Outlines::inscribed;
  EXPECT_NE(generate_mesh(parameters).points, mesh.points);
}

TEST(Outlines, OtherShapesStayAsTheyAre)
{
  // A square, an ellipse, and an open curve
  Plan plan = polygon_pin(2, Plan::Point(0.2, 0.), 0.026);
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
