#include "scenes.h"

#include <squeal/geometry/mesh_check.h>
#include <squeal/geometry/mesh_topology.h>

#include <functional>
#include <map>
#include <sstream>

using namespace Scenes;

namespace
{
  using Point  = HexMesh::Point;
  using Values = std::vector<double>;
  using Place  = std::function<Point(const Point &)>;

  const double pi                = std::acos(-1.);
  const double pairing_tolerance = 1e-6;

  enum Surface : unsigned int
  {
    disc_contact,
    pin_contact
  };

  Values interval(const double first, const double last, const int n)
  {
    Values values;
    for (int i = 0; i <= n; ++i)
      values.push_back(first + (last - first) * i / n);
    return values;
  }

  /// Angles of parts of a circle of n, from one to another.
  Values angles(const int n, const int first, const int last)
  {
    return interval(2. * pi * first / n, 2. * pi * last / n, last - first);
  }

  Point cylindrical(const Point &p)
  {
    return {p[0] * std::cos(p[1]), p[0] * std::sin(p[1]), p[2]};
  }

  Point cartesian(const Point &p)
  {
    return p;
  }

  HexMesh mesh_of(const std::vector<std::string> &volumes)
  {
    HexMesh mesh;
    mesh.volume_names  = volumes;
    mesh.surface_names = {"disc_contact", "pin_contact"};
    return mesh;
  }

  bool is_any(const Point &)
  {
    return true;
  }

  bool is_none(const Point &)
  {
    return false;
  }

  /// Adds a grid of cells. Where @p is_shared, it shares nodes at the same place with itself and with what its volume has already.
  void add_grid(HexMesh                                  &mesh,
                const unsigned int                        volume,
                const Values                             &a,
                const Values                             &b,
                const Values                             &c,
                const Place                              &place     = cylindrical,
                const std::function<bool(const Point &)> &is_shared = is_none)
  {
    const auto key = [](const Point &p) {
      return std::array<long, 3>{{std::lround(1e8 * p[0]), std::lround(1e8 * p[1]), std::lround(1e8 * p[2])}};
    };
    std::map<std::array<long, 3>, unsigned int> known;
    for (const auto &[cell, body] : mesh.hexahedra)
      if (body == volume)
        for (const unsigned int node : cell)
          known[key(mesh.points[node])] = node;
    std::vector<unsigned int> nodes;
    for (const double x : a)
      for (const double y : b)
        for (const double z : c)
          {
            const Point p = place({x, y, z});
            if (const auto [found, is_new] = known.emplace(key(p), mesh.points.size()); !is_new && is_shared(p))
              nodes.push_back(found->second);
            else
              {
                nodes.push_back(mesh.points.size());
                mesh.points.push_back(p);
              }
          }
    const auto node = [&](const unsigned int i, const unsigned int j, const unsigned int k) {
      return nodes[(i * b.size() + j) * c.size() + k];
    };
    for (unsigned int i = 0; i + 1 < a.size(); ++i)
      for (unsigned int j = 0; j + 1 < b.size(); ++j)
        for (unsigned int k = 0; k + 1 < c.size(); ++k)
          mesh.hexahedra.push_back({{{node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k), node(i, j, k + 1),
                                      node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)}},
                                    volume});
  }

  /// Names faces whose nodes all are wanted: faces of the disc first, of other volumes as pin_contact.
  void name_contact(HexMesh &mesh, const std::function<bool(const Point &)> &is_wanted)
  {
    constexpr unsigned int faces[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    for (const auto &[cell, volume] : mesh.hexahedra)
      for (const auto &face : faces)
        {
          const std::array<unsigned int, 4> nodes = {{cell[face[0]], cell[face[1]], cell[face[2]], cell[face[3]]}};
          if (std::all_of(nodes.begin(), nodes.end(), [&](const unsigned int node) { return is_wanted(mesh.points[node]); }))
            mesh.quadrilaterals.push_back({nodes, volume == 0 ? disc_contact : pin_contact});
        }
  }

  const Values radii = {0.15, 0.2, 0.25, 0.3};

  bool is_under_pad(const Point &p)
  {
    const double r = std::hypot(p[0], p[1]), theta = std::atan2(p[1], p[0]);
    return std::abs(p[2] - 0.02) < 1e-9 && r > 0.19 && theta > -0.01 && theta < 2. * pi / 24. * 3.01;
  }

  /// A ring with a pad above, from z = 0.02 on.
  HexMesh disc_with_pad(const Values &pad_z = {0.02, 0.03, 0.04}, const Values &ring = angles(24, 0, 24))
  {
    HexMesh mesh = mesh_of({"disc", "pin_top"});
    add_grid(mesh, 0, radii, ring, {0., 0.01, 0.02}, cylindrical, is_any);
    add_grid(mesh, 1, {0.2, 0.25, 0.3}, angles(24, 0, 3), pad_z);
    name_contact(mesh, is_under_pad);
    return mesh;
  }

  HexMesh moved(HexMesh mesh, const Place &motion)
  {
    for (Point &point : mesh.points)
      point = motion(point);
    return mesh;
  }

  Point rotated(const Point &p)
  {
    const double c = std::cos(0.7), s = std::sin(0.7);
    return {c * p[0] - s * p[2], p[1], s * p[0] + c * p[2]};
  }

  /// As in a file with so many significant digits.
  HexMesh rounded(const HexMesh &mesh, const int digits)
  {
    return moved(mesh, [digits](const Point &p) {
      Point result;
      for (unsigned int d = 0; d < 3; ++d)
        {
          std::ostringstream text;
          text << std::setprecision(digits) << p[d];
          result[d] = std::stod(text.str());
        }
      return result;
    });
  }

  std::string refusal(const HexMesh &mesh)
  {
    check_mesh(mesh);
    return message<MeshError>([&] { check_topology(mesh, pairing_tolerance, "the.msh"); });
  }

  void expect_passes(const HexMesh &mesh)
  {
    EXPECT_NO_THROW(check_topology(mesh, pairing_tolerance, "the.msh"));
  }

  /// Refused in every size, position and precision of coordinates.
  void expect_refused(const HexMesh &mesh, const std::vector<std::string> &mentions)
  {
    expect_mentions(refusal(mesh), mentions);
    expect_mentions(refusal(moved(mesh, rotated)), mentions);
    expect_mentions(refusal(rounded(moved(mesh, [](const Point &p) { return 1000. * p; }), 7)), mentions);
    expect_mentions(refusal(rounded(mesh, 6)), mentions);
  }
} // namespace

