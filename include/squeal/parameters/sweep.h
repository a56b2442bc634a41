// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/parameters/declarations.h>

#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// The second parameter of a stability map.
  enum class MapParameter
  {
    none,
    load,
    speed
  };

  template <>
  inline constexpr EnumName<MapParameter> enum_table<MapParameter>[] = {{MapParameter::none, "none"},
                                                                        {MapParameter::load, "load"},
                                                                        {MapParameter::speed, "speed"}};

  struct ValueRange
  {
    double       first, last;
    unsigned int number;

    /// Equally spaced values.
    std::vector<double> linear() const;

    /// Geometrically spaced values.
    std::vector<double> geometric() const;
  };

  /// A parameter of a system file and its values.
  struct NamedRange
  {
    std::string name;
    ValueRange  values;
  };

  /// Modes as functions of the friction coefficient or of a parameter of a system file (section `Sweep`).
  struct SweepParameters
  {
    ValueRange          friction_coefficients = {0., 0.45, 90};
    double              tolerance             = 1e-6; ///< limit of the estimated |δλ| / |λ| [-]
    unsigned int        maximum_basis         = 1500;
    double              threshold_tolerance   = 1e-6; ///< width of the interval that encloses a threshold [unit of the varied parameter]
    bool                compare_dissipation   = true; ///< repeat the sweep without radial dissipation
    std::vector<double> mode_shapes;                  ///< friction coefficients for output of the leading mode, if it grows
    std::vector<double> planes;                       ///< values for output of all modes; empty: mode_shapes
    std::vector<double> counts;                       ///< values for mode counts by the argument principle

    MapParameter map_parameter             = MapParameter::none;
    ValueRange   map_values                = {100., 10000., 11}; ///< values of the map parameter [N] or [rad/s]
    unsigned int map_friction_coefficients = 19;

    std::string parameter, second_parameter; ///< parameters of a system file: "name, first, last, number"; empty: mu, and no map

    const std::vector<double> &complex_plane() const
    {
      return planes.empty() ? mode_shapes : planes;
    }

    /// Friction coefficients of the map: from the first to the last of the sweep.
    std::vector<double> map_grid() const;

    void declare(Declarations &declarations);

    /// The varied parameter of a system file, and the second parameter of a map; empty if there is none.
    NamedRange                varied_parameter() const;
    std::optional<NamedRange> second_varied_parameter() const;

    /// Throws ParameterError.
    void check() const;

    /// Checks parameters for a system file. Throws ParameterError.
    void check_of_system() const;
  };
} // namespace Squeal
