// SPDX-License-Identifier: GPL-3.0-or-later

#include "faces.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <set>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  const Plan::Side top = Plan::Side::top, bottom = Plan::Side::bottom;

  Mesh flat_mesh()
  {
    return extrude(polar_plan(0.15, 0.3, 4, 16, {{top, -1, 2, 1, 2}, {bottom, 3, 2, 2, 1}, {bottom, -1, 1, 1, 2}}), layers(2, 2));
  }

  ContactInterface pairs(const Mesh &mesh, const Element element = Element::trilinear, const Rotation rotation = Rotation::positive)
  {
    return contact_nodes(Model(mesh, element, MPI_COMM_WORLD), ContactParameters().pairs, rotation, 1e-6).interface;
  }

  void expect_unpaired(const Mesh &mesh, const std::vector<std::string> &parts)
  {
    expect_refusal<MeshError>([&] { pairs(mesh); }, parts);
  }

  unsigned int surface(const Mesh &mesh, const std::string &name)
  {
    return std::find(mesh.surface_names.begin(), mesh.surface_names.end(), name) - mesh.surface_names.begin();
  }

  /// Area of the pin contact faces, projected along the axis.
  double contact_area(const Mesh &mesh)
  {
    double area = 0.;
    for (const auto &face : mesh.faces)
      if (mesh.surface_names[face.surface] == PhysicalNames::pin_contact)
        {
          double sum = 0.;
          for (int v = 0; v < 4; ++v)
            {
              const auto &a = mesh.points[face.nodes[v]], &b = mesh.points[face.nodes[(v + 1) % 4]];
              sum += 0.5 * (a[0] * b[1] - a[1] * b[0]);
            }
          area += std::abs(sum);
        }
    return area;
  }
} // namespace

TEST(ContactInterface, EveryNodeOnceWithItsFrame)
{
  // z → z + s (r - r0) slopes towards the rim: normal (-s e_r + e_z) / √(1 + s²) on top, except at edges of the polygon
  constexpr int n_sectors = 96;
  const Mesh    flat      = extrude(polar_plan(0.15, 0.3, 3, n_sectors, {{top, -3, 6, 1, 1}, {bottom, 3, 4, 1, 1}}), layers(2, 2));
  for (const double slope : {0., 0.3})
    for (const Element element : {Element::trilinear, Element::quadratic})
      {
        const Mesh mesh     = mapped(flat, [slope](const Point3 &p) {
          return Point3{{p[0], p[1], p[2] + slope * (std::hypot(p[0], p[1]) - 0.2)}};
        });
        const auto positive = pairs(mesh, element), negative = pairs(mesh, element, Rotation::negative);
        // a × b faces of degree d have (d a + 1) (d b + 1) nodes
        EXPECT_EQ(positive.size(), element == Element::trilinear ? 14u + 10u : 39u + 27u);
        ASSERT_EQ(negative.size(), positive.size());

        double             area = 0.;
        std::set<unsigned> disc_nodes, pin_nodes;
        for (std::size_t c = 0; c < positive.size(); ++c)
          {
            const ContactNode &node = positive[c];
            disc_nodes.insert(node.on_disc[0].node.number);
            pin_nodes.insert(node.pin_node.number);
            EXPECT_EQ(node.on_disc[0].node.component, 0u);
            EXPECT_EQ(node.pin_node.component, node.pin);
            for (int k = 0; k < 3; ++k)
              {
                EXPECT_EQ(node.position[k], node.on_disc[0].node.position[k]);
                EXPECT_NEAR(node.position[k], node.pin_node.position[k], 1e-15);
              }
            EXPECT_GT(node.area, 0.);
            area += node.area;

            // n points outwards, t along e_θ, b = n × t; at the ends of a pin, the normal deviates from the cone by half the sector angle
            const double r = node.axis_distance(), scale = 1. / std::sqrt(1. + slope * slope), side = node.normal[2] > 0. ? 1. : -1.;
            const double tolerance = 1.1 * slope * M_PI / n_sectors, near = slope > 0. ? 1e-3 : 0.;
            const Eigen::Vector3d e_r(node.position[0] / r, node.position[1] / r, 0.), e_theta(-e_r[1], e_r[0], 0.);
            EXPECT_EQ(side > 0., node.position[2] > 0.);
            EXPECT_NEAR(node.normal.dot(e_r), -side * slope * scale, near);
            EXPECT_NEAR(node.normal.dot(e_theta), 0., tolerance);
            EXPECT_NEAR(node.normal[2], side * scale, near);
            EXPECT_NEAR(node.sliding.dot(e_theta), 1., std::max(1e-15, tolerance * tolerance));
            EXPECT_NEAR(node.normal.norm(), 1., 1e-15);
            EXPECT_NEAR(node.sliding.norm(), 1., 1e-15);
            EXPECT_NEAR(node.normal.dot(node.sliding), 0., 1e-15);
            EXPECT_LT((node.radial - node.normal.cross(node.sliding)).norm(), 1e-15);
            EXPECT_LT((negative[c].sliding + node.sliding).norm(), 1e-15);
            EXPECT_LT((negative[c].radial + node.radial).norm(), 1e-15);
          }
        EXPECT_EQ(disc_nodes.size(), positive.size());
        EXPECT_EQ(pin_nodes.size(), positive.size());
        EXPECT_NEAR(area / (contact_area(mesh) * std::hypot(1., slope / std::cos(M_PI / n_sectors))), 1., 1e-12);
      }
}