TEST(MeshTopology, ConformingMeshesPass)
{
  const HexMesh mesh = disc_with_pad();
  ASSERT_EQ(mesh.quadrilaterals.size(), 12u);
  expect_passes(mesh);
  expect_passes(moved(mesh, rotated));
  expect_passes(rounded(mesh, 6));
  expect_passes(disc_with_pad({0.02, 0.020005, 0.04}));          // a thin layer
  expect_passes(disc_with_pad({0.02, 0.03}, angles(48, 0, 48))); // a finer disc
  EXPECT_EQ(find_unnamed_contact(mesh).n_nodes, 0u);
}

TEST(MeshTopology, SeamIsFound)
{
  // The ring ends where it begins, and nearly so
  for (const double gap : {0., 1e-9, 6e-6})
    {
      HexMesh mesh = mesh_of({"disc", "pin_top"});
      Values  ring = angles(24, 0, 24);
      ring.back() -= gap / 0.3;
      add_grid(mesh, 0, radii, ring, {0., 0.01, 0.02});
      expect_refused(mesh, {"12 nodes of volume 'disc' coincide", "the.msh", "merge"});
      expect_mentions(refusal(mesh), {"(0.15, "});
    }
}

TEST(MeshTopology, NarrowSlotPasses)
{
  Values ring = angles(24, 0, 24);
  ring.back() -= 1e-2 * 0.01 / 0.15; // 1 % of the shortest edge
  HexMesh mesh = mesh_of({"disc"});
  add_grid(mesh, 0, radii, ring, {0., 0.01, 0.02});
  expect_passes(mesh);
  expect_passes(rounded(mesh, 6));
}

TEST(MeshTopology, CrackInsideIsFound)
{
  // Two halves that share only the nodes around six inner ones
  HexMesh mesh = mesh_of({"disc"});
  add_grid(mesh, 0, interval(0., 4., 4), interval(0., 3., 3), {0., 1.}, cartesian);
  add_grid(mesh, 0, interval(0., 4., 4), interval(0., 3., 3), {1., 2.}, cartesian,
           [](const Point &p) { return p[0] < 0.5 || p[0] > 3.5 || p[1] < 0.5 || p[1] > 2.5; });
  expect_refused(mesh, {"6 nodes of volume 'disc' coincide"});
  EXPECT_NE(refusal(mesh).find("(1, 1, 1)"), std::string::npos);
}

