// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/sensitivity.h>

#include <tuple>

namespace Squeal
{
  void SensitivityParameters::declare(Declarations &declarations)
  {
    declarations.enter("Sensitivity");
    declarations.add("Largest number of modes", modes, "none",
                     "Modes whose derivatives are found at Operation/Friction coefficient: growing ones, those of the largest "
                     "divergence rate first; where none grows, the least damped.",
                     {1, 1000});
    declarations.add("Thresholds", thresholds,
                     "Find the thresholds between Sweep/First and Sweep/Last friction coefficient, and their derivatives.");
    declarations.add(
      "Geometry", geometry,
      "Derivatives with respect to lengths of the built-in geometry, disc_pins.geo, and to the place of each pin; they take two "
      "assemblies each.");
    declarations.add("Tolerance", tolerance, "none",
                     "Change of the derivatives of a mode by the last growth of the basis, relative to the largest of them, up to "
                     "which the basis grows.",
                     {1e-10, 1e-1});
  }

  void IngredientsParameters::declare(Declarations &declarations)
  {
    declarations.enter("Ingredients");
    declarations.add("Frequency tolerance", frequency_tolerance, "%",
                     "Largest change of a frequency that the cheapest model may make beside the scene as it is given.", {0., 100.});
    declarations.add("Divergence tolerance", divergence_tolerance, "percentage points",
                     "Largest change of a divergence rate that the cheapest model may make beside the scene as it is given.", {0., 100.});
    declarations.add("Trial friction slope", trial_slope, "s/m",
                     "Slope of the friction coefficient that is tried where the scene has Operation/Friction slope = 0; 0: none is "
                     "tried.",
                     {-1e3, 1e3});
    declarations.add("Trial damping ratio", trial_damping_ratio, "none",
                     "Damping ratio of all modes that is tried where the scene has no Damping/Modal damping ratio; 0: none is tried.",
                     {0., 0.99});
  }

  void IngredientsParameters::check() const
  {
    // A tolerance of zero refuses models that differ by rounding, and so all of them
    for (const auto &[name, value, unit] : {std::tuple{"Frequency tolerance", frequency_tolerance, " %"},
                                            std::tuple{"Divergence tolerance", divergence_tolerance, " percentage points"}})
      if (!(value > 0.))
        throw ParameterError("the accuracy asked for is " + exact_text(value) + unit, std::string("parameter Ingredients/") + name,
                             "give a positive change that is still acceptable");
  }
} // namespace Squeal
