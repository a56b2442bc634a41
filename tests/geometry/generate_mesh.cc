#include "scenes.h"

#include <squeal/geometry/mesh_check.h>
#include <squeal/geometry/mesh_file.h>

#include <sstream>

using namespace Scenes;

namespace
{
  const double pi = std::acos(-1.);

  /// Area of a regular polygon in a circle.
  double polygon(const double radius, const unsigned int n)
  {
    return 0.5 * n * radius * radius * std::sin(2. * pi / n);
  }

  /// Distance from each node of one surface to the nearest of another, the largest.
  double largest_gap(const HexMesh &mesh, const std::set<unsigned int> &from, const std::set<unsigned int> &to)
  {
    double largest = 0.;
    for (const unsigned int a : from)
      {
        double nearest = 1e300;
        for (const unsigned int b : to)
          nearest = std::min(nearest, std::hypot(mesh.points[a][0] - mesh.points[b][0], mesh.points[a][1] - mesh.points[b][1],
                                                 mesh.points[a][2] - mesh.points[b][2]));
        largest = std::max(largest, nearest);
      }
    return largest;
  }

  void expect_contact_pairs(const HexMesh &mesh, const unsigned int n_pairs)
  {
    const std::set<unsigned int> disc = nodes_on(mesh, "disc_contact"), pins = nodes_on(mesh, "pin_contact");
    EXPECT_EQ(disc.size(), n_pairs);
    EXPECT_EQ(pins.size(), n_pairs);
    EXPECT_EQ(largest_gap(mesh, disc, pins), 0.);
    EXPECT_EQ(largest_gap(mesh, pins, disc), 0.);
    for (const unsigned int node : disc)
      EXPECT_EQ(pins.count(node), 0u);
  }

  /// With all digits of points and all names.
  std::string text_of(const HexMesh &mesh)
  {
    std::ostringstream stream;
    write_msh(mesh, stream);
    return stream.str();
  }
} // namespace

TEST(GenerateMesh, DefaultSceneHasTheStatedSize)
{
  const HexMesh mesh = generate_mesh({}, {"disc_bore"});
  expect_contact_pairs(mesh, 228);
  EXPECT_GE(3 * mesh.points.size(), 31000u);
  EXPECT_LE(3 * mesh.points.size(), 36000u);
  EXPECT_EQ(mesh.volume_names.size(), 13u);
  EXPECT_EQ(mesh.volume_names[0], "disc");
  EXPECT_EQ(mesh.volume_names[1], "pin_top_1");
  EXPECT_EQ(mesh.volume_names[12], "pin_bottom_6");
  EXPECT_GT(check_mesh(mesh).worst_scaled_jacobian, 0.3);
}

TEST(GenerateMesh, PinFacesHaveTheirNodesAndGoodElements)
{
  for (const unsigned int k : {1, 2, 3, 4})
    {
      GeometryParameters parameters = one_pin();
      parameters.nodes_per_pin_face = 3 * k * (k + 1) + 1;
      const HexMesh mesh            = generate_mesh(parameters);
      expect_contact_pairs(mesh, parameters.nodes_per_pin_face);
      EXPECT_EQ(nodes_on(mesh, "pin_clamp").size(), parameters.nodes_per_pin_face);
      EXPECT_EQ(nodes_on(mesh, "pin_side").size(), 6 * k * (parameters.pin_layers + 1));

      // The pin's outline is the regular polygon; no corner is flatter than the block corners on it
      const double pin_area = polygon(parameters.pin_diameter / 2., 6 * k);
      EXPECT_NEAR(area(mesh, "pin_contact"), pin_area, 1e-12);
      EXPECT_NEAR(area(mesh, "disc_contact"), pin_area, 1e-12);
      EXPECT_NEAR(volume(mesh, "pin_"), pin_area * parameters.pin_height, 1e-12);
      EXPECT_GT(check_mesh(mesh).worst_scaled_jacobian, 0.9 * std::min(0.35, std::sin(pi / (3. * k))));
    }
}

