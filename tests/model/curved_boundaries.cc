#include "scenes.h"

#include <squeal/geometry/pin_grid.h>

#include <gtest/gtest.h>

#include <numeric>
#include <set>

using namespace Squeal;
using namespace Testing;

namespace
{
  constexpr double distance = 0.2, radius = 0.026;

  /// The plate of the plan with the pin on top of all of it.
  HexMesh covered(Plan plan)
  {
    plan.pins[0].faces.resize(plan.faces.size());
    std::iota(plan.pins[0].faces.begin(), plan.pins[0].faces.end(), 0);
    return extrude(plan, layers(1, 1));
  }

  /// A plate and a pin on top of all of it, with rings.
  HexMesh round_mesh(const unsigned int k, const unsigned int rings)
  {
    Plan                      plan = round_plan(distance, radius, k);
    std::vector<unsigned int> outline;
    for (unsigned int i = 0; i < 6 * k; ++i)
      outline.push_back(i);
    plan.points.resize(6 * k);
    plan.faces = fill_pin(outline, {rings, 2.}, plan.points).faces;
    return covered(plan);
  }

  /// Nodes at that distance from the axis, seen along it, in micrometres.
  std::set<std::pair<long, long>> nodes_at(const std::vector<Node> &nodes, const double r, const unsigned int component)
  {
    std::set<std::pair<long, long>> places;
    for (const Node &node : nodes)
      if (node.component == component && std::abs(std::hypot(node.position[0] - distance, node.position[1]) - r) < 1e-9)
        places.insert({std::lround(1e6 * node.position[0]), std::lround(1e6 * node.position[1])});
    return places;
  }
} // namespace

TEST(CurvedBoundaries, RingsAreRoundOnBothSidesOfTheContact)
{
  const std::vector<Node> nodes = Model(round_mesh(2, 3), Element::quadratic, MPI_COMM_WORLD).gathered_nodes();
  if (nodes.empty())
    return; // process 0 has all
  // Two rings between r and 0.8 r, 1 : 2 from outside: vertices and middles of edges, 24 on each circle
  for (const double r : {1., 1. - 0.2 / 3., 0.8})
    {
      EXPECT_EQ(nodes_at(nodes, r * radius, 1).size(), 24u) << r;
      EXPECT_GE(nodes_at(nodes, r * radius, 0).size(), 24u) << r;
    }
}

TEST(CurvedBoundaries, CellsWithTwoRoundFacesSideBySideKeepOneStraight)
{
  // One circular ring around the three blocks of an O-grid, whose outer corners would become flat
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
  const std::vector<Node> nodes = Model(covered(plan), Element::quadratic, MPI_COMM_WORLD).gathered_nodes();
  if (nodes.empty())
    return;
  EXPECT_EQ(nodes_at(nodes, radius, 1).size(), 12u);
  EXPECT_EQ(nodes_at(nodes, 0.6 * radius, 1).size(), 6u); // vertices only
}
