#include "scenes.h"

#include <squeal/base/exceptions.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  const std::vector<PolarPin> three_pins = {{Plan::Side::top, -1, 2, 1, 2},
                                            {Plan::Side::bottom, 3, 2, 2, 1},
                                            {Plan::Side::bottom, -1, 1, 1, 2}};

  HexMesh flat_mesh()
  {
    return extrude(polar_plan(0.15, 0.3, 4, 16, three_pins), layers(2, 2));
  }

  ContactInterface pairs(const HexMesh &mesh, const Element element = Element::trilinear, const Rotation rotation = Rotation::positive)
  {
    return pair_contact_nodes(Model(mesh, element, MPI_COMM_WORLD), rotation, 1e-6);
  }

  /// The message of the MeshError that pairing throws.
  std::string refusal(const HexMesh &mesh)
  {
    try
      {
        pairs(mesh);
      }
    catch (const MeshError &error)
      {
        return error.what();
      }
    return "accepted";
  }

  int surface(const HexMesh &mesh, const std::string &name)
  {
    return std::find(mesh.surface_names.begin(), mesh.surface_names.end(), name) - mesh.surface_names.begin();
  }

  double dot(const Eigen::Vector3d &a, const Eigen::Vector3d &b)
  {
    return a.dot(b);
  }

  /// Area of the quadrilaterals under the pins (plane faces).
  double contact_area(const HexMesh &mesh)
  {
    double area = 0.;
    for (const auto &face : mesh.quadrilaterals)
      if (mesh.surface_names[face.surface] == PhysicalNames::pin_contact)
        for (int v = 0; v < 4; ++v)
          {
            const auto &a = mesh.points[face.nodes[v]], &b = mesh.points[face.nodes[(v + 1) % 4]];
            area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
          }
    return area;
  }
} // namespace

TEST(ContactInterface, EveryNodeOnceWithItsFrame)
{
  const HexMesh mesh = flat_mesh();
  for (const Element element : {Element::trilinear, Element::quadratic})
    {
      const Model model(mesh, element, MPI_COMM_WORLD);
      const auto  positive = pair_contact_nodes(model, Rotation::positive, 1e-6);
      const auto  negative = pair_contact_nodes(model, Rotation::negative, 1e-6);

      // (d a + 1) (d b + 1) nodes over a × b faces
      EXPECT_EQ(positive.size(), element == Element::trilinear ? 9u + 6u + 6u : 25u + 15u + 15u);
      ASSERT_EQ(negative.size(), positive.size());

      double             area = 0.;
      std::set<unsigned> disc_nodes, pin_nodes;
      for (std::size_t c = 0; c < positive.size(); ++c)
        {
          const ContactNode &node = positive[c];
          const double       r    = node.axis_distance();
          area += node.area;
          disc_nodes.insert(node.disc_node.number);
          pin_nodes.insert(node.pin_node.number);
          EXPECT_EQ(node.disc_node.component, 0u);
          EXPECT_EQ(node.pin_node.component, node.pin);
          for (int k = 0; k < 3; ++k)
            {
              EXPECT_EQ(node.position[k], node.disc_node.position[k]);
              EXPECT_NEAR(node.position[k], node.pin_node.position[k], 1e-15);
            }
          // n outwards, t along e_θ, b = n × t: outwards on top, inwards below
          const double side = node.position[2] > 0. ? 1. : -1.;
          EXPECT_EQ(node.normal, Eigen::Vector3d(0., 0., side));
          const Eigen::Vector3d e_theta(-node.position[1] / r, node.position[0] / r, 0.),
            e_r(node.position[0] / r, node.position[1] / r, 0.);
          EXPECT_NEAR(dot(node.sliding, e_theta), 1., 1e-15);
          EXPECT_NEAR(dot(node.radial, e_r), -side, 1e-15);
          EXPECT_NEAR(dot(negative[c].sliding, e_theta), -1., 1e-15);
          EXPECT_NEAR(dot(negative[c].radial, e_r), side, 1e-15);
          EXPECT_GT(node.area, 0.);
        }
      EXPECT_EQ(disc_nodes.size(), positive.size());
      EXPECT_EQ(pin_nodes.size(), positive.size());
      EXPECT_NEAR(std::abs(area) / std::abs(contact_area(mesh)), 1., 1e-12);
    }
}