TEST(ContactInterface, PadsThatEndAtTheRimPairInDegree2)
{
  // Pad edges on rim and bore must follow the curve for any shape of the other edges
  const auto interface =
    pairs(extrude(polar_plan(0.15, 0.3, 3, 16, {{top, -1, 2, 1, 2}, {bottom, 3, 3, 0, 1}}), layers(1, 1)), Element::quadratic);
  const auto n_at = [&](const double radius) {
    return std::count_if(interface.begin(), interface.end(),
                         [radius](const ContactNode &node) { return std::abs(node.axis_distance() - radius) < 1e-12; });
  };
  EXPECT_EQ(interface.size(), 25u + 21u);
  EXPECT_EQ(n_at(0.3), 5);
  EXPECT_EQ(n_at(0.15), 7);
}

TEST(ContactInterface, DisplacedPinsAreCoupledByMortarElements)
{
  const auto apart = [](const double distance) {
    Mesh                   mesh = flat_mesh();
    std::set<unsigned int> nodes;
    for (const auto &hexahedron : mesh.cells)
      if (hexahedron.volume == 2)
        nodes.insert(hexahedron.nodes.begin(), hexahedron.nodes.end());
    for (const unsigned int node : nodes)
      mesh.points[node][0] += distance;
    return mesh;
  };
  const auto n_pairs = [](const ContactInterface &interface) {
    return std::count_if(interface.begin(), interface.end(), [](const ContactNode &node) { return node.is_pair(); });
  };
  EXPECT_EQ(n_pairs(pairs(apart(5e-7))), 21); // gap within the tolerance
  EXPECT_EQ(pairs(apart(1e-4)).size(), 21u);
  EXPECT_LT(n_pairs(pairs(apart(1e-4))), 21);
  expect_unpaired(apart(-2.), {"only 0 % of the contact face of pin_"});
}

TEST(ContactInterface, WhatCannotBePairedIsRefused)
{
  // Clamp lateral faces of the pins, including their contact nodes
  Mesh clamped = flat_mesh();
  for (auto &quadrilateral : clamped.faces)
    if (clamped.surface_names[quadrilateral.surface] == PhysicalNames::pin_side)
      quadrilateral.surface = surface(clamped, PhysicalNames::pin_clamp);
  expect_unpaired(clamped, {"is clamped by pin_clamp"});

  expect_unpaired(extrude(round_plan(0., 0.03, 1), layers(1, 1)), {"zero or undefined at a contact node", "Operation/Sliding direction"});
}

TEST(RadialDissipation, SharesTheLoadOfEachSide)
{
  const Model         model(flat_mesh(), Element::trilinear, MPI_COMM_WORLD);
  const auto          interface  = contact_nodes(model, ContactParameters().pairs, Rotation::positive, 1e-6).interface;
  OperationParameters operation  = operating();
  operation.friction_coefficient = 0.37;
  operation.rotation_speed       = 3.;
  operation.load_per_side        = 500.;
  // c_b w_0 is the friction force μ R_n0 (consistent) or R_n0 (published), divided equally among the nodes
  for (const auto &[kind, force] :
       {std::make_pair(RadialDissipation::none, 0.), {RadialDissipation::consistent, 0.37 * 500.}, {RadialDissipation::published, 500.}})
    {
      operation.radial_dissipation = kind;
      const auto c_b               = radial_dissipation(interface, equal_load_shares(model, interface, operation), operation);
      ASSERT_EQ(c_b.size(), interface.size());
      for (std::size_t c = 0; c < interface.size(); ++c)
        EXPECT_NEAR(c_b[c] * operation.rotation_speed * interface[c].axis_distance(), force / (interface[c].normal[2] > 0. ? 9. : 12.),
                    1e-14 * force);
    }
}
