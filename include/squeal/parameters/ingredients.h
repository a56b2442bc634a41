#pragma once

#include <squeal/parameters/declarations.h>

namespace Squeal
{
  /// The accuracy that a model has to keep, and what is tried where a scene has no value of its own (section `Ingredients`).
  struct IngredientsParameters
  {
    double frequency_tolerance  = 1.;   ///< largest change of a frequency [%]
    double divergence_tolerance = 0.05; ///< largest change of a divergence rate [percentage points]
    double trial_slope          = 0.;   ///< of a scene without friction slope [s/m]; 0: none is tried
    double trial_damping_ratio  = 0.;   ///< ζ of all modes of a scene without modal damping [-]; 0: none is tried

    void declare(Declarations &declarations);

    /// Throws ParameterError.
    void check() const;
  };
} // namespace Squeal
