// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/parameters/parameters.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Designs, defined by the values of their variables.
  struct DesignPlan
  {
    std::vector<std::string>              names;   ///< variables: "Section/Name" or "Section/Name[k]", or several of these joined by "+"
    std::vector<std::vector<std::string>> designs; ///< values of the variables for each design; an empty string means unchanged

    std::string              where_names; ///< source of the names for messages: parameter, or file and line
    std::vector<std::string> where;       ///< file and line of each design; empty: as where_names

    const std::string &where_is(const std::size_t design) const
    {
      return where.empty() ? where_names : where[design];
    }
  };

  inline constexpr const char *where_variables = "parameter Designs/Variables"; ///< source of variables, for messages

  /// A varied parameter with a list of values or a range.
  struct DesignVariable
  {
    std::string              name;
    std::vector<std::string> levels;
    double                   first = 0., last = 0.;
    bool                     is_range = false, by_ratio = false;

    /// Value at the fraction t in [0, 1] of the range or list.
    std::string at(double t) const;
  };

  /// Variables of the section `Designs`. Throws ParameterError.
  std::vector<DesignVariable> design_variables(const DesignParameters &designs);

  /// First @p n points of the Sobol sequence in the unit cube, one per row, shifted as in design_plan().
  std::vector<std::vector<double>> sobol_points(std::size_t n, std::size_t dimension, unsigned int seed);

  /**
   * Designs from the section `Designs`, identical on every process.
   *
   * Latin hypercube (M. D. McKay, R. J. Beckman, W. J. Conover 1979): each of n equal parts of every range contains one sample at a random
   * position. Sobol sequence (I. M. Sobol 1967), with all samples shifted by one random vector modulo 1 (R. Cranley, T. N. L. Patterson
   * 1976) unless the seed is 0. A list of n values is treated as a range of n equal parts.
   *
   * Throws ParameterError if the variables or the file are invalid or set a number twice, and FileError if the file cannot be read.
   */
  DesignPlan design_plan(const Parameters &parameters);

  /// The plan as a CSV file for Designs/Plan = file.
  std::string as_csv(const DesignPlan &plan);

  /// @p parameters with the values of a design, without a check of combinations. Throws a ParameterError that names @p where for an invalid
  /// value, and for an unknown parameter with the nearest known name.
  Parameters with_design(const Parameters               &parameters,
                         const std::vector<std::string> &names,
                         const std::vector<std::string> &values,
                         const std::string              &where = where_variables);

  /// Current value of the first parameter of a variable. Throws ParameterError as with_design() does.
  std::string current_value(const Parameters &parameters, const std::string &name, const std::string &where = where_variables);

  /// The k-th number in @p text, counted from one; digits in names do not count. Throws ParameterError if there are fewer numbers.
  std::string number_of(const std::string &text, unsigned int k, const std::string &where = where_variables);

  /// @p text with the number from number_of() replaced. Throws ParameterError if there are fewer numbers.
  std::string with_number(const std::string &text, unsigned int k, const std::string &value, const std::string &where = where_variables);

  /// Path of the file of designs: in the folder of the parameter file or in the current directory; empty unless Designs/Plan = file.
  std::string designs_file(const Parameters &parameters);

  /// Designs from the CSV file Designs/File: names of the variables in the first line, then one design per line. Throws the errors of
  /// read_csv().
  DesignPlan read_design_file(const Parameters &parameters);
} // namespace Squeal
