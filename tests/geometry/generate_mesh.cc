// SPDX-License-Identifier: GPL-3.0-or-later

#include "scenes.h"

#include <squeal/geometry/mesh_check.h>
#include <squeal/geometry/mesh_file.h>
#include <squeal/geometry/plan_smoothing.h>

#include <sstream>

using namespace Scenes;

namespace
{

  /// Area of a regular polygon inscribed in a circle.
  double polygon(const double radius, const unsigned int n)
  {
    return 0.5 * n * radius * radius * std::sin(2. * M_PI / n);
  }

  /// Largest distance from a node in @p from to the nearest node in @p to.
  double largest_gap(const Mesh &mesh, const std::set<unsigned int> &from, const std::set<unsigned int> &to)
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

  void expect_contact_pairs(const Mesh &mesh, const unsigned int n_pairs)
  {
    const std::set<unsigned int> disc = nodes_on(mesh, "disc_contact"), pins = nodes_on(mesh, "pin_contact");
    EXPECT_EQ(disc.size(), n_pairs);
    EXPECT_EQ(pins.size(), n_pairs);
    EXPECT_EQ(largest_gap(mesh, disc, pins), 0.);
    EXPECT_EQ(largest_gap(mesh, pins, disc), 0.);
    for (const unsigned int node : disc)
      EXPECT_EQ(pins.count(node), 0u);
  }

  /// Text of a mesh in MSH format, with all digits and names.
  std::string text_of(const Mesh &mesh)
  {
    std::ostringstream stream;
    write_msh(mesh, stream);
    return stream.str();
  }
} // namespace

TEST(GenerateMesh, DefaultSceneHasTheStatedSize)
{
  const Mesh mesh = generate_mesh({}, {"disc_bore"});
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
      const Mesh mesh               = generate_mesh(parameters);
      expect_contact_pairs(mesh, parameters.nodes_per_pin_face);
      EXPECT_EQ(nodes_on(mesh, "pin_clamp").size(), parameters.nodes_per_pin_face);
      EXPECT_EQ(nodes_on(mesh, "pin_side").size(), 6 * k * (parameters.pin_layers + 1));

      // The outline is a regular polygon, and corners of elements are at most as flat as the block corners on the outline
      const double pin_area = polygon(parameters.pin_diameter / 2., 6 * k);
      EXPECT_NEAR(area(mesh, "pin_contact"), pin_area, 1e-12);
      EXPECT_NEAR(area(mesh, "disc_contact"), pin_area, 1e-12);
      EXPECT_NEAR(volume(mesh, "pin_"), pin_area * parameters.pin_height, 1e-12);
      EXPECT_GT(check_mesh(mesh).worst_scaled_jacobian, 0.9 * std::min(0.35, std::sin(M_PI / (3. * k))));
    }
}

TEST(GenerateMesh, BodiesAndSurfacesAreAtTheirPlaces)
{
  for (const double side : {1., -1.})
    {
      GeometryParameters parameters = one_pin();
      if (side < 0.)
        std::swap(parameters.top, parameters.bottom);
      const Mesh   mesh = generate_mesh(parameters);
      const double t    = parameters.disc_thickness;
      expect_contact_pairs(mesh, 19);
      EXPECT_EQ(mesh.volume_names[1], side > 0. ? "pin_top_1" : "pin_bottom_1");
      for (const unsigned int node : nodes_on(mesh, "pin_contact"))
        EXPECT_EQ(mesh.points[node][2], side * t / 2.);
      for (const unsigned int node : nodes_on(mesh, "pin_clamp"))
        EXPECT_EQ(mesh.points[node][2], side * (t / 2. + parameters.pin_height));

      const unsigned int n_bore = nodes_on(mesh, "disc_bore").size() / (parameters.disc_layers + 1);
      const unsigned int n_rim  = nodes_on(mesh, "disc_rim").size() / (parameters.disc_layers + 1);
      EXPECT_NEAR(volume(mesh, "disc"), t * (polygon(parameters.disc_outer_radius, n_rim) - polygon(parameters.disc_inner_radius, n_bore)),
                  1e-4 * volume(mesh, "disc"));
      EXPECT_NEAR(area(mesh, "disc_bore"), 2. * M_PI * parameters.disc_inner_radius * t, 0.01 * area(mesh, "disc_bore"));
      EXPECT_NEAR(area(mesh, "disc_rim"), 2. * M_PI * parameters.disc_outer_radius * t, 0.01 * area(mesh, "disc_rim"));
      for (const unsigned int node : nodes_on(mesh, "disc_bore"))
        EXPECT_NEAR(std::hypot(mesh.points[node][0], mesh.points[node][1]), parameters.disc_inner_radius, 1e-9);
    }
}