TEST(GenerateMesh, DiscFillsTheAnnulusAndTheSurfacesBoundIt)
{
  const GeometryParameters parameters = one_pin();
  const HexMesh            mesh       = generate_mesh(parameters);
  const double             t          = parameters.disc_thickness;

  const unsigned int n_bore = nodes_on(mesh, "disc_bore").size() / (parameters.disc_layers + 1);
  const unsigned int n_rim  = nodes_on(mesh, "disc_rim").size() / (parameters.disc_layers + 1);
  EXPECT_NEAR(volume(mesh, "disc"), t * (polygon(parameters.disc_outer_radius, n_rim) - polygon(parameters.disc_inner_radius, n_bore)),
              1e-4 * volume(mesh, "disc"));
  EXPECT_NEAR(area(mesh, "disc_bore"), 2. * pi * parameters.disc_inner_radius * t, 0.01 * area(mesh, "disc_bore"));
  EXPECT_NEAR(area(mesh, "disc_rim"), 2. * pi * parameters.disc_outer_radius * t, 0.01 * area(mesh, "disc_rim"));
  for (const unsigned int node : nodes_on(mesh, "disc_bore"))
    EXPECT_NEAR(std::hypot(mesh.points[node][0], mesh.points[node][1]), parameters.disc_inner_radius, 1e-9);
  for (const unsigned int node : nodes_on(mesh, "pin_clamp"))
    EXPECT_EQ(mesh.points[node][2], t / 2. + parameters.pin_height);
}

TEST(GenerateMesh, BottomPinsHangBelow)
{
  GeometryParameters parameters = one_pin();
  std::swap(parameters.top, parameters.bottom);
  const HexMesh mesh = generate_mesh(parameters);
  expect_contact_pairs(mesh, 19);
  EXPECT_EQ(mesh.volume_names[1], "pin_bottom_1");
  for (const unsigned int node : nodes_on(mesh, "pin_contact"))
    EXPECT_EQ(mesh.points[node][2], -parameters.disc_thickness / 2.);
  for (const unsigned int node : nodes_on(mesh, "pin_clamp"))
    EXPECT_LT(mesh.points[node][2], -parameters.disc_thickness / 2.);
}

TEST(GenerateMesh, PinsThatAreNotOppositeAreAtTheirPlaces)
{
  // A little aside, half a pitch aside, nothing opposite
  for (const double shift : {0.1, 2., 9.2, 14., 30., 180.})
    {
      GeometryParameters parameters;
      for (double &angle : parameters.bottom.angles)
        angle += shift;
      const HexMesh mesh = generate_mesh(parameters);
      expect_contact_pairs(mesh, 228);
      EXPECT_GT(check_mesh(mesh).worst_scaled_jacobian, 0.15) << shift;
      EXPECT_NEAR(area(mesh, "pin_contact"), 12. * polygon(parameters.pin_diameter / 2., 12), 1e-10);

      for (unsigned int pin = 0; pin < 6; ++pin)
        EXPECT_EQ(n_on_outline(mesh, -1., parameters.bottom.radii[pin], parameters.bottom.angles[pin], parameters.pin_diameter / 2.), 12u)
          << shift;
    }
}

TEST(GenerateMesh, SameParametersGiveTheSameMesh)
{
  HexMesh    mesh = generate_mesh(one_pin());
  const auto of   = checksum(mesh);
  EXPECT_EQ(text_of(generate_mesh(one_pin())), text_of(mesh));
  // Checksums tell meshes apart
  EXPECT_EQ(checksum(generate_mesh(one_pin())), of);
  double &z = mesh.points.back()[2];
  z += 1e-16; // rounding
  EXPECT_EQ(checksum(mesh), of);
  z += 1e-6;
  EXPECT_NE(checksum(mesh), of);
}

