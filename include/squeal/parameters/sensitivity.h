// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/parameters/declarations.h>

namespace Squeal
{
  /// With respect to what of the built-in geometry derivatives are found.
  enum class GeometrySensitivities
  {
    none,
    sizes,           ///< lengths of the disc and of all pins
    sizes_and_places ///< and where each pin is
  };

  template <>
  inline constexpr EnumName<GeometrySensitivities> enum_table<GeometrySensitivities>[] = {
    {GeometrySensitivities::none, "none"},
    {GeometrySensitivities::sizes, "sizes"},
    {GeometrySensitivities::sizes_and_places, "sizes and places"}};

  /// Of what `Study = sensitivity` gives derivatives, and how accurately (section `Sensitivity`).
  struct SensitivityParameters
  {
    unsigned int          modes      = 10;   ///< most modes with derivatives
    bool                  thresholds = true; ///< whether thresholds have derivatives, too
    GeometrySensitivities geometry   = GeometrySensitivities::sizes;
    double tolerance = 1e-4; ///< change of a derivative by the last growth of the basis, over the largest one of the mode [-]

    void declare(Declarations &declarations);
  };

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