TEST(GenerateMesh, PinsThatAreNotOppositeAreAtTheirPlaces)
{
  const auto expect = [](const GeometryParameters &parameters, const double quality) {
    SCOPED_TRACE(testing::PrintToString(parameters.top.angles) + testing::PrintToString(parameters.bottom.angles) + ", " +
                 std::to_string(parameters.nodes_per_pin_face) + " nodes, " + std::to_string(parameters.element_size) + " m");
    const Mesh mesh = generate_mesh(parameters);
    expect_contact_pairs(mesh, 12 * parameters.nodes_per_pin_face);
    EXPECT_GT(check_mesh(mesh).worst_scaled_jacobian, quality);

    // The outline of every pin is a regular polygon
    const unsigned int n_outline = parameters.nodes_per_pin_face == 7 ? 6 : 12;
    const double       radius    = parameters.pin_diameter / 2.;
    EXPECT_NEAR(volume(mesh, "pin_"), 12. * polygon(radius, n_outline) * parameters.pin_height, 1e-10);
    for (const auto &[side, pins] : {std::pair(1., parameters.top), {-1., parameters.bottom}})
      for (std::size_t pin = 0; pin < 6; ++pin)
        EXPECT_EQ(n_on_outline(mesh, side, pins.radii[pin], pins.angles[pin], radius), n_outline);
  };
  // Shift the lower pins by small angles, by half a pitch and to other sectors
  for (const double shift : {0.1, 2., 9.2, 14., 30., 180.})
    {
      GeometryParameters parameters;
      for (double &angle : parameters.bottom.angles)
        angle += shift;
      expect(parameters, 0.15);
    }
  // Upper pins at larger angles overlap the lower pins only partly or not at all
  for (const double spread : {27., 30., 33.})
    for (const unsigned int nodes : {7, 19})
      for (const double size : {0.012, 0.02, 0.03})
        {
          GeometryParameters parameters;
          parameters.top.angles         = {-spread, 0., spread, -spread, 0., spread};
          parameters.nodes_per_pin_face = nodes;
          parameters.element_size       = size;
          parameters.pin_layers         = 1;
          expect(parameters, smallest_scaled_jacobian);
        }
}

TEST(GenerateMesh, OppositePinsStayWhereThePlanHasThem)
{
  for (const unsigned int nodes : {7, 19})
    {
      GeometryParameters parameters;
      parameters.nodes_per_pin_face            = nodes;
      parameters.element_size                  = 0.02;
      const Mesh                          mesh = generate_mesh(parameters);
      std::set<std::pair<double, double>> above, below;
      for (const unsigned int node : nodes_on(mesh, "disc_contact"))
        (mesh.points[node][2] > 0. ? above : below).emplace(mesh.points[node][0], mesh.points[node][1]);
      EXPECT_EQ(above.size(), 6 * nodes);
      EXPECT_EQ(above, below); // bitwise equal, because the mesh is not sheared
    }
}

TEST(GenerateMesh, CloseAndThinPinsAreMeshed)
{
  // The pad of a railway brake with 18 pins, whose smallest distance is 2.56 mm
  GeometryParameters parameters;
  parameters.disc_inner_radius = 0.175;
  parameters.disc_outer_radius = 0.320;
  parameters.pin_diameter      = 0.0376;
  parameters.element_size      = 0.02;
  parameters.top.radii         = {0.215696546, 0.258936286, 0.259755654, 0.207761883, 0.282256975, 0.243074063,
                                  0.281964537, 0.242958844, 0.20135789,  0.259083545, 0.201359622, 0.242962314,
                                  0.281974332, 0.243130647, 0.207846669, 0.259855518, 0.282322054, 0.215831818};
  parameters.top.angles = {7.19091141, 4.87389642, 14.0362435, 18.5221569, 21.8391041, 24.0342882, 31.6607511, 33.7554736, 33.4533095,
                           75.1843979, 46.63198,   46.3157819, 48.4000408, 56.0360735, 61.5582833, 66.0272128, 58.2217852, 72.881462};
  parameters.bottom     = {};
  EXPECT_GT(mesh_quality(generate_mesh(parameters)).worst_scaled_jacobian, 0.1);

  // Element sizes increase in the gaps between thin pins
  GeometryParameters thin;
  thin.pin_diameter = 0.001;
  EXPECT_LT(generate_mesh(thin).cells.size(), 30000u);
}

TEST(GenerateMesh, ScaledParametersGiveTheScaledMesh)
{
  const Mesh mesh = generate_mesh(one_pin());
  for (const int exponent : {-6, -3, 3, 6})
    {
      GeometryParameters p = one_pin();
      for (double *length : {&p.disc_inner_radius, &p.disc_outer_radius, &p.disc_thickness, &p.pin_diameter, &p.pin_height, &p.element_size,
                             &p.pairing_tolerance, &p.top.radii[0]})
        *length = std::stod(std::to_string(*length) + "e" + std::to_string(exponent)); // the double closest to the decimal number
      const Mesh other = generate_mesh(p);
      ASSERT_EQ(other.points.size(), mesh.points.size());
      for (std::size_t i = 0; i < mesh.points.size(); ++i)
        for (unsigned int d = 0; d < 3; ++d)
          EXPECT_NEAR(other.points[i][d] / std::pow(10., exponent), mesh.points[i][d], 1e-15);
    }
}

