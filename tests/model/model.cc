// SPDX-License-Identifier: GPL-3.0-or-later

#include "faces.h"

#include <squeal/base/exceptions.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <map>
#include <set>

using namespace Squeal;
using namespace Testing;

namespace
{
  /// A disc with two pins, one of which extends to the rim.
  Mesh mesh()
  {
    return extrude(polar_plan(0.15, 0.3, 3, 12, {{Plan::Side::top, 0, 2, 1, 2}, {Plan::Side::bottom, 5, 3, 0, 1}}), layers(2, 2));
  }

  /// Nodes of all processes, each from its owner, by number.
  std::map<std::int64_t, Node> all_nodes(const Model &model)
  {
    std::vector<Node> own;
    for (const Node &node : model.nodes())
      if (node.is_own)
        own.push_back(node);
    std::map<std::int64_t, Node> result;
    std::size_t                  n = 0;
    for (const auto &part : dealii::Utilities::MPI::all_gather(model.communicator(), own))
      {
        n += part.size();
        for (const Node &node : part)
          result[node.number] = node;
      }
    EXPECT_EQ(result.size(), n) << "every node must belong to exactly one process";
    return result;
  }

  double distance_between(const Node &a, const Node &b)
  {
    return std::hypot(a.position[0] - b.position[0], a.position[1] - b.position[1], a.position[2] - b.position[2]);
  }
} // namespace

TEST(Models, HaveTheSameNodesHoweverTheyAreDistributed)
{
  for (const Element element : {Element::trilinear, Element::quadratic})
    {
      const Model model(mesh(), element, MPI_COMM_WORLD), whole(mesh(), element, MPI_COMM_SELF);
      const auto  nodes = all_nodes(model), expected = all_nodes(whole);
      EXPECT_EQ(expected.size(), whole.nodes().size());
      ASSERT_EQ(nodes.size(), expected.size());
      EXPECT_EQ(model.n_dofs(), whole.n_dofs());
      EXPECT_EQ(model.free_map().n(), whole.free_map().n());
      std::set<int> dofs;
      for (const auto &[number, node] : nodes)
        {
          ASSERT_EQ(expected.count(number), 1u);
          const Node &other = expected.at(number);
          EXPECT_LT(distance_between(node, other), 1e-15);
          EXPECT_EQ(node.component, other.component);
          for (int d = 0; d < 3; ++d)
            {
              EXPECT_EQ(node.dofs[d] < 0, other.dofs[d] < 0);
              if (node.dofs[d] >= 0)
                dofs.insert(node.dofs[d]);
            }
        }
      EXPECT_EQ(static_cast<int>(dofs.size()), model.free_map().n());
      EXPECT_EQ(*dofs.rbegin() + 1, model.free_map().n());

      // Ghost nodes agree with the nodes of their owners
      for (const Node &node : model.nodes())
        {
          ASSERT_EQ(nodes.count(node.number), 1u);
          EXPECT_EQ(nodes.at(node.number).dofs, node.dofs);
          EXPECT_LT(distance_between(nodes.at(node.number), node), 1e-15);
          EXPECT_EQ(node.is_own, node.dofs[0] < 0 ? node.is_own : model.free_map().place(node.dofs[0]) >= 0);
        }
    }
}

TEST(Models, ProcessesHaveTheirCellsAndTheNeighboursOfThese)
{
  const Mesh         all = mesh();
  const Model        model(all, Element::trilinear, MPI_COMM_WORLD);
  const unsigned int n_processes = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  unsigned int       n_own       = 0;
  for (const Cell &cell : model.cells())
    n_own += cell.is_own;
  EXPECT_EQ(dealii::Utilities::MPI::sum(n_own, MPI_COMM_WORLD), all.cells.size());
  EXPECT_LE(n_own, 1.1 * all.cells.size() / n_processes + 2);
  EXPECT_EQ(model.cells().size() == all.cells.size(), n_processes == 1);
}

TEST(Models, SurfacesThatAreMissingAreNamed)
{
  const Model model(mesh(), Element::trilinear, MPI_COMM_WORLD);
  expect_refusal<MeshError>([&] { model.faces_of("rim"); }, {"no surface named `rim`", "disc_bore"});
}
