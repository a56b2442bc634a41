#include "scenes.h"

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/bases/mode_count_estimate.h>
#include <squeal/eigen/symmetric_modes.h>
#include <squeal/geometry/generate_mesh.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /// Four pins of given diameter and height on a default disc; the mesh still resolves the waves asked for.
  HexMesh four_pins(const double diameter = 0.052, const double height = 0.0318, const int pin_layers = 4)
  {
    GeometryParameters geometry;
    geometry.top.angles   = {-10., 10.};
    geometry.top.radii    = {0.2275, 0.2275};
    geometry.bottom       = geometry.top;
    geometry.pin_diameter = diameter;
    geometry.pin_height   = height;
    geometry.pin_layers   = pin_layers;
    geometry.disc_layers  = 3;
    geometry.element_size = 0.02;
    return generate_mesh(geometry, {});
  }

  /// Holds the estimate against the number of modes by inertia up to each of the frequencies.
  void expect_within_factor_two(const HexMesh &mesh, const MaterialParameters &materials, const std::vector<double> &frequencies)
  {
    const Scene scene(mesh, materials, operating());
    for (const double frequency : frequencies)
      {
        SCOPED_TRACE(frequency);
        const double omega = circular_frequency(frequency);
        const int    n     = count_modes(*scene.coupled.stiffness, *scene.coupled.mass, omega * omega, "a scene");
        const double ratio = expected_number_of_modes(mesh, materials, omega) / n;
        EXPECT_GT(ratio, 0.5);
        EXPECT_LT(ratio, 2.);
      }
  }
} // namespace

TEST(ModeCountEstimate, AgreesWithTheInertiaOverTheBand)
{
  const HexMesh mesh = four_pins();
  for (const MaterialParameters &materials : {mounted(), mounted({})})
    expect_within_factor_two(mesh, materials, {3000., 5000., 8000., 12000.});
}

TEST(ModeCountEstimate, FollowsTheMaterials)
{
  const HexMesh      mesh      = four_pins();
  MaterialParameters soft_pins = mounted(), soft_disc = mounted();
  soft_pins.pin.young_modulus /= 9.;
  soft_disc.disc.young_modulus /= 9.;
  for (const MaterialParameters &materials : {soft_pins, soft_disc})
    expect_within_factor_two(mesh, materials, {5000.});
}

TEST(ModeCountEstimate, SlenderPinsBend)
{
  expect_within_factor_two(four_pins(0.02, 0.12, 16), mounted(), {1000., 3000., 5000.});
}

TEST(ModeCountEstimate, GrowsWithTheCubeOfTheFrequencyInTheEnd)
{
  const HexMesh mesh = four_pins();
  const double  n    = expected_number_of_modes(mesh, mounted(), 1e8);
  EXPECT_NEAR(expected_number_of_modes(mesh, mounted(), 2e8) / n, 8., 0.1);
}

TEST(WaveResolution, RefusesElementsLongerThanAShearWave)
{
  const HexMesh      mesh      = four_pins();
  MaterialParameters soft_pins = mounted();
  soft_pins.pin.young_modulus *= 1e-3;
  EXPECT_NO_THROW(check_wave_resolution(mesh, mounted(), 1, circular_frequency(12000.)));
  EXPECT_THROW(check_wave_resolution(mesh, soft_pins, 1, circular_frequency(5000.)), ParameterError);
  EXPECT_NO_THROW(check_wave_resolution(mesh, soft_pins, 1, circular_frequency(500.)));
  // Nodes of quadratic elements are twice as dense
  const double omega = circular_frequency(1000.);
  EXPECT_THROW(check_wave_resolution(mesh, soft_pins, 1, 1.5 * omega), ParameterError);
  EXPECT_NO_THROW(check_wave_resolution(mesh, soft_pins, 2, 1.5 * omega));
}