TEST(ContactInterface, ConicalFacesGetTheirNormals)
{
  // z → z + s (r - r0): slopes towards the rim; normal (-s e_r + e_z) / √(1 + s²) on top but for the edges of the polygon
  const double slope = 0.3;
  const auto   mesh =
    mapped(extrude(polar_plan(0.15, 0.3, 3, 96, {{Plan::Side::top, -3, 6, 1, 1}, {Plan::Side::bottom, 3, 4, 1, 1}}), layers(2, 2)),
           [slope](const Point3 &p) {
             return Point3{{p[0], p[1], p[2] + slope * (std::hypot(p[0], p[1]) - 0.2)}};
           });
  for (const Element element : {Element::trilinear, Element::quadratic})
    for (const ContactNode &node : pairs(mesh, element))
      {
        const double          r = node.axis_distance(), scale = 1. / std::sqrt(1. + slope * slope);
        const Eigen::Vector3d e_r(node.position[0] / r, node.position[1] / r, 0.), e_theta(-e_r[1], e_r[0], 0.);
        // Faces span 3.75°: their normals differ from the cone's by half of that at the ends of a pin.
        const double tolerance = 1.1 * slope * M_PI / 96.;
        const double side      = node.normal[2] > 0. ? 1. : -1.;
        EXPECT_NEAR(dot(node.normal, e_r), -side * slope * scale, 1e-3);
        EXPECT_NEAR(dot(node.normal, e_theta), 0., tolerance);
        EXPECT_NEAR(node.normal[2], side * scale, 1e-3);
        EXPECT_NEAR(dot(node.sliding, e_theta), 1., tolerance * tolerance);
        for (const auto &[a, b, value] : {std::make_tuple(node.normal, node.normal, 1.), std::make_tuple(node.sliding, node.sliding, 1.),
                                          std::make_tuple(node.radial, node.radial, 1.), std::make_tuple(node.normal, node.sliding, 0.),
                                          std::make_tuple(node.normal, node.radial, 0.), std::make_tuple(node.sliding, node.radial, 0.)})
          EXPECT_NEAR(dot(a, b), value, 1e-15);
        // b = n × t
        for (int k = 0; k < 3; ++k)
          EXPECT_NEAR(node.radial[k],
                      node.normal[(k + 1) % 3] * node.sliding[(k + 2) % 3] - node.normal[(k + 2) % 3] * node.sliding[(k + 1) % 3], 1e-15);
      }
}

TEST(ContactInterface, PadsThatEndAtTheRimPairInDegree2)
{
  // The disc's rim and bore are curved; the pads' edges there must follow, whatever the shape of the rest of their outline.
  const HexMesh mesh =
    extrude(polar_plan(0.15, 0.3, 3, 16, {{Plan::Side::top, -1, 2, 1, 2}, {Plan::Side::bottom, 3, 3, 0, 1}}), layers(1, 1));
  const auto interface = pairs(mesh, Element::quadratic);
  EXPECT_EQ(interface.size(), 25u + 21u);
  int n_rim = 0, n_bore = 0;
  for (const ContactNode &node : interface)
    {
      n_rim += std::abs(node.axis_distance() - 0.3) < 1e-12;
      n_bore += std::abs(node.axis_distance() - 0.15) < 1e-12;
    }
  EXPECT_EQ(n_rim, 5);
  EXPECT_EQ(n_bore, 7);
}

TEST(ContactInterface, GapsAreRefused)
{
  // A pin that is displaced by more than the tolerance has no partners.
  HexMesh                mesh = flat_mesh();
  std::set<unsigned int> nodes;
  for (const auto &hexahedron : mesh.hexahedra)
    if (hexahedron.volume == 2)
      nodes.insert(hexahedron.nodes.begin(), hexahedron.nodes.end());
  HexMesh apart = mesh;
  for (const unsigned int node : nodes)
    apart.points[node][0] += 1e-4;
  const std::string message = refusal(apart);
  EXPECT_NE(message.find("6 of 21 nodes of pin_contact have no partner on disc_contact"), std::string::npos) << message;
  EXPECT_NE(message.find("the nearest node of the disc is 0.0001"), std::string::npos) << message;
  EXPECT_NE(message.find("Geometry/Pairing tolerance"), std::string::npos) << message;

  // Far away it says so.
  apart = mesh;
  for (const unsigned int node : nodes)
    apart.points[node][0] -= 2.;
  EXPECT_NE(refusal(apart).find("no node of the disc is within 10 mm"), std::string::npos) << refusal(apart);

  // Within the tolerance all is well.
  apart = mesh;
  for (const unsigned int node : nodes)
    apart.points[node][0] += 5e-7;
  EXPECT_EQ(refusal(apart), "accepted");
}

