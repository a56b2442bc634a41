// SPDX-License-Identifier: GPL-3.0-or-later

#include "scenes.h"

#include <squeal/base/conventions.h>
#include <squeal/geometry/scene_size.h>

using namespace Scenes;

using Point = Mesh::Point;

TEST(DiscAxes, OnesThatAreNotTheZAxisAreRefusedByName)
{
  const Mesh   mesh  = generate_mesh(one_pin());
  const auto   check = [&](const Place &motion) { return is_round_about_z(moved(mesh, motion), "here"); };
  const double c = std::cos(0.02), s = std::sin(0.02);
  for (const auto &[map, text] : std::vector<std::pair<Place, std::string>>{{[](const Point &p) {
                                                                               return Point{p[0] + 0.003, p[1] - 0.002, p[2] + 0.7};
                                                                             },
                                                                             "through (0.003, -0.002, 0.7) m in direction (0, 0, 1)"},
                                                                            {[](const Point &p) {
                                                                               return Point{p[1], p[2], p[0]};
                                                                             },
                                                                             "in direction (0, "},
                                                                            {[=](const Point &p) {
                                                                               return Point{p[0], c * p[1] - s * p[2], s * p[1] + c * p[2]};
                                                                             },
                                                                             "in direction (0, -0.02, 1)"}})
    expect_mentions(message<MeshError>([&, map = map] { check(map); }), {text, "here", "Translate and Rotate"});

  EXPECT_TRUE(check([](const Point &p) { return p; }));
  // Stretch a 60° sector into an ear
  EXPECT_TRUE(check([](const Point &p) {
    const double factor = std::abs(std::atan2(p[1], -p[0])) < std::acos(-1.) / 6. ? 1.2 : 1.;
    return Point{factor * p[0], factor * p[1], p[2]};
  }));
  // Square discs are not round, so that their axis is not checked
  for (const double offset : {0., 1.})
    EXPECT_FALSE(check([&](const Point &p) {
      const double factor = std::hypot(p[0], p[1]) / std::max(std::abs(p[0]), std::abs(p[1]));
      return Point{factor * p[0] + offset, factor * p[1], p[2]};
    }));
}

TEST(ProblemSizes, AreKnownBeforeTheMesh)
{
  for (const double size : {0.0115, 0.02})
    {
      GeometryParameters parameters;
      parameters.element_size    = size;
      const Mesh        mesh     = generate_mesh(parameters);
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
  expect_mentions(message<MeshError>([&] { generate_mesh(parameters); }), {"cells", "dofs", "GB are available", "Geometry/Disc layers"});
  parameters.file = "disc_pad.geo";
  expect_mentions(message<MeshError>([&] { generate_mesh(parameters); }), {"cells", "dofs", "GB are available"});
  // Expect the memory measured with two threads, without attachment modes [GB]
  EXPECT_NEAR(ProblemSize({57794., 283233., 0., 75.}).memory(18.) / 1e9, 4.3, 1.);
  EXPECT_NO_THROW(check_memory({1e4, 3e4, 200.}, 100., "here"));
}

TEST(WaveResolution, RefusesElementsLongerThanAShearWave)
{
  const Mesh         mesh = generate_mesh(one_pin());
  MaterialParameters soft_pins;
  soft_pins.pin.young_modulus *= 1e-3;
  const auto refused = [&](const MaterialParameters &materials, const unsigned int degree, const double frequency) {
    return message<ParameterError>([&] { check_wave_resolution(mesh, materials, degree, circular_frequency(frequency)); }) != "accepted";
  };
  double limit = 1.;
  while (!refused(soft_pins, 1, limit))
    limit *= 1.1;
  EXPECT_FALSE(refused(MaterialParameters(), 1, limit));
  // Orthotropic pins with the same small shear modulus have the same limit
  MaterialParameters soft_in_shear;
  soft_in_shear.orthotropic = {
    {{1.9e9, 0.25, 3070., 0., 0., Orthotropy{1.9e9, 1.9e9, 0.25, 0.25, 1e9, soft_pins.pin.least_wave_modulus(), 1e9}}, "pin_top_1"}};
  EXPECT_TRUE(refused(soft_in_shear, 1, limit));
  EXPECT_FALSE(refused(soft_in_shear, 1, limit / 1.1));
  // Quadratic elements double the limit
  EXPECT_FALSE(refused(soft_pins, 2, limit));
  EXPECT_TRUE(refused(soft_pins, 2, 2. * limit));
}
