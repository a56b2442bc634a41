// SPDX-License-Identifier: GPL-3.0-or-later

#include "scenes.h"

#include <squeal/geometry/mesh_check.h>
#include <squeal/geometry/mesh_topology.h>

#include <map>
#include <sstream>

using namespace Scenes;

namespace
{
  using Point  = Mesh::Point;
  using Values = std::vector<double>;
  using Choice = std::function<bool(const Point &)>;

  Values interval(const double first, const double last, const int n)
  {
    Values values;
    for (int i = 0; i <= n; ++i)
      values.push_back(first + (last - first) * i / n);
    return values;
  }

  /// Angles of a circle divided into n equal parts, from index @p first to index @p last.
  Values angles(const int n, const int first, const int last)
  {
    return interval(2. * M_PI * first / n, 2. * M_PI * last / n, last - first);
  }

  const Place  cylindrical = [](const Point &p) { return Point(p[0] * std::cos(p[1]), p[0] * std::sin(p[1]), p[2]); };
  const Place  cartesian   = [](const Point &p) { return p; };
  const Choice any         = [](const Point &) { return true; };
  const Choice none        = [](const Point &) { return false; };

  Mesh mesh_of(const std::vector<std::string> &volumes)
  {
    Mesh mesh;
    mesh.volume_names = mesh.body_names = volumes;
    for (unsigned int volume = 0; volume < volumes.size(); ++volume)
      mesh.body_of_volume.push_back(volume);
    mesh.surface_names = {"disc_contact", "pin_contact"};
    return mesh;
  }

  /// Adds a grid of cells; merges coincident nodes of the volume if @p is_shared is true for them.
  void add_grid(Mesh              &mesh,
                const unsigned int volume,
                const Values      &a,
                const Values      &b,
                const Values      &c,
                const Place       &place     = cylindrical,
                const Choice      &is_shared = none)
  {
    const auto key = [](const Point &p) {
      return std::array<long, 3>{{std::lround(1e8 * p[0]), std::lround(1e8 * p[1]), std::lround(1e8 * p[2])}};
    };
    std::map<std::array<long, 3>, unsigned int> known;
    for (const Mesh::Cell &cell : mesh.cells)
      if (cell.volume == volume)
        for (const unsigned int node : cell.nodes)
          known[key(mesh.points[node])] = node;
    std::vector<unsigned int> nodes;
    for (const double x : a)
      for (const double y : b)
        for (const double z : c)
          {
            const Point p             = place({x, y, z});
            const auto [found, added] = known.emplace(key(p), mesh.points.size());
            const bool is_new         = added || !is_shared(p);
            nodes.push_back(is_new ? mesh.points.size() : found->second);
            if (is_new)
              mesh.points.push_back(p);
          }
    const unsigned int nz = c.size(), nyz = b.size() * nz;
    for (unsigned int i = 0; i + 1 < a.size(); ++i)
      for (unsigned int j = 0; j + 1 < b.size(); ++j)
        for (unsigned int k = 0; k + 1 < c.size(); ++k)
          {
            Mesh::Cell cell{Shape::hexahedron, {}, volume};
            for (const unsigned int corner : {0u, nyz, nyz + nz, nz, 1u, nyz + 1, nyz + nz + 1, nz + 1})
              cell.nodes.push_back(nodes[i * nyz + j * nz + k + corner]);
            mesh.cells.push_back(cell);
          }
  }

  /// Adds the faces whose nodes all satisfy @p is_wanted, as disc_contact on the disc and as pin_contact on other bodies.
  void name_contact(Mesh &mesh, const Choice &is_wanted)
  {
    for (const CellFace &face : all_faces(mesh))
      if (std::all_of(face.corners.begin(), face.corners.end(), [&](const unsigned int node) { return is_wanted(mesh.points[node]); }))
        mesh.faces.push_back({Shape::quadrilateral, Mesh::Nodes(face.corners.begin(), face.corners.end()), face.body == 0 ? 0u : 1u});
  }

  const Values radii = {0.15, 0.2, 0.25, 0.3};

  /// Nodes of the contact between ring and pad in the first @p n_sectors of the 24 sectors.
  Choice under_pad(const int n_sectors)
  {
    return [n_sectors](const Point &p) {
      const double r = std::hypot(p[0], p[1]), theta = std::atan2(p[1], p[0]);
      return std::abs(p[2] - 0.02) < 1e-9 && r > 0.19 && theta > -0.01 && theta < 2. * M_PI / 24. * (n_sectors + 0.01);
    };
  }

