#pragma once

#include <squeal/base/enum_table.h>

#include <complex>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// State in which a mode is measured.
  enum class MeasuredState
  {
    component, ///< free disc, or pins with sliding contact
    coupled,   ///< bodies in contact without friction and damping
    complex    ///< at the friction coefficient of the operation
  };

  template <>
  inline constexpr EnumName<MeasuredState> enum_table<MeasuredState>[] = {{MeasuredState::component, "component"},
                                                                          {MeasuredState::coupled, "coupled"},
                                                                          {MeasuredState::complex, "complex"}};

  /// A measured number with its standard deviation.
  struct Measured
  {
    double value, deviation;
  };

  /// A measured mode, and which computed modes it is compared with: the mean of all of a label, or one of them.
  struct MeasuredMode
  {
    MeasuredState           state;
    std::string             label;         ///< with or without the sign of a doublet
    std::string             member;        ///< "lowest", "highest", or a number from one on; empty: the mean of all
    Measured                frequency;     ///< [Hz]
    std::optional<Measured> damping_ratio; ///< ζ = −Re λ / |λ| [-]
    std::string             where;         ///< file and line
  };

  struct MeasuredModes
  {
    std::vector<MeasuredMode> modes;

    /// Deviations are not measured but the same part of every frequency.
    bool are_relative;

    /// Numbers, frequencies and damping ratios.
    std::size_t n_numbers() const;

    bool has(MeasuredState state) const;
  };

  /// Deviation of frequencies where none is given, part of them [-].
  inline constexpr double default_deviation = 0.01;

  /// Reads the file of measured modes; see doc/updating.md. Throws FileError, or ParameterError naming the line.
  MeasuredModes read_measured_modes(const std::string &path);

  /// A computed mode with its derivatives with respect to the fitted parameters. In a cluster of equal eigenvalues, whose members have
  /// none, they are those of their mean.
  struct ComputedMode
  {
    MeasuredState                     state;
    std::string                       label;
    std::complex<double>              lambda;      ///< [rad/s]
    std::vector<std::complex<double>> derivatives; ///< dλ/dp [rad/s per unit of p]
  };

  /// Computed counterpart of a measured mode, with derivatives with respect to each parameter.
  struct Counterpart
  {
    double              frequency;                            ///< [Hz]
    double              damping_ratio;                        ///< [-]
    std::vector<double> frequency_rates, damping_ratio_rates; ///< per unit of each parameter
  };

  /// The counterpart among computed modes. Throws SolverError if no mode of the state has the label, or too few.
  Counterpart counterpart_of(const MeasuredMode &measured, const std::vector<ComputedMode> &modes);
} // namespace Squeal
