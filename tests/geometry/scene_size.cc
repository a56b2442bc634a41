#include "scenes.h"

#include <squeal/base/conventions.h>
#include <squeal/geometry/scene_size.h>

using namespace Scenes;

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
