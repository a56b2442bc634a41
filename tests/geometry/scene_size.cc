#include "scenes.h"

#include <squeal/base/conventions.h>
#include <squeal/geometry/scene_size.h>

#include <functional>

using namespace Scenes;

namespace
{
  using Map = std::function<HexMesh::Point(const HexMesh::Point &)>;

  /// The mesh of one pin with every node moved.
  HexMesh moved(const Map &map)
  {
    static const HexMesh mesh   = generate_mesh(one_pin());
    HexMesh              result = mesh;
    for (HexMesh::Point &point : result.points)
      point = map(point);
    return result;
  }
} // namespace

TEST(DiscAxes, RoundDiscIsAccepted)
{
  EXPECT_TRUE(is_round_about_z(moved([](const auto &p) { return p; }), "here"));
}

TEST(DiscAxes, OtherAxesAreRefusedByName)
{
  const double a = 0.02;
  for (const auto &[map, text] : std::vector<std::pair<Map, std::string>>{
         {[](const auto &p) {
            return HexMesh::Point{p[0] + 0.003, p[1] - 0.002, p[2] + 0.7};
          },
          "through (0.003, -0.002, 0.7) m in direction (0, 0, 1)"},
         {[](const auto &p) {
            return HexMesh::Point{p[1], p[2], p[0]};
          },
          "in direction (0, "},
         {[a](const auto &p) {
            return HexMesh::Point{p[0], std::cos(a) * p[1] - std::sin(a) * p[2], std::sin(a) * p[1] + std::cos(a) * p[2]};
          },
          "in direction (0, -0.02, 1)"}})
    expect_mentions(message<MeshError>([&] { is_round_about_z(moved(map), "here"); }), {text, "here", "Translate and Rotate"});
}

TEST(DiscAxes, DiscWithAnEarIsRound)
{
  // Radii of a sector of 60° are stretched
  EXPECT_TRUE(is_round_about_z(moved([](const HexMesh::Point &p) {
                                 const double factor = std::abs(std::atan2(p[1], -p[0])) < std::acos(-1.) / 6. ? 1.2 : 1.;
                                 return HexMesh::Point{factor * p[0], factor * p[1], p[2]};
                               }),
                               "here"));
}

TEST(DiscAxes, SquareDiscsAreNotRoundButAccepted)
{
  // From the square to the circle and back, on the axis and beside it
  for (const double offset : {0., 1.})
    EXPECT_FALSE(is_round_about_z(moved([&](const HexMesh::Point &p) {
                                    const double factor = std::hypot(p[0], p[1]) / std::max(std::abs(p[0]), std::abs(p[1]));
                                    return HexMesh::Point{factor * p[0] + offset, factor * p[1], p[2]};
                                  }),
                                  "here"));
}

TEST(ProblemSizes, AreKnownBeforeTheMesh)
{
  for (const double size : {0.0115, 0.02})
    {
      GeometryParameters parameters;
      parameters.element_size    = size;
      const HexMesh     mesh     = generate_mesh(parameters);
      const ProblemSize expected = expected_size(parameters), found = expected_size(mesh, 1);
      EXPECT_NEAR(expected.cells / found.cells, 1., 0.4);
      EXPECT_NEAR(expected.dofs / found.dofs, 1., 0.4);
      EXPECT_EQ(expected.contact_nodes, found.contact_nodes);
      EXPECT_EQ(found.dofs, 3. * mesh.points.size());
    }
}

TEST(ProblemSizes, WhatDoesNotFitIsRefusedBeforehand)
{
  GeometryParameters parameters;
  parameters.disc_layers = 1000000;
  expect_mentions(message<MeshError>([&] { generate_mesh(parameters); }),
                  {"hexahedra", "dofs", "GB are available", "Geometry/Disc layers"});
  parameters.file = "disc_pad.geo";
  expect_mentions(message<MeshError>([&] { generate_mesh(parameters); }), {"hexahedra", "dofs", "GB are available"});
  EXPECT_NO_THROW(check_memory({1e4, 3e4, 200.}, 1, 100., "here"));
}

TEST(WaveResolution, RefusesElementsLongerThanAShearWave)
{
  const HexMesh      mesh = generate_mesh(one_pin());
  MaterialParameters soft_pins;
  soft_pins.pin.young_modulus *= 1e-3;
  // The frequency from which on elements are too long is in the message
  const auto refused = [&](const MaterialParameters &materials, const unsigned int degree, const double frequency) {
    try
      {
        check_wave_resolution(mesh, materials, degree, circular_frequency(frequency));
      }
    catch (const ParameterError &)
      {
        return true;
      }
    return false;
  };
  double limit = 1.;
  while (!refused(soft_pins, 1, limit))
    limit *= 1.1;
  EXPECT_FALSE(refused(MaterialParameters(), 1, limit));
  // Nodes of quadratic elements are twice as dense
  EXPECT_FALSE(refused(soft_pins, 2, limit));
  EXPECT_TRUE(refused(soft_pins, 2, 2. * limit));
}
