#include "scenes.h"

#include <squeal/geometry/mesh_check.h>
#include <squeal/geometry/plan.h>

using namespace Scenes;

namespace
{
  /// What generate_mesh() says about a .geo of this content.
  std::string refusal(const std::string &content, const std::vector<std::string> &additional_surfaces = {})
  {
    const File         file("geometry.geo", content);
    GeometryParameters parameters;
    parameters.file = file.string();
    return message<MeshError>([&] { generate_mesh(parameters, additional_surfaces); });
  }

  /// Two blocks one upon the other, with all names but what a test adds.
  std::string blocks(const std::string &names, const std::string &before_names = "")
  {
    return R"(
      SetFactory("OpenCASCADE");
      Box(1) = {0, 0, 0, 1, 1, 0.5};
      Box(2) = {0, 0, 0.5, 1, 1, 0.25};
    )" + before_names +
           "Transfinite Curve{:} = 3; Transfinite Surface{:}; Recombine Surface{:}; Transfinite Volume{:};\n" + names;
  }

  const std::string volumes  = "Physical Volume(\"disc\") = {1}; Physical Volume(\"pin_1\") = {2};\n";
  const std::string surfaces = "Physical Surface(\"disc_contact\") = {6}; Physical Surface(\"pin_contact\") = {11}; "
                               "Physical Surface(\"pin_clamp\") = {12};\n";

  /// A square plate with a square hole or pad, in the plane.
  const std::string plate = R"(
    SetFactory("OpenCASCADE");
    Rectangle(1) = {-1, -1, 0, 2, 2};
    Rectangle(2) = {0.2, 0.2, 0, 0.5, 0.5};
    BooleanFragments{ Surface{1}; Delete; }{ Surface{2}; Delete; }
    Mesh.MeshSizeMax = 0.5;
  )"; // surface 2 is the pad, 3 the rest
} // namespace

TEST(Refusals, MissingFileSaysWhereItWasLookedFor)
{
  GeometryParameters parameters;
  parameters.file = "no_such_file.geo";
  expect_mentions(message<MeshError>([&] { generate_mesh(parameters); }),
                  {"no_such_file.geo", std::filesystem::current_path().string(), "Geometry/File"});
}

TEST(Refusals, BrokenGeometryQuotesGmsh)
{
  expect_mentions(refusal("Point(1) = {0, 0, 0};\nthis is not Gmsh\n"), {"geometry.geo", "line 2", "syntax error"});
}

TEST(Refusals, FailingMeshQuotesGmsh)
{
  // Two crossing lines cannot bound a surface
  expect_mentions(refusal(R"(
    Point(1) = {0, 0, 0, 1}; Point(2) = {1, 1, 0, 1}; Point(3) = {1, 0, 0, 1}; Point(4) = {0, 1, 0, 1};
    Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
    Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
    Physical Surface("disc") = {1};
  )"),
                  {"Gmsh failed while meshing the plan", "Error"});
}

TEST(Refusals, GeometryWithoutNames)
{
  expect_mentions(refusal("Point(1) = {0, 0, 0};"), {"neither physical volumes nor physical surfaces"});
}

TEST(Refusals, SolidWithUnknownMissingOrMisplacedNames)
{
  expect_mentions(refusal(blocks(volumes + surfaces + "Physical Surface(\"disc_boer\") = {1};")),
                  {"'disc_boer'", "known names", "disc_bore"});
  expect_mentions(refusal(blocks(volumes + surfaces), {"mount"}), {"'mount'", "disc_contact"});
  expect_mentions(refusal(blocks(volumes + "Physical Surface(\"disc_contact\") = {6};")), {"'pin_contact'"});
  expect_mentions(refusal(blocks(volumes)), {"'disc_contact'"});
  expect_mentions(refusal(blocks("Physical Volume(\"disk\") = {1}; Physical Volume(\"pin_1\") = {2};" + surfaces)),
                  {"'disk'", "disc, pin_"});
  expect_mentions(refusal(blocks("Physical Volume(\"disc\") = {1, 2};" + surfaces)), {"'pin_...'"});
  expect_mentions(refusal(blocks("Physical Volume(\"disc\") = {1};" + surfaces)), {"8 volume elements"});
  expect_mentions(refusal(blocks(volumes + "Physical Surface(\"disc_contact\") = {11}; Physical "
                                           "Surface(\"pin_contact\") = {6}; Physical Surface(\"pin_clamp\") = {12};")),
                  {"'pin_contact' has a face on volume 'disc'"});
}

TEST(Refusals, SolidWithSharedNodesOrOtherElements)
{
  expect_mentions(refusal(blocks(volumes + "Physical Surface(\"disc_contact\") = {6}; Physical Surface("
                                           "\"pin_contact\") = {6}; Physical Surface(\"pin_clamp\") = {11};",
                                 "Coherence;\n")),
                  {"share nodes"});
  expect_mentions(refusal(R"(
    SetFactory("OpenCASCADE");
    Box(1) = {0, 0, 0, 1, 1, 0.5};
    Box(2) = {0, 0, 0.5, 1, 1, 0.25};
    Mesh.MeshSizeMin = 1;
  )" + volumes + surfaces),
                  {"elements of type 'Tetrahedron 4'", "Hexahedron 8"});
}

