#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/ingredients.h>

#include <tuple>

namespace Squeal
{
  void IngredientsParameters::declare(Declarations &declarations)
  {
    declarations.enter("Ingredients");
    declarations.add("Frequency tolerance", frequency_tolerance,
                     "Largest change of a frequency that the cheapest model may make beside the scene as it is given. Units: %.",
                     {0., 100.});
    declarations.add("Divergence tolerance", divergence_tolerance,
                     "Largest change of a divergence rate that the cheapest model may make beside the scene as it is given. Units: "
                     "percentage points.",
                     {0., 100.});
    declarations.add("Trial friction slope", trial_slope,
                     "Slope of the friction coefficient that is tried where the scene has Operation/Friction slope = 0; 0: none is "
                     "tried. Units: s/m.",
                     {-1e3, 1e3});
    declarations.add("Trial damping ratio", trial_damping_ratio,
                     "Damping ratio of all modes that is tried where the scene has no Damping/Modal damping ratio; 0: none is tried. "
                     "Units: none.",
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
