// SPDX-License-Identifier: GPL-3.0-or-later

#include "scenes.h"

#include <squeal/geometry/mesh_check.h>

using namespace Scenes;

namespace
{
  /// Error message of generate_mesh().
  std::string refusal(const GeometryParameters &parameters, const std::vector<std::string> &additional_surfaces = {})
  {
    return message<MeshError>([&] { generate_mesh(parameters, additional_surfaces); });
  }

  using Refusals = std::vector<std::pair<std::string, std::vector<std::string>>>;

  /// Expects rejection of the file geometry.geo with each of these contents.
  void expect_refused(const Refusals &refusals)
  {
    for (const auto &[content, mentions] : refusals)
      expect_mentions(refusal(of_file(File("geometry.geo", content).string())), mentions);
  }
} // namespace

TEST(Refusals, FilesThatGmshCannotMesh)
{
  expect_mentions(refusal(of_file("no_such_file.geo")), {"no_such_file.geo", std::filesystem::current_path().string(), "Geometry/File"});
  expect_refused({{"Point(1) = {0, 0, 0};\nthis is not Gmsh\n", {"geometry.geo", "line 2", "syntax error"}},
                  // Lines that are not closed cannot bound a surface
                  {R"(
                     Point(1) = {0, 0, 0, 1}; Point(2) = {1, 1, 0, 1}; Point(3) = {1, 0, 0, 1}; Point(4) = {0, 1, 0, 1};
                     Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4};
                     Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
                     Physical Surface("disc") = {1};
                   )",
                   {"Gmsh failed while meshing the plan", "Error"}},
                  {"Point(1) = {0, 0, 0};", {"neither physical volumes nor physical surfaces"}}});
}

TEST(Refusals, SolidsThatDoNotFit)
{
  expect_refused({{blocks(volumes + surfaces + "Physical Surface(\"disc_boer\") = {1};"), {"'disc_boer'", "known names", "disc_bore"}},
                  {blocks(volumes + "Physical Surface(\"disc_contact\") = {6};"), {"'pin_contact'"}},
                  {blocks(volumes), {"'disc_contact'"}},
                  {blocks("Physical Volume(\"disk\") = {1}; Physical Volume(\"pin_1\") = {2};" + surfaces),
                   {"No physical volume is named 'disc'", "disk, pin_1"}},
                  {blocks("Physical Volume(\"disc\") = {1, 2};" + surfaces), {"All physical volumes belong to the disc"}},
                  {blocks("Physical Volume(\"disc\") = {1};" + surfaces), {"volume: 8"}},
                  {blocks(volumes + "Physical Surface(\"disc_contact\") = {11}; Physical Surface(\"pin_contact\") = {6};"),
                   {"'pin_contact' has a face on 'disc'"}},
                  {blocks(volumes + "Physical Surface(\"disc_contact\") = {6}; Physical Surface(\"pin_contact\") = {6};", "Coherence;\n"),
                   {"share nodes"}},
                  {blocks(volumes + surfaces, "Mesh.ElementOrder = 3;\n"), {"unsupported type 'Hexahedron 64'", "second order"}}});
  expect_mentions(refusal(of_file(File("blocks.geo", blocks(volumes + surfaces)).string()), {"mount"}), {"'mount'", "disc_contact"});
}

