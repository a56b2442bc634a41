#include "scenes.h"

#include <squeal/geometry/mesh_check.h>
#include <squeal/geometry/plan_smoothing.h>

using namespace Scenes;

namespace
{
  const double pi = std::acos(-1.);

  /// Pins of the default layout, those above spread further than those below.
  GeometryParameters askew(const double spread, const unsigned int nodes_per_pin_face, const double element_size)
  {
    GeometryParameters parameters;
    parameters.top.angles         = {-spread, 0., spread, -spread, 0., spread};
    parameters.nodes_per_pin_face = nodes_per_pin_face;
    parameters.element_size       = element_size;
    parameters.pin_layers         = 1;
    return parameters;
  }

} // namespace

TEST(Layouts, PinsThatOverlapAskewAreMeshed)
{
  for (const double spread : {27., 30., 33.})
    for (const unsigned int k : {1, 2})
      for (const double size : {0.012, 0.02, 0.03})
        {
          SCOPED_TRACE(std::to_string(spread) + " degrees, k = " + std::to_string(k) + ", " + std::to_string(size) + " m");
          const GeometryParameters parameters = askew(spread, 3 * k * (k + 1) + 1, size);
          const HexMesh            mesh       = generate_mesh(parameters);
          EXPECT_GT(check_mesh(mesh).worst_scaled_jacobian, smallest_scaled_jacobian);

          // Every pin is a regular polygon at its place
          const double radius = parameters.pin_diameter / 2.;
          EXPECT_NEAR(volume(mesh, "pin_"), 12. * 3. * k * radius * radius * std::sin(pi / (3. * k)) * parameters.pin_height, 1e-10);
          for (std::size_t pin = 0; pin < 6; ++pin)
            EXPECT_EQ(n_on_outline(mesh, 1., parameters.top.radii[pin], parameters.top.angles[pin], radius), 6 * k);
        }
}

TEST(Layouts, ClosePinsAreMeshed)
{
  // The pad of a railway brake: 18 pins, 2.56 mm apart
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
}

TEST(Layouts, OppositePinsStayWhereThePlanHasThem)
{
  for (const unsigned int nodes : {7, 19})
    {
      GeometryParameters parameters;
      parameters.nodes_per_pin_face            = nodes;
      parameters.element_size                  = 0.02;
      const HexMesh                       mesh = generate_mesh(parameters);
      std::set<std::pair<double, double>> above, below;
      for (const unsigned int node : nodes_on(mesh, "disc_contact"))
        (mesh.points[node][2] > 0. ? above : below).emplace(mesh.points[node][0], mesh.points[node][1]);
      EXPECT_EQ(above.size(), 6 * nodes);
      EXPECT_EQ(above, below); // to the last bit: nothing was sheared
    }
}

TEST(Layouts, InvertedFacesAreTurnedOver)
{
  // A grid of 4 x 4 faces whose inner nodes are mirrored
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

  // Faces that nothing can help, and faces that need no help, stay
  std::vector<Plan::Point> flat   = {{0., 0.}, {1., 0.}, {2., 0.}, {3., 0.}};
  const auto               before = flat, good = points;
  untangle({{{0, 1, 2, 3}}}, std::vector<bool>(4, true), {}, flat);
  EXPECT_EQ(flat, before);
  untangle(faces, fixed, {}, points);
  EXPECT_EQ(points, good);
}

TEST(Layouts, ScaledParametersGiveTheScaledMesh)
{
  const HexMesh mesh = generate_mesh(one_pin());
  for (const int exponent : {-6, -3, 3, 6})
    {
      const auto         scaled     = [exponent](const std::string &value) { return std::stod(value + "e" + std::to_string(exponent)); };
      GeometryParameters parameters = one_pin();
      parameters.disc_inner_radius  = scaled("0.1505");
      parameters.disc_outer_radius  = scaled("0.3155");
      parameters.disc_thickness     = scaled("0.0463");
      parameters.pin_diameter       = scaled("0.0520");
      parameters.pin_height         = scaled("0.0318");
      parameters.element_size       = scaled("0.02");
      parameters.pairing_tolerance  = scaled("0.000001");
      parameters.top.radii          = {scaled("0.23")};
      const HexMesh other           = generate_mesh(parameters);
      ASSERT_EQ(other.points.size(), mesh.points.size());
      for (std::size_t i = 0; i < mesh.points.size(); ++i)
        for (unsigned int d = 0; d < 3; ++d)
          EXPECT_NEAR(other.points[i][d] / std::pow(10., exponent), mesh.points[i][d], 1e-15);
    }
}

TEST(Layouts, ElementsGrowBetweenThinPins)
{
  GeometryParameters parameters;
  parameters.pin_diameter = 0.001;
  EXPECT_LT(generate_mesh(parameters).hexahedra.size(), 30000u);
}
