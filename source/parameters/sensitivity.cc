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
      "rate or, if no mode grows, all modes by descending divergence rate.",
      {1, 1000});
    declarations.add("Thresholds", thresholds,
                     "Computes the thresholds between Sweep/First and Sweep/Last friction coefficient, and their derivatives.");
    declarations.add(
      "Geometry", geometry,
      "Derivatives with respect to dimensions of the built-in geometry, disc_pins.geo. `sizes`: lengths. `sizes and places`: also the "
      "position of each pin. Each derivative requires two assemblies.");
    declarations.add(
      "Tolerance", tolerance, "none",
      "The basis is enriched until the derivatives of each mode change by at most this fraction of its largest derivative. A warning is "
      "printed if the basis cannot be enriched further.",
      {1e-10, 1e-1});
  }

  void IngredientsParameters::declare(Declarations &declarations)
  {
    declarations.enter("Ingredients");
    declarations.add(
      "Frequency tolerance", frequency_tolerance, "%",
      "Largest acceptable change in a frequency in the cheapest model, as a percentage of the frequency in the given model; must be positive.",
      {0., 100.});
    declarations.add("Divergence tolerance", divergence_tolerance, "percentage points",
                     "Largest acceptable difference in a divergence rate between the cheapest and the given model; must be positive.",
                     {0., 100.});
    declarations.add("Trial friction slope", trial_slope, "s/m",
                     "Trial slope of the friction coefficient if Operation/Friction slope = 0; 0: no trial.", {-1e3, 1e3});
    declarations.add("Trial damping ratio", trial_damping_ratio, "none",
                     "Trial damping ratio of all modes if Damping/Modal damping ratio is empty; 0: no trial.", {0., 0.99});
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
