// SPDX-License-Identifier: GPL-3.0-or-later

#include "scenes.h"
#include "../scenes.h"

#include <squeal/geometry/mesh_check.h>
#include <squeal/geometry/second_order.h>

#include <numeric>

using namespace Squeal;
using namespace Testing;

namespace
{
  constexpr double distance = 0.2, radius = 0.026;

  /// Mesh of a plan with a plate that is completely covered by a pin.
  Mesh covered(Plan plan)
  {
    plan.pins[0].faces.resize(plan.faces.size());
    std::iota(plan.pins[0].faces.begin(), plan.pins[0].faces.end(), 0);
    return extrude(plan, layers(1, 1));
  }

  /// A round plate covered by a pin, with rings.
  Mesh round_mesh(const unsigned int k, const unsigned int rings)
  {
    Plan                      plan = round_plan(distance, radius, k);
    std::vector<unsigned int> outline;
    for (unsigned int i = 0; i < 6 * k; ++i)
      outline.push_back(i);
    plan.points.resize(6 * k);
    plan.faces = fill_pin(outline, {rings, 2.}, plan.points).faces;
    return covered(plan);
  }

  /// Coordinates in the plan [µm] of the nodes of a body at distance @p r from the axis of the pin.
  std::set<std::pair<long, long>> nodes_at(const Mesh &mesh, const double r, const unsigned int body)
  {
    const std::vector<unsigned int> bodies = body_of_nodes(mesh);
    std::set<std::pair<long, long>> places;
    for (std::size_t n = 0; n < mesh.points.size(); ++n)
      if (const auto &p = mesh.points[n]; bodies[n] == body && std::abs(std::hypot(p[0] - distance, p[1]) - r) < 1e-9)
        places.insert({std::lround(1e6 * p[0]), std::lround(1e6 * p[1])});
    return places;
  }

  /// A regular prism about z with three tetrahedra per sector and lateral faces named disc_rim.
  Mesh prism_of_tetrahedra(const unsigned int n_sides)
  {
    Mesh mesh;
    mesh.volume_names  = {"disc"};
    mesh.surface_names = {"disc_rim"};
    for (const double z : {0., 0.4})
      {
        mesh.points.emplace_back(0., 0., z);
        for (unsigned int i = 0; i < n_sides; ++i)
          mesh.points.emplace_back(std::cos(2. * M_PI * i / n_sides), std::sin(2. * M_PI * i / n_sides), z);
      }
    const unsigned int up = n_sides + 1;
    for (unsigned int i = 0; i < n_sides; ++i)
      {
        const unsigned int a = 1 + std::min(i, (i + 1) % n_sides), b = 1 + std::max(i, (i + 1) % n_sides); // ascending
        for (const auto &nodes : {Mesh::Nodes{0, a, b, b + up}, {0, a, a + up, b + up}, {0, up, a + up, b + up}})
          mesh.cells.push_back({Shape::tetrahedron, nodes, 0});
        mesh.faces.push_back({Shape::triangle, {a, b, b + up}, 0});
        mesh.faces.push_back({Shape::triangle, {a, a + up, b + up}, 0});
      }
    find_bodies(mesh);
    make_right_handed(mesh);
    return mesh;
  }
} // namespace

TEST(SecondOrder, RingsAreRoundOnBothSidesOfTheContact)
{
  const Mesh mesh = second_order(round_mesh(2, 3));
  EXPECT_NO_THROW(check_mesh(mesh));
  // Two rings between r and 0.8 r have widths 1 : 2 from outside, with 24 corner and mid-edge nodes on each circle
  for (const double r : {1., 1. - 0.2 / 3., 0.8})
    {
      EXPECT_EQ(nodes_at(mesh, r * radius, 1).size(), 24u) << r;
      EXPECT_GE(nodes_at(mesh, r * radius, 0).size(), 24u) << r;
    }
}

TEST(SecondOrder, CellsWithTwoRoundFacesSideBySideKeepOneStraight)
{
  // In a circular ring around the three blocks of an O-grid, outer corners of the blocks would become flat
  Plan                      plan = round_plan(distance, radius, 1);
  std::vector<unsigned int> inside;
  plan.points.resize(6);
  plan.faces = {};
  for (unsigned int i = 0; i < 6; ++i)
    {
      inside.push_back(6 + i);
      plan.points.push_back(Plan::Point(distance, 0.) + 0.6 * (plan.points[i] - Plan::Point(distance, 0.)));
      plan.faces.push_back({{i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i}});
    }
  for (const Plan::Face &face : fill_with_o_grid(inside, plan.points))
    plan.faces.push_back(face);
  const Mesh mesh = second_order(covered(plan));
  EXPECT_EQ(nodes_at(mesh, radius, 1).size(), 12u);
  EXPECT_EQ(nodes_at(mesh, 0.6 * radius, 1).size(), 6u); // only corners are on this circle
}

TEST(SecondOrder, TetrahedraFollowCylinders)
{
  const Mesh linear = prism_of_tetrahedra(8), mesh = second_order(linear);
  EXPECT_EQ(mesh.degree, 2u);
  EXPECT_NO_THROW(check_mesh(mesh));
  EXPECT_EQ(second_order(mesh).points, mesh.points);
  // Each side has corner and mid-edge nodes at top and bottom, one on the vertical edge and one on the diagonal
  std::size_t n_on_rim = 0;
  for (const Mesh::Point &p : mesh.points)
    n_on_rim += std::abs(std::hypot(p[0], p[1]) - 1.) < 1e-12;
  EXPECT_EQ(n_on_rim, 8u * 6u);
  for (const Mesh::Face &face : mesh.faces)
    for (const unsigned int node : face.nodes)
      EXPECT_NEAR(std::hypot(mesh.points[node][0], mesh.points[node][1]), 1., 1e-12);

  // Edges remain straight if the surface has another name
  Mesh straight             = linear;
  straight.surface_names[0] = "rim";
  straight                  = second_order(straight);
  EXPECT_NEAR(std::hypot(straight.points[straight.faces[0].nodes[3]][0], straight.points[straight.faces[0].nodes[3]][1]),
              std::cos(M_PI / 8.), 1e-12);
}

TEST(SecondOrder, NodesThatFoldACellAreRefused)
{
  const auto refusal = [](const double shift) {
    Mesh mesh = second_order(prism_of_tetrahedra(8));
    mesh.points[mesh.cells[0].nodes[4]] += shift * dealii::Tensor<1, 3>({0., 0., 1.}); // shift of the middle of an edge of length 1
    return Scenes::message<MeshError>([&] { check_mesh(mesh); });
  };
  EXPECT_EQ(refusal(0.01), "accepted");
  Scenes::expect_mentions(refusal(0.45), {"folded by second-order nodes", "'disc'", "element"});
  Scenes::expect_mentions(refusal(0.6), {"1 second-order node is farther from the middle", "half its length", "'disc'"});
}
