// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/parameters/declarations.h>

#include <string>
#include <vector>

namespace Squeal
{
  enum class DistributionKind
  {
    uniform,   ///< two limits
    normal,    ///< mean, standard deviation, truncated at two limits
    lognormal, ///< mean and standard deviation
    table      ///< equally probable values
  };

  template <>
  inline constexpr EnumName<DistributionKind> enum_table<DistributionKind>[] = {{DistributionKind::uniform, "uniform"},
                                                                                {DistributionKind::normal, "normal"},
                                                                                {DistributionKind::lognormal, "lognormal"},
                                                                                {DistributionKind::table, "table"}};

  struct Distribution
  {
    DistributionKind    kind;
    std::vector<double> numbers; ///< two limits; mean and deviation; mean, deviation and two limits; values

    /// Default truncation of a normal distribution, in standard deviations from the mean.
    static constexpr double normal_end = 3.;
  };

  struct UncertainParameter
  {
    std::string  name; ///< name in the parameter file, as in Designs/Variables, or in the system file
    Distribution distribution;
    bool         is_relative  = false; ///< numbers are percentages of the nominal value
    bool         for_each_pin = false;
  };

  struct Correlation
  {
    std::string first, second;
    double      value; ///< correlation of the normal copula [-]
  };

  /// Variation of modes due to uncertain parameters (section `Robustness`).
  struct RobustnessParameters
  {
    std::string         distributions, correlations; ///< not yet parsed
    unsigned int        n_samples   = 2000;          ///< independent samples
    unsigned int        seed        = 1;
    double              tolerance   = 1e-4; ///< limit of the estimated |δλ| / |λ| at every sample [-]
    bool                has_indices = true; ///< compute Sobol' indices, which require additional samples
    std::vector<double> frequency_bands;    ///< limits of bands with separate probabilities [Hz]
    unsigned int        n_worst  = 5;       ///< number of worst samples written as parameter files
    unsigned int        n_onsets = 0;       ///< number of samples whose modes are tracked over the sweep

    void declare(Declarations &declarations);

    /// Parse Robustness/Distributions and Robustness/Correlations; throw ParameterError for invalid entries.
    std::vector<UncertainParameter> uncertain_parameters() const;
    std::vector<Correlation>        parsed_correlations() const;
  };
} // namespace Squeal
