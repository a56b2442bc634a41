#include <squeal/parameters/sensitivity.h>

namespace Squeal
{
  void SensitivityParameters::declare(Declarations &declarations)
  {
    declarations.enter("Sensitivity");
    declarations.add(
      "Largest number of modes", modes,
      "Modes whose derivatives are found at Operation/Friction coefficient: growing ones, those of the largest divergence rate "
      "first; where none grows, the least damped. Units: none.",
      {1, 1000});
    declarations.add("Thresholds", thresholds,
                     "Find the thresholds between Sweep/First and Sweep/Last friction coefficient, and their derivatives.");
    declarations.add(
      "Geometry", geometry,
      "Derivatives with respect to lengths of the built-in geometry, disc_pins.geo, and to the place of each pin; they take two "
      "assemblies each.");
    declarations.add(
      "Tolerance", tolerance,
      "Change of the derivatives of a mode by the last growth of the basis, relative to the largest of them, up to which the "
      "basis grows. Units: none.",
      {1e-10, 1e-1});
  }
} // namespace Squeal
