// SPDX-License-Identifier: GPL-3.0-or-later

#include "scenes.h"

#include <squeal/geometry/cell_volume.h>
#include <squeal/geometry/mesh_check.h>
#include <squeal/geometry/mesh_file.h>
#include <squeal/geometry/mesh_topology.h>

#include <sstream>

using namespace Scenes;
using Point = Mesh::Point;

namespace
{
  /// A cell of a Gmsh type in its own volume, with the first @p n_nodes nodes of the complete cell.
  struct GmshCell
  {
    std::string  type, volume;
    Shape        shape;
    unsigned int degree, n_nodes;
  };

  Point placed(const Point &x, const std::size_t cell)
  {
    return Point(x[0] + 3. * cell, x[1], x[2] + 0.1 * x[0]);
  }

  GmshMesh gmsh_mesh(const std::vector<GmshCell> &cells)
  {
    GmshMesh mesh;
    for (std::size_t c = 0; c < cells.size(); ++c)
      {
        GmshMesh::Element element{c + 1, {}};
        const auto        nodes = reference_nodes(cells[c].shape, cells[c].degree);
        for (unsigned int i = 0; i < cells[c].n_nodes; ++i)
          {
            const Point p = placed(nodes[i], c);
            element.nodes.push_back(mesh.points.size());
            mesh.points.push_back({{p[0], p[1], p[2]}});
          }
        mesh.groups.push_back({3, static_cast<int>(c), cells[c].volume, {{cells[c].type, {element}}}});
      }
    return mesh;
  }

  const std::vector<GmshCell> complete = {{"Tetrahedron 10", "pin", Shape::tetrahedron, 2, 10},
                                          {"Pyramid 14", "disc", Shape::pyramid, 2, 14},
                                          {"Prism 18", "pad", Shape::wedge, 2, 18},
                                          {"Hexahedron 27", "shoe", Shape::hexahedron, 2, 27}};
} // namespace

TEST(MeshFile, TakesCellsOfEveryShapeAndOrder)
{
  const auto expect = [](const std::vector<GmshCell> &cells, const std::size_t n_added) {
    const Mesh mesh = make_mesh(gmsh_mesh(cells), {}, "here");
    ASSERT_EQ(mesh.cells.size(), 4u);
    EXPECT_EQ(mesh.degree, cells[0].degree);
    EXPECT_EQ(mesh.volume_names, (std::vector<std::string>{"disc", "pin", "pad", "shoe"}));
    EXPECT_EQ(mesh.body_names, mesh.volume_names);
    EXPECT_EQ(mesh.notes.size(), n_added > 0);
    if (n_added > 0)
      expect_mentions(mesh.notes[0], {"cells: " + std::to_string(n_added), "serendipity"});
    for (std::size_t c = 0; c < cells.size(); ++c)
      {
        const auto nodes = reference_nodes(cells[c].shape, cells[c].degree);
        ASSERT_EQ(mesh.cells[c].nodes.size(), nodes.size());
        for (unsigned int i = 0; i < nodes.size(); ++i)
          EXPECT_LT(mesh.points[mesh.cells[c].nodes[i]].distance(placed(nodes[i], c)), 1e-12);
      }
    EXPECT_EQ(cell_counts(mesh), "1 tetrahedra, 1 pyramids, 1 wedges, 1 hexahedra");
    EXPECT_NO_THROW(check_mesh(mesh));
    Mesh mirrored = moved(mesh, [](const Point &p) { return Point(-p[0], p[1], p[2]); });
    EXPECT_EQ(make_right_handed(mirrored), 4u);
    EXPECT_NO_THROW(check_mesh(mirrored));
    double volume = 0.;
    for (const Mesh::Cell &cell : mirrored.cells)
      volume += volume_of(mirrored, cell);
    EXPECT_NEAR(volume, 1. / 6. + 4. / 3. + 1. / 2. + 1., 1e-12);
  };
  expect(complete, 0);
  expect({{"Tetrahedron 4", "pin", Shape::tetrahedron, 1, 4},
          {"Pyramid 5", "disc", Shape::pyramid, 1, 5},
          {"Prism 6", "pad", Shape::wedge, 1, 6},
          {"Hexahedron 8", "shoe", Shape::hexahedron, 1, 8}},
         0);
  expect({{"Tetrahedron 10", "pin", Shape::tetrahedron, 2, 10},
          {"Pyramid 13", "disc", Shape::pyramid, 2, 13},
          {"Prism 15", "pad", Shape::wedge, 2, 15},
          {"Hexahedron 20", "shoe", Shape::hexahedron, 2, 20}},
         11);
}

