// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/parameters/declarations.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Distribution of an uncertain number.
  enum class DistributionKind
  {
    uniform,   ///< between two ends
    normal,    ///< of a mean and a standard deviation, cut off at two ends
    lognormal, ///< of a mean and a standard deviation
    table      ///< values of equal probability
  };

  template <>
  inline constexpr EnumName<DistributionKind> enum_table<DistributionKind>[] = {{DistributionKind::uniform, "uniform"},
                                                                                {DistributionKind::normal, "normal"},
                                                                                {DistributionKind::lognormal, "lognormal"},
                                                                                {DistributionKind::table, "table"}};

  struct Distribution
  {
    DistributionKind    kind;
    std::vector<double> numbers; ///< two ends; mean and deviation; these and two ends; values

    /// Where a normal distribution ends unless its numbers say so, in standard deviations from the mean.
    static constexpr double normal_end = 3.;
  };

  /// A parameter that is uncertain.
  struct UncertainParameter
  {
    std::string  name; ///< of the parameter file, as in Designs/Variables, or of the system file
    Distribution distribution;
    bool         is_relative  = false; ///< numbers are percent of the value that the parameter file gives
    bool         for_each_pin = false; ///< a value of its own for each pin, independent of the others
  };

  struct Correlation
  {
    std::string first, second; ///< names of uncertain parameters
    double      value;         ///< of the normal copula
  };

  /// How modes scatter with uncertain parameters (section `Robustness`).
  struct RobustnessParameters
  {
    std::string         distributions, correlations; ///< as written
    unsigned int        n_samples   = 2000;          ///< independent ones
    unsigned int        seed        = 1;
    double              tolerance   = 1e-4; ///< on the estimated |δλ| / |λ| at every sample [-]
    bool                has_indices = true; ///< Sobol' indices, for which there are more samples
    std::vector<double> frequency_bands;    ///< ends of bands with probabilities of their own [Hz]
    unsigned int        n_worst  = 5;       ///< samples written as parameter files
    unsigned int        n_onsets = 0;       ///< samples whose modes are followed over the friction coefficient

    void declare(Declarations &declarations);

    /// What Robustness/Distributions and Correlations say. Throw ParameterError.
    std::vector<UncertainParameter> uncertain_parameters() const;
    std::vector<Correlation>        parsed_correlations() const;
  };
} // namespace Squeal
