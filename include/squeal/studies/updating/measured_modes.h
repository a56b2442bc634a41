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
    component, ///< measured on the free disc, or on pins with sliding contact
    coupled,   ///< measured on bodies in contact, without friction and damping
    complex    ///< measured at Operation/Friction coefficient
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

  /// A measured mode. If a measured shape has this label, the computed counterpart is the mode with the most similar shape at the sensors,
  /// or a weighted mean of two similar modes; otherwise, it is one mode with this label, or the mean of all modes with this label.
  struct MeasuredMode
  {
    MeasuredState           state;
    std::string             label;         ///< label with or without the sign of a doublet
    std::string             member;        ///< "lowest", "highest", or a number >= 1; empty: the mean of all modes with the label
    Measured                frequency;     ///< [Hz]
    std::optional<Measured> damping_ratio; ///< ζ = −Re λ / |λ| [-]
    std::string             where;         ///< file and line, for messages
  };

  struct MeasuredModes
  {
    std::vector<MeasuredMode> modes;
    Sensors                   sensors;         ///< empty: all modes are paired by label
    double                    least_mac = 0.5; ///< MAC below which shapes are not similar [-]

    /// True if no deviations are given; all frequencies then have the same relative deviation.
    bool are_relative = true;

    /// Number of frequencies and damping ratios.
    std::size_t n_numbers() const;

    bool has(MeasuredState state) const;
  };

  /// Relative standard deviation of frequencies if none is given [-].
  inline constexpr double default_deviation = 0.01;

  /// Reads the file of measured modes; see doc/updating.md. Throws FileError, or ParameterError with the line number.
  MeasuredModes read_measured_modes(const std::string &path);

  /// A computed mode and its derivatives with respect to the fitted parameters. Because individual modes of a cluster of equal eigenvalues
  /// are not differentiable, each has the mean derivatives of the cluster.
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
    std::vector<double>   frequency_rates, damping_ratio_rates; ///< derivatives per unit of each parameter
    std::string           label;                                ///< label of the mode, or of the first of several modes
    std::optional<double> mac;                                  ///< MAC with the measured shape [-]; empty without measured shape
  };

  /// Finds the counterpart of a measured mode. Throws SolverError if no mode of the state has the label or a similar shape, or if the
  /// member does not exist.
  Counterpart counterpart_of(const MeasuredMode &mode, const MeasuredModes &measured, const std::vector<ComputedMode> &modes);
} // namespace Squeal