TEST(MeshFile, SerendipityElementsShareTheNodesThatTheyGet)
{
  // Adjacent hexahedra have 27 and 20 nodes; the second has a named face of 8 nodes and a curved edge
  GmshMesh   mesh  = gmsh_mesh({complete[3], {"Hexahedron 20", "disc", Shape::hexahedron, 2, 20}});
  auto      &first = mesh.groups[0].elements.begin()->second[0].nodes, &second = mesh.groups[1].elements.begin()->second[0].nodes;
  const auto nodes_of = [](const unsigned int face) { return nodes_of_face(Shape::hexahedron, 2, face); };
  for (std::array<double, 3> &point : mesh.points)
    point[0] -= point[0] > 2. ? 2. : 0.;
  for (const unsigned int of_second : nodes_of(2))
    for (const unsigned int of_first : nodes_of(3))
      if (of_second < 20 && mesh.points[first[of_first]][1] == mesh.points[second[of_second]][1])
        if (std::abs(reference_nodes(Shape::hexahedron, 2)[of_first][2] - reference_nodes(Shape::hexahedron, 2)[of_second][2]) < 0.1)
          second[of_second] = first[of_first];
  mesh.groups[0].name = "disc_hat";
  mesh.points[second[18]][0] += 0.2; // middle of the edge from corner 5 to corner 6
  GmshMesh::Element face{9, {}};
  for (unsigned int i = 0; i < 8; ++i)
    face.nodes.push_back(second[nodes_of(3)[i]]);
  mesh.groups.insert(mesh.groups.begin(), {2, 1, "disc_rim", {{"Quadrilateral 8", {face}}}});

  const Mesh result = make_mesh(mesh, {}, "here");
  EXPECT_EQ(result.points.size(), 27u + 27u - 9u);
  EXPECT_EQ(result.body_names, std::vector<std::string>{"disc"});
  ASSERT_EQ(result.faces.size(), 1u);
  const unsigned int centre = result.faces[0].nodes[8];
  EXPECT_EQ(centre, result.cells[1].nodes[nodes_of(3)[8]]);
  EXPECT_NEAR(result.points[centre][0], 2.1, 1e-12);                     // half of the shift of the edge
  EXPECT_NEAR(result.points[result.cells[1].nodes[26]][0], 1.55, 1e-12); // a quarter of the shift
}

TEST(MeshFile, OtherElementsAreRefused)
{
  const auto refusal = [](const std::vector<GmshCell> &cells) {
    return message<MeshError>([&] { make_mesh(gmsh_mesh(cells), {}, "here"); });
  };
  expect_mentions(refusal({complete[0], {"Hexahedron 8", "disc", Shape::hexahedron, 1, 8}}),
                  {"different orders", "'Tetrahedron 10' and 'Hexahedron 8'", "here"});
  expect_mentions(refusal({{"Tetrahedron 20", "disc", Shape::tetrahedron, 1, 4}}), {"unsupported type 'Tetrahedron 20' (number: 1)"});
}

TEST(MeshFile, TetrahedraOfGmshAreReadAndWritten)
{
  for (const char *order : {"1", "2"})
    {
      const File geo("balls.geo", std::string(R"(
        SetFactory("OpenCASCADE");
        Cylinder(1) = {0, 0, 0, 0, 0, 0.5, 1};
        Box(2) = {0, 0, 0.5, 0.4, 0.4, 0.25};
        Mesh.MeshSizeMin = 0.4; Mesh.MeshSizeMax = 0.4;
        Physical Volume("disc") = {1}; Physical Volume("shoe") = {2}; Physical Surface("disc_rim") = {1};
        Physical Surface("disc_contact") = {2}; Physical Surface("pin_contact") = {8}; Physical Surface("pin_clamp") = {9};
      )") + "Mesh.ElementOrder = " + order +
                                    ";\n");
      const Mesh mesh = generate_mesh(of_file(geo.string()));
      EXPECT_EQ(mesh.degree, std::stoul(order));
      EXPECT_EQ(mesh.cells[0].shape, Shape::tetrahedron);
      EXPECT_EQ(mesh.body_names, (std::vector<std::string>{"disc", "shoe"}));
      for (const unsigned int node : nodes_on(mesh, "disc_rim"))
        EXPECT_NEAR(std::hypot(mesh.points[node][0], mesh.points[node][1]), 1., 1e-6);
      std::ostringstream once, twice;
      write_msh(mesh, once);
      write_msh(generate_mesh(of_file(File("mesh.msh", once.str()).string())), twice);
      EXPECT_EQ(once.str(), twice.str());
    }
}

