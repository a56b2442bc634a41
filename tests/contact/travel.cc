// SPDX-License-Identifier: GPL-3.0-or-later

#include "faces.h"

#include <algorithm>
#include <cmath>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /// Two pins above and one below the disc, of different sizes.
  Mesh unequal_pins()
  {
    return extrude(
      polar_plan(0.15, 0.3, 3, 12, {{Plan::Side::top, 1, 2, 1, 1}, {Plan::Side::top, -3, 1, 1, 1}, {Plan::Side::bottom, 1, 1, 1, 2}}),
      layers(1, 2));
  }

  struct Pressed
  {
    explicit Pressed(const Mesh &mesh, const double friction = 0.4, const Rotation rotation = Rotation::positive)
      : model(mesh, Element::trilinear, MPI_COMM_WORLD)
      , interface(contact_nodes(model, ContactParameters().pairs, rotation, 1e-6).interface)
    {
      operation.friction_coefficient = friction;
      operation.load_per_side        = 500.;
    }

    /// Force on the backplate of a body along a direction, from the contact reactions [N].
    double force(const unsigned int pin, const Eigen::Vector3d &e, const std::vector<double> &reactions) const
    {
      double sum = 0.;
      for (std::size_t c = 0; c < interface.size(); ++c)
        if (interface[c].pin == pin)
          sum += reactions[c] * e.dot(interface[c].normal + operation.friction_coefficient * interface[c].sliding);
      return sum;
    }

    std::vector<double> shares() const
    {
      return equal_load_shares(model, interface, operation);
    }

    Model               model;
    ContactInterface    interface;
    OperationParameters operation;
  };
} // namespace

TEST(Travel, LevelAndConicalFacesArePressedAlongTheAxis)
{
  for (const double slope : {0., 0.5})
    for (const double mu : {0., 0.4})
      {
        const Pressed s(sloped(unequal_pins(), slope), mu);
        const auto    e = travels(s.model, s.interface);
        const auto    r = s.shares();
        EXPECT_EQ(e[0].direction, Eigen::Vector3d(0., 0., 0.));
        for (const unsigned int pin : {1, 2, 3})
          {
            EXPECT_EQ(e[pin].side, pin < 3 ? 1 : -1);
            EXPECT_EQ(e[pin].direction, Eigen::Vector3d(0., 0., pin < 3 ? -1. : 1.));
          }
        EXPECT_EQ(backplate_numbers(e, false), (std::vector<int>{-1, 0, 0, 1}));
        EXPECT_EQ(backplate_numbers(e, true), (std::vector<int>{-1, 0, 1, 2}));

        // Axial forces on the backplates of a side add up to the load, and all nodes of a side have the same reaction
        EXPECT_NEAR(s.force(1, e[1].direction, r) + s.force(2, e[2].direction, r), 500., 1e-10);
        EXPECT_NEAR(s.force(3, e[3].direction, r), 500., 1e-10);
        for (std::size_t c = 0; c < r.size(); ++c)
          for (std::size_t d = 0; d < r.size(); ++d)
            EXPECT_TRUE(r[c] == r[d] || e[s.interface[c].pin].side != e[s.interface[d].pin].side);
      }
}

TEST(Travel, ShoesOutsideAndInsideOfARingAreSidesOfTheirOwn)
{
  for (const Rotation rotation : {Rotation::positive, Rotation::negative})
    {
      const Pressed s(turned_to_rims(unequal_pins()), 0.4, rotation);
      const auto    e = travels(s.model, s.interface);
      const auto    r = s.shares();
      EXPECT_EQ(backplate_numbers(e, false), (std::vector<int>{-1, 0, 1, 2}));
      for (const unsigned int pin : {1, 2, 3})
        {
          // Shoes outside the ring travel inwards, shoes inside travel outwards
          Eigen::Vector3d middle(0., 0., 0.);
          for (const ContactNode &node : s.interface)
            if (node.pin == pin)
              middle += node.area * Eigen::Vector3d(node.position[0], node.position[1], 0.);
          EXPECT_EQ(e[pin].side, 0);
          EXPECT_NEAR(e[pin].direction.dot(middle.normalized()), pin < 3 ? -1. : 1., 1e-12);
          EXPECT_NEAR(s.force(pin, e[pin].direction, r), 500., 1e-10);
        }
    }
}

TEST(Travel, ABodyThatRubsBothFacesIsRefusedByName)
{
  // Join upper and lower pins to one body, with unequal and with equal areas
  for (const bool is_equal : {false, true})
    {
      Mesh mesh = is_equal ?
                    extrude(polar_plan(0.15, 0.3, 3, 12, {{Plan::Side::top, 1, 1, 1, 1}, {Plan::Side::bottom, 1, 1, 1, 1}}), layers(1, 2)) :
                    unequal_pins();
      for (auto &hexahedron : mesh.cells)
        hexahedron.volume = std::min(hexahedron.volume, 1u);
      mesh.volume_names = {mesh.volume_names[0], "pin_caliper"};
      find_bodies(mesh);
      const Pressed s(mesh);
      EXPECT_FALSE(have_travels(s.model, s.interface));
      expect_refusal([&] { s.shares(); }, {"pin_caliper", "of " + std::to_string(s.interface.size()) + ", the first"});
    }
  EXPECT_TRUE(have_travels(Pressed(unequal_pins()).model, Pressed(unequal_pins()).interface));
}

TEST(Travel, FrictionThatCarriesTheLoadIsRefused)
{
  // On faces that rise along the sliding direction, strong friction holds the pin without load (self-locking)
  const Mesh    mesh = mapped(unequal_pins(), [](const Point3 &p) { return Point3{{p[0], p[1], p[2] + 0.1 * std::atan2(p[1], p[0])}}; });
  const Pressed weak(mesh, 0.4), strong(mesh, 5.), reversed(mesh, 5., Rotation::negative);
  EXPECT_NO_THROW(weak.shares());
  for (const Pressed *s : {&strong, &reversed}) // locks the pins of one side or of the other
    expect_refusal([&] { s->shares(); }, {"Operation/Friction coefficient"});
}