TEST(GenerateMesh, PadPlanIsExtruded)
{
  GeometryParameters parameters;
  parameters.file    = "disc_pad.geo";
  const HexMesh mesh = generate_mesh(parameters);
  EXPECT_EQ(mesh.volume_names, (std::vector<std::string>{"disc", "pin_top_1", "pin_bottom_1"}));
  expect_contact_pairs(mesh, nodes_on(mesh, "pin_clamp").size());
  const double pad_area = 50. / 360. * pi * (0.285 * 0.285 - 0.175 * 0.175);
  EXPECT_NEAR(volume(mesh, "pin_"), 2. * pad_area * parameters.pin_height, 0.01 * volume(mesh, "pin_"));
}

TEST(GenerateMesh, WrittenMeshReadsBackUnchanged)
{
  const std::string  written = text_of(generate_mesh(one_pin()));
  const File         file("mesh.msh", written);
  GeometryParameters parameters = one_pin();
  parameters.file               = file.string();
  EXPECT_EQ(text_of(generate_mesh(parameters)), written);
}

namespace
{
  /// Two blocks one upon the other, of 16 hexahedra.
  const char *const two_blocks = R"(
    SetFactory("OpenCASCADE");
    Box(1) = {0, 0, 0, 2, 1, 0.5};
    Box(2) = {0, 0, 0.5, 2, 1, 0.25};
    Transfinite Curve{:} = 3; Transfinite Surface{:}; Recombine Surface{:}; Transfinite Volume{:};
    Physical Volume("disc") = {1};
    Physical Volume("pin_block") = {2};
    Physical Surface("disc_contact") = {6};
    Physical Surface("pin_contact") = {11};
    Physical Surface("pin_clamp") = {12};
    Physical Surface("ground") = {5};
  )";
} // namespace

TEST(GenerateMesh, FacesBearSeveralNamesAndGroupsOneName)
{
  GeometryParameters parameters;
  const File         file("blocks.geo", std::string(two_blocks) + "Physical Surface(\"wall\") = {1, 5};\n");
  parameters.file    = file.string();
  const HexMesh mesh = generate_mesh(parameters, {"ground", "wall"});
  EXPECT_NEAR(area(mesh, "ground"), 2., 1e-12);
  EXPECT_NEAR(area(mesh, "wall"), 2.5, 1e-12);

  // Through a file, which holds such a face twice
  const File written("mesh.msh", text_of(mesh));
  parameters.file = written.string();
  EXPECT_EQ(text_of(generate_mesh(parameters, {"ground", "wall"})), text_of(mesh));

  // The same with the second group named like the first
  std::string one_name = text_of(mesh);
  one_name.replace(one_name.find("\"wall\""), 6, "\"ground\"");
  const File merged("merged.msh", one_name);
  parameters.file = merged.string();
  EXPECT_NEAR(area(generate_mesh(parameters, {"ground"}), "ground"), 2.5, 1e-12);
}

TEST(GenerateMesh, SolidGeometryIsTakenAsItIs)
{
  GeometryParameters parameters;
  const File         file("blocks.geo", two_blocks);
  parameters.file    = file.string();
  const HexMesh mesh = generate_mesh(parameters, {"ground"});
  EXPECT_EQ(mesh.hexahedra.size(), 16u);
  EXPECT_EQ(mesh.points.size(), 54u);
  EXPECT_NEAR(volume(mesh, "disc"), 1., 1e-12);
  EXPECT_NEAR(volume(mesh, "pin_"), 0.5, 1e-12);
  EXPECT_NEAR(area(mesh, "ground"), 2., 1e-12);
  expect_contact_pairs(mesh, 9);

  expect_mentions(message<MeshError>([&] { generate_mesh(parameters); }),
                  {"'ground'", "disc_contact, pin_contact, pin_clamp, pin_side, disc_bore, disc_rim"});
}