TEST(MeshFile, VolumesThatShareNodesAreOneBody)
{
  const auto meshed = [](const std::string &second, const std::string &third) {
    const File file("pad.geo", R"(
      SetFactory("OpenCASCADE");
      Box(1) = {0, 0, 0, 1, 1, 0.5};
      Box(2) = {0, 0, 0.5, 1, 1, 0.25};
      Box(3) = {0, 0, 0.75, 1, 1, 0.1};
      BooleanFragments{ Volume{2}; Delete; }{ Volume{3}; Delete; }
      Mesh.MeshSizeMin = 1;
      disc() = Surface In BoundingBox {-1, -1, 0.49, 2, 2, 0.51};
      clamp() = Surface In BoundingBox {-1, -1, 0.84, 2, 2, 0.86};
      Physical Surface("disc_contact") = {disc(0)}; Physical Surface("pin_contact") = {disc(1)}; Physical Surface("pin_clamp") = {clamp()};
      Physical Volume("disc") = {1};
    )" + ("Physical Volume(\"" + second + "\") = {2}; Physical Volume(\"" + third + "\") = {3};\n"));
    return generate_mesh(of_file(file.string()));
  };
  const Mesh mesh = meshed("pin_1_lining", "pin_1_backplate");
  EXPECT_EQ(mesh.volume_names, (std::vector<std::string>{"disc", "pin_1_lining", "pin_1_backplate"}));
  EXPECT_EQ(mesh.body_names, (std::vector<std::string>{"disc", "pin_1"}));
  EXPECT_EQ(mesh.body_of_volume, (std::vector<unsigned int>{0, 1, 1}));
  expect_mentions(message<MeshError>([&] { meshed("pin_1", "disc_plate"); }), {"'disc_plate'", "'pin_1'", "share nodes"});
}

TEST(Bodies, AreNamedAfterTheirVolumes)
{
  // Names of bodies formed by tetrahedra, some of which share a node
  const auto names = [](const std::vector<std::string> &volumes, const std::vector<std::array<unsigned int, 2>> &joined) {
    Mesh mesh;
    mesh.volume_names = volumes;
    mesh.points.resize(4 * volumes.size());
    for (unsigned int v = 0; v < volumes.size(); ++v)
      mesh.cells.push_back({Shape::tetrahedron, {4 * v, 4 * v + 1, 4 * v + 2, 4 * v + 3}, v});
    for (const auto &[a, b] : joined)
      mesh.cells[b].nodes[0] = mesh.cells[a].nodes[3];
    find_bodies(mesh);
    return mesh.body_names;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names({"pin_2", "disc", "pin_1"}, {}), (Names{"disc", "pin_2", "pin_1"}));
  EXPECT_EQ(names({"disc_hat", "pin_1_lining", "disc_ring", "pin_1_back"}, {{{1, 3}}}), (Names{"disc", "pin_1"}));
  EXPECT_EQ(names({"disc", "pad-1a", "pad-1b"}, {{{1, 2}}}), (Names{"disc", "pad"}));
  EXPECT_EQ(names({"disc", "lining", "backplate"}, {{{1, 2}}}), (Names{"disc", "lining"}));
  EXPECT_EQ(names({"disc", "pin_1_a", "pin_1_b", "pin_1"}, {{{1, 2}}}), (Names{"disc", "pin_1_a", "pin_1"}));
  EXPECT_EQ(names({"disc", "pin_1", "pin_1_b"}, {{{1, 2}}}), (Names{"disc", "pin_1"}));
}