TEST(ContactInterface, NodesLeftOverOnTheDiscAreRefused)
{
  // One more face of the upper side belongs to the disc's contact surface.
  HexMesh    mesh = flat_mesh();
  const auto top  = GeometryParameters().disc_thickness / 2.;
  for (const auto &hexahedron : mesh.hexahedra)
    if (hexahedron.volume == 0 && mesh.points[hexahedron.nodes[4]][2] == top && mesh.points[hexahedron.nodes[4]][0] < -0.2)
      {
        mesh.quadrilaterals.push_back({{{hexahedron.nodes[4], hexahedron.nodes[5], hexahedron.nodes[6], hexahedron.nodes[7]}},
                                       static_cast<unsigned int>(surface(mesh, PhysicalNames::disc_contact))});
        break;
      }
  const std::string message = refusal(mesh);
  EXPECT_NE(message.find("4 of 25 nodes of disc_contact have no partner on pin_contact"), std::string::npos) << message;
}

TEST(ContactInterface, ANodeInTwoPairsIsRefused)
{
  // Two pins side by side: the disc's nodes between them would touch both.
  const std::string message =
    refusal(extrude(polar_plan(0.15, 0.3, 3, 16, {{Plan::Side::top, 0, 1, 1, 1}, {Plan::Side::top, 1, 1, 1, 1}}), layers(1, 1)));
  EXPECT_NE(message.find("a node of the disc touches two pin nodes"), std::string::npos) << message;
  EXPECT_NE(message.find("separate the pins"), std::string::npos) << message;
}

TEST(ContactInterface, AClampedContactNodeIsRefused)
{
  // The lateral faces of the pins are clamped as well, down to the contact.
  HexMesh mesh = flat_mesh();
  for (auto &face : mesh.quadrilaterals)
    if (mesh.surface_names[face.surface] == PhysicalNames::pin_side)
      face.surface = surface(mesh, PhysicalNames::pin_clamp);
  const std::string message = refusal(mesh);
  EXPECT_NE(message.find("is clamped by pin_clamp"), std::string::npos) << message;
}

TEST(ContactInterface, ANodeOnTheAxisIsRefused)
{
  const std::string message = refusal(extrude(round_plan(0., 0.03, 1), layers(1, 1)));
  EXPECT_NE(message.find("a contact node lies on the disc's axis"), std::string::npos) << message;
}

TEST(RadialDissipation, SharesTheLoadOfEachSide)
{
  const Model         model(flat_mesh(), Element::trilinear, MPI_COMM_WORLD);
  const auto          interface  = pair_contact_nodes(model, Rotation::positive, 1e-6);
  OperationParameters operation  = operating(RadialDissipation::consistent);
  operation.friction_coefficient = 0.37;
  operation.rotation_speed       = 3.;
  operation.load_per_side        = 500.;
  const auto consistent          = radial_dissipation(interface, equal_load_shares(model, interface, operation), operation);
  operation.radial_dissipation   = RadialDissipation::published;
  const auto published           = radial_dissipation(interface, equal_load_shares(model, interface, operation), operation);
  operation.radial_dissipation   = RadialDissipation::none;
  const auto none                = radial_dissipation(interface, equal_load_shares(model, interface, operation), operation);

  // c_b w_0 is the friction force μ R_n0 (consistent) or R_n0 (published): their sums are μ N and N on each side.
  double sums[2][2] = {};
  ASSERT_EQ(consistent.size(), interface.size());
  for (std::size_t c = 0; c < interface.size(); ++c)
    {
      const double w = operation.rotation_speed * interface[c].axis_distance();
      sums[0][interface[c].normal[2] > 0.] += consistent[c] * w;
      sums[1][interface[c].normal[2] > 0.] += published[c] * w;
      EXPECT_GT(consistent[c], 0.);
      EXPECT_EQ(none[c], 0.);
      // Equal shares
      EXPECT_NEAR(published[c] * w / (500. / (interface[c].normal[2] > 0. ? 9. : 12.)), 1., 1e-14);
    }
  for (int side = 0; side < 2; ++side)
    {
      EXPECT_NEAR(sums[0][side] / (0.37 * 500.), 1., 1e-14);
      EXPECT_NEAR(sums[1][side] / 500., 1., 1e-14);
    }
}