  /// A ring with a pad of three sectors on top, at z ≥ 0.02.
  Mesh disc_with_pad(const Values &pad_z = {0.02, 0.03, 0.04}, const Values &ring = angles(24, 0, 24), const int n_sectors = 3)
  {
    Mesh mesh = mesh_of({"disc", "pin_top"});
    add_grid(mesh, 0, radii, ring, {0., 0.01, 0.02}, cylindrical, any);
    add_grid(mesh, 1, {0.2, 0.25, 0.3}, angles(24, 0, 3), pad_z);
    name_contact(mesh, under_pad(n_sectors));
    return mesh;
  }

  Point rotated(const Point &p)
  {
    const double c = std::cos(0.7), s = std::sin(0.7);
    return {c * p[0] - s * p[2], p[1], s * p[0] + c * p[2]};
  }

  /// The mesh with coordinates of a limited number of significant digits, as read from a file.
  Mesh rounded(const Mesh &mesh, const int digits)
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

  std::string refusal(const Mesh &mesh)
  {
    check_mesh(mesh);
    return message<MeshError>([&] { check_topology(mesh, 1e-6, "the.msh"); });
  }

  void expect_passes(const Mesh &mesh)
  {
    EXPECT_NO_THROW(check_topology(mesh, 1e-6, "the.msh"));
  }

  /// Expects the mesh to be rejected for several scales, positions and precisions of the coordinates.
  void expect_refused(const Mesh &mesh, const std::vector<std::string> &mentions)
  {
    expect_mentions(refusal(mesh), mentions);
    expect_mentions(refusal(moved(mesh, rotated)), mentions);
    expect_mentions(refusal(rounded(moved(mesh, [](const Point &p) { return 1000. * p; }), 7)), mentions);
    expect_mentions(refusal(rounded(mesh, 6)), mentions);
  }
} // namespace

TEST(MeshTopology, ConformingMeshesPass)
{
  const Mesh mesh = disc_with_pad();
  ASSERT_EQ(mesh.faces.size(), 12u);
  EXPECT_EQ(find_unnamed_contact(mesh).n_nodes, 0u);
  expect_passes(mesh);
  expect_passes(moved(mesh, rotated));
  expect_passes(rounded(mesh, 6));
  expect_passes(disc_with_pad({0.02, 0.020005, 0.04}));          // a thin layer is accepted
  expect_passes(disc_with_pad({0.02, 0.03}, angles(48, 0, 48))); // a finer disc is accepted

  // Elements may share only an edge
  Mesh corner = mesh_of({"disc"});
  add_grid(corner, 0, {0., 1.}, {0., 1.}, {0., 1.}, cartesian, any);
  add_grid(corner, 0, {1., 2.}, {1., 2.}, {0., 1.}, cartesian, any);
  expect_passes(corner);

  // Elements of a shoe on the rim are twice as long, and chords of the curved faces intersect
  Mesh shoe = mesh_of({"disc", "pin_rim"});
  add_grid(shoe, 0, radii, angles(96, 0, 96), {0., 0.02}, cylindrical, any);
  add_grid(shoe, 1, {0.3, 0.33}, angles(48, 1, 7), {0., 0.02});
  expect_passes(shoe);
}

TEST(MeshTopology, SeamIsFound)
{
  const auto with_gap = [](const double gap, const double radius) {
    Mesh   mesh = mesh_of({"disc", "pin_top"});
    Values ring = angles(24, 0, 24);
    ring.back() -= gap / radius;
    add_grid(mesh, 0, radii, ring, {0., 0.01, 0.02});
    return mesh;
  };
  // Close the ring without and with a tiny gap
  for (const double gap : {0., 1e-9, 6e-6})
    {
      expect_refused(with_gap(gap, 0.3), {"12 nodes of body 'disc' coincide", "the.msh", "merge"});
      expect_mentions(refusal(with_gap(gap, 0.3)), {"(0.15, "});
    }
  // A slot of 1 % of the shortest edge is accepted
  const Mesh slot = with_gap(1e-2 * 0.01, 0.15);
  expect_passes(slot);
  expect_passes(rounded(slot, 6));
}

TEST(MeshTopology, CrackInsideIsFound)
{
  // Join two halves except at six inner nodes
  Mesh mesh = mesh_of({"disc"});
  add_grid(mesh, 0, interval(0., 4., 4), interval(0., 3., 3), {0., 1.}, cartesian);
  add_grid(mesh, 0, interval(0., 4., 4), interval(0., 3., 3), {1., 2.}, cartesian,
           [](const Point &p) { return p[0] < 0.5 || p[0] > 3.5 || p[1] < 0.5 || p[1] > 2.5; });
  expect_refused(mesh, {"6 nodes of body 'disc' coincide"});
  expect_mentions(refusal(mesh), {"(1, 1, 1)"});
}

