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

  /// Values from first to last.
  struct ValueRange
  {
    double       first, last;
    unsigned int number;

    /// Equally spaced values.
    std::vector<double> linear() const;

    /// Values of equal ratio.
    std::vector<double> geometric() const;
  };

  /// A parameter of a system file and its values.
  struct NamedRange
  {
    std::string name;
    ValueRange  values;
  };

  /// Modes over the friction coefficient (section `Sweep`).
  struct SweepParameters
  {
    ValueRange          friction_coefficients = {0., 0.45, 90};
    double              tolerance             = 1e-6; ///< on the estimated |δλ| / |λ| [-]
    unsigned int        maximum_basis         = 1500; ///< vectors
    double              threshold_tolerance   = 1e-6; ///< of the friction coefficient [-]
    bool                compare_dissipation   = true; ///< also without radial dissipation
    std::vector<double> mode_shapes;                  ///< friction coefficients at which the leading mode is written
    std::vector<double> planes;                       ///< friction coefficients at which all modes are written; empty: mode_shapes
    std::vector<double> counts;                       ///< friction coefficients at which modes are counted by the argument principle

    MapParameter map_parameter             = MapParameter::none;
    ValueRange   map_values                = {100., 10000., 11}; ///< [N] or [rad/s]
    unsigned int map_friction_coefficients = 19;

    std::string parameter, second_parameter; ///< of a system file: "name, first, last, number"; empty: mu, none

    /// Friction coefficients of the complex plane.
    const std::vector<double> &complex_plane() const
    {
      return planes.empty() ? mode_shapes : planes;
    }

    /// Friction coefficients of the map: from the first to the last of the sweep.
    std::vector<double> map_grid() const;

    void declare(Declarations &declarations);

    /// The parameter of a system file that varies, and the second one of a map; nothing if there is none.
    NamedRange                varied_parameter() const;
    std::optional<NamedRange> second_varied_parameter() const;

    /// Throws ParameterError.
    void check() const;

    /// The same for a system file.
    void check_of_system() const;
  };
} // namespace Squeal