TEST(MeshTopology, HangingNodesAreFound)
{
  // A layer twice as fine along two directions: on interior faces, 2 x 2 elements to one
  HexMesh layers = mesh_of({"disc"});
  add_grid(layers, 0, interval(0., 2., 2), interval(0., 2., 2), {0., 1.}, cartesian, is_any);
  add_grid(layers, 0, interval(0., 2., 4), interval(0., 2., 4), {1., 2.}, cartesian, is_any);
  expect_refused(layers, {"16 nodes of volume 'disc'", "hanging"});

  // In a corner only
  HexMesh corner = mesh_of({"disc"});
  add_grid(corner, 0, interval(0., 3., 3), interval(0., 3., 3), {0., 1.}, cartesian, is_any);
  add_grid(corner, 0, interval(0., 3., 3), {0., 1., 2.}, {1., 2.}, cartesian, is_any);
  add_grid(corner, 0, interval(0., 2., 2), {2., 3.}, {1., 2.}, cartesian, is_any);
  add_grid(corner, 0, {2., 2.5, 3.}, {2., 3.}, {1., 2.}, cartesian, is_any);
  expect_refused(corner, {"3 nodes of volume 'disc'", "hanging"});
  EXPECT_NE(refusal(corner).find("(2.5, 2, 1)"), std::string::npos);

  // Between rings: nodes of the finer one are on the circle, faces of the coarser one are chords
  for (const bool fine_inside : {false, true})
    {
      HexMesh rings = mesh_of({"disc"});
      add_grid(rings, 0, {0.1, 0.2}, angles(fine_inside ? 32 : 16, 0, fine_inside ? 32 : 16), {0., 0.05}, cylindrical, is_any);
      add_grid(rings, 0, {0.2, 0.3}, angles(fine_inside ? 16 : 32, 0, fine_inside ? 16 : 32), {0., 0.05}, cylindrical, is_any);
      expect_refused(rings, {"32 nodes of volume 'disc'", "hanging"});
    }
}

TEST(MeshTopology, ElementsThatMeetAtAnEdgePass)
{
  HexMesh mesh = mesh_of({"disc"});
  add_grid(mesh, 0, {0., 1.}, {0., 1.}, {0., 1.}, cartesian, is_any);
  add_grid(mesh, 0, {1., 2.}, {1., 2.}, {0., 1.}, cartesian, is_any);
  expect_passes(mesh);
}

TEST(MeshTopology, BodyOnTheWrongSideIsFound)
{
  HexMesh mesh = mesh_of({"disc", "pin_top"});
  add_grid(mesh, 0, radii, angles(24, 0, 24), {0., 0.01, 0.02}, cylindrical, is_any);
  add_grid(mesh, 1, {0.2, 0.25, 0.3}, angles(24, 0, 3), {0., 0.015, 0.02});
  name_contact(mesh, is_under_pad);
  ASSERT_EQ(mesh.quadrilaterals.size(), 12u);
  expect_refused(mesh, {"'pin_top'", "same side", "6 contact faces"});
}

TEST(MeshTopology, OverlapIsFound)
{
  // A copy of the pad: its nodes lie on those of the other one, only centres are inside
  HexMesh copy      = disc_with_pad();
  copy.volume_names = {"disc", "pin_1", "pin_2"};
  add_grid(copy, 2, {0.2, 0.25, 0.3}, angles(24, 0, 3), {0.02, 0.03, 0.04});
  expect_refused(copy, {"'pin_1'", "'pin_2'", "overlap", "0 nodes and 12 element centres"});

  // A small body within one element, one that reaches out of the disc
  for (const double end : {0.008, 0.5})
    {
      HexMesh inside      = disc_with_pad();
      inside.volume_names = {"disc", "pin_1", "pin_2"};
      add_grid(inside, 2, {-0.23, -0.22}, {-0.01, 0.01}, interval(0.004, end, 1), cartesian);
      expect_refused(inside, {"'pin_2'", "'disc'", "overlap", end > 0.1 ? "4 nodes" : "8 nodes"});
    }
}

TEST(MeshTopology, ChordsOfCurvedFacesMayCross)
{
  // A shoe on the rim whose elements are twice as long
  HexMesh mesh = mesh_of({"disc", "pin_rim"});
  add_grid(mesh, 0, radii, angles(96, 0, 96), {0., 0.02}, cylindrical, is_any);
  add_grid(mesh, 1, {0.3, 0.33}, angles(48, 1, 7), {0., 0.02});
  expect_passes(mesh);
}

TEST(MeshTopology, BodiesThatTouchWithoutContactAreNoted)
{
  // The pad's last column has no name
  HexMesh mesh = disc_with_pad();
  mesh.quadrilaterals.clear();
  name_contact(mesh, [](const Point &p) { return is_under_pad(p) && std::atan2(p[1], p[0]) < 2. * pi / 24. * 2.01; });
  const UnnamedContact contact = find_unnamed_contact(mesh);
  EXPECT_EQ(contact.n_nodes, 3u);
  EXPECT_EQ(contact.body, "disc");
  EXPECT_EQ(contact.other, "pin_top");
  EXPECT_NEAR(contact.place[2], 0.02, 1e-12);
}