TEST(GenerateMesh, SameParametersGiveTheSameMeshAlsoFromItsFile)
{
  Mesh              mesh    = generate_mesh(one_pin());
  const auto        of      = checksum(mesh);
  const std::string written = text_of(mesh);
  EXPECT_EQ(text_of(generate_mesh(one_pin())), written);
  EXPECT_EQ(text_of(generate_mesh(of_file(File("mesh.msh", written).string()))), written);
  // Checksums distinguish meshes but are insensitive to rounding errors
  EXPECT_EQ(checksum(generate_mesh(one_pin())), of);
  double &z = mesh.points.back()[2];
  z += 1e-16; // rounding error
  EXPECT_EQ(checksum(mesh), of);
  z += 1e-6;
  EXPECT_NE(checksum(mesh), of);
}

TEST(GenerateMesh, PadPlanIsExtruded)
{
  const GeometryParameters parameters = of_file("disc_pad.geo");
  const Mesh               mesh       = generate_mesh(parameters);
  EXPECT_EQ(mesh.volume_names, (std::vector<std::string>{"disc", "pin_top_1", "pin_bottom_1"}));
  expect_contact_pairs(mesh, nodes_on(mesh, "pin_clamp").size());
  const double pad_area = 50. / 360. * M_PI * (0.285 * 0.285 - 0.175 * 0.175);
  EXPECT_NEAR(volume(mesh, "pin_"), 2. * pad_area * parameters.pin_height, 0.01 * volume(mesh, "pin_"));
}

TEST(GenerateMesh, SolidsAreTakenAsTheyAreWithFacesOfSeveralNamesAndGroupsOfOneName)
{
  const File file("blocks.geo", blocks(volumes + surfaces + "Physical Surface(\"ground\") = {5}; Physical Surface(\"wall\") = {1, 5};\n"));
  const Mesh mesh = generate_mesh(of_file(file.string()), {"ground", "wall"});
  EXPECT_EQ(mesh.cells.size(), 16u);
  EXPECT_EQ(mesh.points.size(), 54u);
  EXPECT_NEAR(volume(mesh, "disc"), 0.5, 1e-12);
  EXPECT_NEAR(volume(mesh, "pin_"), 0.25, 1e-12);
  EXPECT_NEAR(area(mesh, "ground"), 1., 1e-12);
  EXPECT_NEAR(area(mesh, "wall"), 1.5, 1e-12);
  expect_contact_pairs(mesh, 9);
  expect_mentions(message<MeshError>([&] { generate_mesh(of_file(file.string()), {"wall"}); }),
                  {"'ground'", "disc_contact, pin_contact, pin_clamp, pin_side, disc_bore, disc_rim"});

  // The file lists a face with two names twice
  const File written("mesh.msh", text_of(mesh));
  EXPECT_EQ(text_of(generate_mesh(of_file(written.string()), {"ground", "wall"})), text_of(mesh));
  // Groups of the same name form one surface
  std::string one_name = text_of(mesh);
  one_name.replace(one_name.find("\"wall\""), 6, "\"ground\"");
  const File merged("merged.msh", one_name);
  EXPECT_NEAR(area(generate_mesh(of_file(merged.string()), {"ground"}), "ground"), 1.5, 1e-12);
}

TEST(PlanSmoothing, InvertedFacesAreTurnedOver)
{
  // Mirror the inner nodes of a grid of 4 × 4 faces
  std::vector<Plan::Point> points;
  std::vector<bool>        fixed;
  for (int j = 0; j <= 4; ++j)
    for (int i = 0; i <= 4; ++i)
      {
        const bool inside = i > 0 && i < 4 && j > 0 && j < 4;
        points.push_back({inside ? 4. - i : double(i), double(j)});
        fixed.push_back(!inside);
      }
  std::vector<Plan::Face> faces;
  for (unsigned int j = 0; j < 4; ++j)
    for (unsigned int i = 0; i < 4; ++i)
      faces.push_back({{5 * j + i, 5 * j + i + 1, 5 * j + i + 6, 5 * j + i + 5}});
  untangle(faces, fixed, {}, points);
  for (int j = 0; j <= 4; ++j)
    for (int i = 0; i <= 4; ++i)
      {
        EXPECT_NEAR(points[5 * j + i][0], i, 0.1);
        EXPECT_NEAR(points[5 * j + i][1], j, 0.1);
      }

  // Good faces and faces that cannot be repaired are unchanged
  std::vector<Plan::Point> flat   = {{0., 0.}, {1., 0.}, {2., 0.}, {3., 0.}};
  const auto               before = flat, good = points;
  untangle({{{0, 1, 2, 3}}}, std::vector<bool>(4, true), {}, flat);
  EXPECT_EQ(flat, before);
  untangle(faces, fixed, {}, points);
  EXPECT_EQ(points, good);
}
