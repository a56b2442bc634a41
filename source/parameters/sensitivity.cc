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
    declarations.add(
      "Largest number of modes", modes, "none",
      "Maximum number of modes whose derivatives are computed at Operation/Friction coefficient: growing modes by descending divergence "
      "rate; if no mode grows, the least damped modes.",
      {1, 1000});
    declarations.add("Thresholds", thresholds,
                     "Computes the thresholds between Sweep/First and Sweep/Last friction coefficient, and their derivatives.");
    declarations.add(
      "Geometry", geometry,
      "Derivatives with respect to dimensions of the built-in geometry, disc_pins.geo. `sizes`: lengths. `sizes and places`: also the "
      "position of each pin. Each derivative requires two assemblies.");
    declarations.add("Tolerance", tolerance, "none",
                     "The basis is enriched until the derivatives of a mode change by less than this value, relative to the largest "
                     "derivative of the mode.",
                     {1e-10, 1e-1});
  }

  void IngredientsParameters::declare(Declarations &declarations)
  {
    declarations.enter("Ingredients");
    declarations.add("Frequency tolerance", frequency_tolerance, "%",
                     "Largest acceptable change of a frequency in the cheapest model, relative to the given model.", {0., 100.});
    declarations.add("Divergence tolerance", divergence_tolerance, "percentage points",
                     "Largest acceptable change of a divergence rate in the cheapest model, relative to the given model.", {0., 100.});
    declarations.add("Trial friction slope", trial_slope, "s/m",
                     "Trial slope of the friction coefficient if the model has Operation/Friction slope = 0; 0: no trial.", {-1e3, 1e3});
    declarations.add("Trial damping ratio", trial_damping_ratio, "none",
                     "Trial damping ratio of all modes if the model has no Damping/Modal damping ratio; 0: no trial.", {0., 0.99});
  }

  void IngredientsParameters::check() const
  {
    // Reject zero, because rounding errors alone would exceed it
    for (const auto &[name, value, unit] : {std::tuple{"Frequency tolerance", frequency_tolerance, " %"},
                                            std::tuple{"Divergence tolerance", divergence_tolerance, " percentage points"}})
      if (!(value > 0.))
        throw ParameterError("the tolerance is " + exact_text(value) + unit + ", but must be positive",
                             std::string("parameter Ingredients/") + name, "give the largest acceptable change");
  }
} // namespace Squeal
