// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/parameters/declarations.h>

namespace Squeal
{
  /// Geometry parameters of the built-in model for which derivatives are computed.
  enum class GeometrySensitivities
  {
    none,
    sizes,           ///< dimensions of the disc, and the common height and diameter of the pins
    sizes_and_places ///< also the position of each pin
  };

  template <>
  inline constexpr EnumName<GeometrySensitivities> enum_table<GeometrySensitivities>[] = {
    {GeometrySensitivities::none, "none"},
    {GeometrySensitivities::sizes, "sizes"},
    {GeometrySensitivities::sizes_and_places, "sizes and places"}};

  /// Derivatives computed by `Study = sensitivity`, and their accuracy (section `Sensitivity`).
  struct SensitivityParameters
  {
    unsigned int          modes      = 10; ///< maximum number of modes whose derivatives are computed
    bool                  thresholds = true;
    GeometrySensitivities geometry   = GeometrySensitivities::sizes;
    double                tolerance  = 1e-4; ///< relative change in the derivatives below which the basis is no longer extended [-]

    void declare(Declarations &declarations);
  };

  /// Required accuracy of a model, and trial values of missing features (section `Ingredients`).
  struct IngredientsParameters
  {
    double frequency_tolerance  = 1.;   ///< largest change in a frequency [%]
    double divergence_tolerance = 0.05; ///< largest change in a divergence rate [percentage points]
    double trial_slope          = 0.;   ///< trial friction slope for a model without a friction slope [s/m]; 0: not tried
    double trial_damping_ratio  = 0.;   ///< trial ζ of all modes for a model without modal damping [-]; 0: not tried

    void declare(Declarations &declarations);

    /// Throws ParameterError.
    void check() const;
  };
} // namespace Squeal
