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
} // namespace Squeal