TEST(Refusals, PlansThatDoNotFit)
{
  // A square plate with a square hole or pad, where surface 2 is the pad and surface 3 the rest
  const std::string plate = R"(
    SetFactory("OpenCASCADE");
    Rectangle(1) = {-1, -1, 0, 2, 2};
    Rectangle(2) = {0.2, 0.2, 0, 0.5, 0.5};
    BooleanFragments{ Surface{1}; Delete; }{ Surface{2}; Delete; }
    Mesh.MeshSizeMax = 0.5;
  )";
  const std::string apart = "SetFactory(\"OpenCASCADE\"); Rectangle(2) = {0, 0, 0, 1, 1}; Rectangle(3) = {1, 0, 0, 1, 1}; "
                            "Mesh.MeshSizeMax = 0.5;\n";
  const std::string disc = "Physical Surface(\"disc\") = {3};\n", pad = "Physical Surface(\"pin_top_1\") = {2};\n";
  expect_refused(
    {{plate + pad, {"no physical surface 'disc'"}},
     {plate + disc, {"no pin"}},
     {plate + disc + "Physical Surface(\"pad\") = {2};", {"'pad'", "pin_top"}},
     {plate + disc + pad + "Physical Surface(\"pin_top_2\") = {2};", {"'pin_top_1' and 'pin_top_2' touch"}},
     {plate + disc + pad + "Physical Curve(\"edge\") = {Boundary{ Surface{2}; }};", {"'edge'", "not on the boundary"}},
     {plate + disc + pad + "Physical Curve(\"pin_clamp\") = {Boundary{ Surface{3}; }};", {"'pin_clamp'", "another name"}},
     {plate + disc + "c() = Boundary{ Surface{2}; }; Physical Curve(\"pin_top_1\") = {c(0)};", {"'pin_top_1' is not one closed curve"}},
     {plate + disc + "c() = Abs(Boundary{ Surface{2}; }); Transfinite Curve{c()} = 2; Physical Curve(\"pin_top_1\") = {c()};",
      {"'pin_top_1' has 8 nodes", "multiple of 6"}},
     {apart + disc + pad, {"coincide at (1, ", "are not joined"}}});

  // Two pins on one radius fill the width of the ring, and the lower pin overlaps both
  GeometryParameters parameters;
  parameters.disc_inner_radius = 0.05;
  parameters.disc_outer_radius = 0.1545;
  parameters.pin_diameter      = 0.05;
  parameters.top               = {{0.0765, 0.1275}, {0., 0.}};
  parameters.bottom            = {{0.102}, {0.}};
  expect_mentions(refusal(parameters), {"pins that overlap", "Change the radii or angles"});
  // The mounted surface does not exist
  expect_mentions(refusal(one_pin(), {"disc_ear"}), {"'disc_ear'", "disc_bore"});
}

TEST(Refusals, BadElementsAreFound)
{
  Mesh mesh;
  mesh.volume_names = mesh.body_names = {"disc"};
  mesh.body_of_volume                 = {0};
  mesh.points                         = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  mesh.cells                          = {{Shape::hexahedron, {0, 1, 2, 3, 4, 5, 6, 7}, 0}};
  EXPECT_DOUBLE_EQ(check_mesh(mesh).worst_scaled_jacobian, 1.);

  Mesh inverted           = mesh;
  inverted.cells[0].nodes = {4, 5, 6, 7, 0, 1, 2, 3};
  expect_mentions(message<MeshError>([&] { check_mesh(inverted); }), {"inverted", "element 0", "'disc'", "-1"});

  Mesh right_handed = inverted;
  EXPECT_EQ(make_right_handed(right_handed), 1u);
  EXPECT_EQ(right_handed.cells[0].nodes, mesh.cells[0].nodes);
  EXPECT_EQ(make_right_handed(right_handed), 0u);

  // Fold the upper of two stacked elements into the lower element
  Mesh folded = mesh;
  folded.points.insert(folded.points.end(), {{0, 0, 0.5}, {1, 0, 0.5}, {1, 1, 0.5}, {0, 1, 0.5}});
  folded.cells.push_back({Shape::hexahedron, {4, 5, 6, 7, 8, 9, 10, 11}, 0});
  expect_mentions(message<MeshError>([&] { make_right_handed(folded); }), {"inverted", "element 0", "element 1", "'disc'"});

  // Add a duplicate element, and a third element on one face
  Mesh twice = mesh;
  check_unique(twice, "twice.msh");
  twice.cells.push_back({Shape::hexahedron, {4, 5, 6, 7, 0, 1, 2, 3}, 0});
  expect_mentions(message<MeshError>([&] { check_unique(twice, "twice.msh"); }), {"Duplicates: 1 of 2 elements", "'disc'", "twice.msh"});
  Mesh overlapping = folded;
  check_unique(overlapping, "overlapping.msh");
  overlapping.points.insert(overlapping.points.end(), {{0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {0, 1, 2}});
  overlapping.cells.push_back({Shape::hexahedron, {4, 5, 6, 7, 12, 13, 14, 15}, 0});
  expect_mentions(message<MeshError>([&] { check_unique(overlapping, "overlapping.msh"); }),
                  {"More than two elements share a face", "3 elements"});

  Mesh flat           = mesh;
  flat.points[2]      = {0.5, 0.5, 0.};
  flat.points[6]      = {0.5, 0.5, 1.};
  Mesh collapsed      = mesh;
  collapsed.points[2] = collapsed.points[1];
  for (const Mesh &degenerate : {flat, collapsed})
    expect_mentions(message<MeshError>([&] { check_mesh(degenerate); }), {"degenerate"});
  EXPECT_THROW(check_mesh(Mesh()), MeshError);
}