TEST(MeshTopology, HangingNodesAreFound)
{
  // In a layer that is twice as fine in two directions, 2 × 2 faces meet one face
  Mesh layers = mesh_of({"disc"});
  add_grid(layers, 0, interval(0., 2., 2), interval(0., 2., 2), {0., 1.}, cartesian, any);
  add_grid(layers, 0, interval(0., 2., 4), interval(0., 2., 4), {1., 2.}, cartesian, any);
  expect_refused(layers, {"16 nodes of body 'disc'", "hanging"});

  // Refine only one corner of a mesh
  Mesh corner = mesh_of({"disc"});
  add_grid(corner, 0, interval(0., 3., 3), interval(0., 3., 3), {0., 1.}, cartesian, any);
  add_grid(corner, 0, interval(0., 3., 3), {0., 1., 2.}, {1., 2.}, cartesian, any);
  add_grid(corner, 0, interval(0., 2., 2), {2., 3.}, {1., 2.}, cartesian, any);
  add_grid(corner, 0, {2., 2.5, 3.}, {2., 3.}, {1., 2.}, cartesian, any);
  expect_refused(corner, {"3 nodes of body 'disc'", "hanging"});
  expect_mentions(refusal(corner), {"(2.5, 2, 1)"});

  // Between rings, nodes of the finer ring lie on the circle, and faces of the coarser ring are chords
  for (const int n_inside : {16, 32})
    {
      Mesh rings = mesh_of({"disc"});
      add_grid(rings, 0, {0.1, 0.2}, angles(n_inside, 0, n_inside), {0., 0.05}, cylindrical, any);
      add_grid(rings, 0, {0.2, 0.3}, angles(48 - n_inside, 0, 48 - n_inside), {0., 0.05}, cylindrical, any);
      expect_refused(rings, {"32 nodes of body 'disc'", "hanging"});
    }
}

TEST(MeshTopology, TrianglesUponQuadrilateralsAreFound)
{
  // Place a pyramid on a cube, then two tetrahedra instead of the pyramid
  Mesh mesh = mesh_of({"disc"});
  add_grid(mesh, 0, {0., 1.}, {0., 1.}, {0., 1.}, cartesian);
  mesh.points.emplace_back(0.4, 0.6, 2.);
  const auto top     = mesh.cells[0].nodes;
  Mesh       pyramid = mesh;
  pyramid.cells.push_back({Shape::pyramid, {top[4], top[5], top[6], top[7], 8}, 0});
  expect_passes(pyramid);
  mesh.cells.push_back({Shape::tetrahedron, {top[4], top[5], top[6], 8}, 0});
  mesh.cells.push_back({Shape::tetrahedron, {top[4], top[6], top[7], 8}, 0});
  expect_refused(mesh, {"1 quadrilateral face", "body 'disc'", "two triangles", "pyramids"});
}

TEST(MeshTopology, BodyOnTheWrongSideIsFound)
{
  const Mesh mesh = disc_with_pad({0., 0.015, 0.02});
  ASSERT_EQ(mesh.faces.size(), 12u);
  expect_refused(mesh, {"'pin_top'", "same side", "6 contact faces"});
}

TEST(MeshTopology, OverlapIsFound)
{
  const auto with_second_pin = [](const Values &a, const Values &b, const Values &c, const Place &place) {
    Mesh mesh         = disc_with_pad();
    mesh.volume_names = mesh.body_names = {"disc", "pin_1", "pin_2"};
    mesh.body_of_volume                 = {0, 1, 2};
    add_grid(mesh, 2, a, b, c, place);
    return mesh;
  };
  // The overlap with a copy of the pad is detected only at element centres, because the nodes coincide
  expect_refused(with_second_pin({0.2, 0.25, 0.3}, angles(24, 0, 3), {0.02, 0.03, 0.04}, cylindrical),
                 {"'pin_1'", "'pin_2'", "overlap", "0 nodes and 12 element centres"});
  // Place a small body inside one element, and a body that protrudes from the disc
  for (const auto &[end, nodes] : {std::pair(0.008, "8 nodes"), {0.5, "4 nodes"}})
    expect_refused(with_second_pin({-0.23, -0.22}, {-0.01, 0.01}, {0.004, end}, cartesian), {"'pin_2'", "'disc'", "overlap", nodes});
}

TEST(MeshTopology, BodiesThatTouchWithoutContactAreNoted)
{
  // Omit the names of the last column of pad faces
  const UnnamedContact contact = find_unnamed_contact(disc_with_pad({0.02, 0.03, 0.04}, angles(24, 0, 24), 2));
  EXPECT_EQ(contact.n_nodes, 3u);
  EXPECT_EQ(contact.body, "disc");
  EXPECT_EQ(contact.other, "pin_top");
  EXPECT_NEAR(contact.place[2], 0.02, 1e-12);
}