TEST(Refusals, PlanThatDoesNotFit)
{
  const std::string disc = "Physical Surface(\"disc\") = {3};\n", pad = "Physical Surface(\"pin_top_1\") = {2};\n";
  expect_mentions(refusal(plate + pad), {"no physical surface 'disc'"});
  expect_mentions(refusal(plate + disc), {"no pin"});
  expect_mentions(refusal(plate + disc + "Physical Surface(\"pad\") = {2};"), {"'pad'", "pin_top"});
  expect_mentions(refusal(plate + disc + pad + "Physical Surface(\"pin_top_2\") = {2};"), {"'pin_top_1' and 'pin_top_2' touch"});
  expect_mentions(refusal(plate + disc + pad + "Physical Curve(\"edge\") = {Boundary{ Surface{2}; }};"), {"'edge'", "not on the boundary"});
  expect_mentions(refusal(plate + disc + pad + "Physical Curve(\"pin_clamp\") = {Boundary{ Surface{3}; }};"),
                  {"'pin_clamp'", "another name"});
  expect_mentions(refusal(plate + disc + "c() = Boundary{ Surface{2}; }; Physical Curve(\"pin_top_1\") = {c(0)};"),
                  {"'pin_top_1' is not one closed curve"});
  expect_mentions(refusal(plate + disc +
                          "c() = Abs(Boundary{ Surface{2}; }); Transfinite Curve{c()} = 2; Physical "
                          "Curve(\"pin_top_1\") = {c()};"),
                  {"'pin_top_1' has 8 nodes", "multiple of 6"});
  expect_mentions(refusal("SetFactory(\"OpenCASCADE\"); Rectangle(2) = {0, 0, 0, 1, 1}; Rectangle(3) = {1, 0, 0, 1, "
                          "1}; Mesh.MeshSizeMax = 0.5;\n" +
                          disc + pad),
                  {"coincide", "without being joined"});
}

TEST(Refusals, PinsWithoutRoomInTheBuiltInPlan)
{
  // Two pins one behind the other fill the ring, the one below overlaps both
  GeometryParameters parameters;
  parameters.disc_inner_radius = 0.05;
  parameters.disc_outer_radius = 0.1545;
  parameters.pin_diameter      = 0.05;
  parameters.top               = {{0.0765, 0.1275}, {0., 0.}};
  parameters.bottom            = {{0.102}, {0.}};
  expect_mentions(message<MeshError>([&] { generate_mesh(parameters); }), {"no room", "Move the pins"});
}

TEST(Refusals, MissingMountOnAPlan)
{
  expect_mentions(message<MeshError>([] { generate_mesh(one_pin(), {"disc_ear"}); }), {"'disc_ear'", "disc_bore"});
}

TEST(Refusals, BadElementsAreFound)
{
  HexMesh mesh;
  mesh.volume_names = {"disc"};
  mesh.points       = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  mesh.hexahedra    = {{{{0, 1, 2, 3, 4, 5, 6, 7}}, 0}};
  EXPECT_DOUBLE_EQ(check_mesh(mesh).worst_scaled_jacobian, 1.);

  HexMesh inverted            = mesh;
  inverted.hexahedra[0].nodes = {{4, 5, 6, 7, 0, 1, 2, 3}};
  expect_mentions(message<MeshError>([&] { check_mesh(inverted); }), {"inverted", "element 0", "'disc'", "-1"});

  HexMesh right_handed = inverted;
  EXPECT_EQ(make_right_handed(right_handed), 1u);
  EXPECT_EQ(right_handed.hexahedra[0].nodes, mesh.hexahedra[0].nodes);
  EXPECT_EQ(make_right_handed(right_handed), 0u);

  // Two elements one upon the other, the upper one folded into the lower one
  HexMesh folded = mesh;
  folded.points.insert(folded.points.end(), {{0, 0, 0.5}, {1, 0, 0.5}, {1, 1, 0.5}, {0, 1, 0.5}});
  folded.hexahedra.push_back({{{4, 5, 6, 7, 8, 9, 10, 11}}, 0});
  expect_mentions(message<MeshError>([&] { make_right_handed(folded); }), {"inverted", "element 1", "'disc'"});

  HexMesh flat   = mesh;
  flat.points[2] = {0.5, 0.5, 0.};
  flat.points[6] = {0.5, 0.5, 1.};
  expect_mentions(message<MeshError>([&] { check_mesh(flat); }), {"degenerate"});

  HexMesh collapsed   = mesh;
  collapsed.points[2] = collapsed.points[1];
  expect_mentions(message<MeshError>([&] { check_mesh(collapsed); }), {"degenerate"});
  EXPECT_THROW(check_mesh(HexMesh()), MeshError);
}
