// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/studies/updating/sensors.h>

#include <complex>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// State of the brake in which a mode is measured.
  enum class MeasuredState
  {
    component, ///< free disc, or pins with sliding contact
    coupled,   ///< bodies in contact without friction and damping
    complex    ///< at Operation/Friction coefficient
  };

  template <>
  inline constexpr EnumName<MeasuredState> enum_table<MeasuredState>[] = {{MeasuredState::component, "component"},
                                                                          {MeasuredState::coupled, "coupled"},
                                                                          {MeasuredState::complex, "complex"}};

  /// A measured number and its standard deviation.
  struct Measured
  {
    double value, deviation;
  };

  /// A measured mode. Its computed counterpart is the mode most similar to the shape with this label at the sensors, or a mean of two similar
  /// ones; without such a shape, one mode with this label, or the mean of all of them.
  struct MeasuredMode
  {
    MeasuredState           state;
    std::string             label;         ///< with or without the sign of a doublet
    std::string             member;        ///< "lowest", "highest", or a number >= 1; empty: the mean of all
    Measured                frequency;     ///< [Hz]
    std::optional<Measured> damping_ratio; ///< ζ = −Re λ / |λ| [-]
    std::string             where;         ///< file and line, for messages
  };

  struct MeasuredModes
  {
    std::vector<MeasuredMode> modes;
    Sensors                   sensors;         ///< none: all modes are paired by label
    double                    least_mac = 0.5; ///< below this, shapes are not similar [-]

    /// No deviations are given: each is the same fraction of its frequency.
    bool are_relative = true;

    /// Number of frequencies and damping ratios.
    std::size_t n_numbers() const;

    bool has(MeasuredState state) const;
  };

  /// Relative standard deviation of frequencies if none is given [-].
  inline constexpr double default_deviation = 0.01;

  /// Reads the file of measured modes; see doc/updating.md. Throws FileError, or ParameterError with the line number.
  MeasuredModes read_measured_modes(const std::string &path);

  /// A computed mode and its derivatives with respect to the fitted parameters. Equal eigenvalues have no individual derivatives: all modes
  /// of a cluster have the derivatives of its mean.
  struct ComputedMode
  {
    MeasuredState                     state;
    std::string                       label;
    std::complex<double>              lambda;          ///< [rad/s]
    std::vector<std::complex<double>> derivatives;     ///< dλ/dp [rad/s per unit of p]
    Eigen::VectorXcd                  at_sensors = {}; ///< response of each sensor; empty without sensors
  };

  /// Computed counterpart of a measured mode and its derivatives with respect to each parameter.
  struct Counterpart
  {
    double                frequency;                            ///< [Hz]
    double                damping_ratio;                        ///< [-]
    std::vector<double>   frequency_rates, damping_ratio_rates; ///< per unit of each parameter
    std::string           label;                                ///< of the mode, or of the first of several
    std::optional<double> mac;                                  ///< of the shapes at the sensors [-]
  };

  /// Finds the counterpart of one of the measured modes. Throws SolverError if no mode of the state has the label or a similar shape, or if
  /// the member does not exist.
  Counterpart counterpart_of(const MeasuredMode &mode, const MeasuredModes &measured, const std::vector<ComputedMode> &modes);
} // namespace Squeal
