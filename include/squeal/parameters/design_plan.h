// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/parameters/parameters.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Designs by the values of their variables.
  struct DesignPlan
  {
    std::vector<std::string>              names;   ///< of variables: "Section/Name", "Section/Name[k]", several joined by "+"
    std::vector<std::vector<std::string>> designs; ///< a value of each variable; empty: as the scene has it

    std::string              where_names; ///< parameter, or file and line, for messages
    std::vector<std::string> where;       ///< of each design of a file; empty: where the names are
  };

  /// A parameter that varies: a list of values, or a range.
  struct DesignVariable
  {
    std::string              name;
    std::vector<std::string> levels;
    double                   first = 0., last = 0.; ///< of a range
    bool                     is_range = false, by_ratio = false;

    /// The value at a part t in [0, 1] of the range, or of the list.
    std::string at(double t) const;
  };

  /// The variables that the section `Designs` names. Throws ParameterError.
  std::vector<DesignVariable> design_variables(const DesignParameters &designs);

  /// The first @p n points of Sobol's sequence in the unit cube, a row each, shifted as design_plan() says.
  std::vector<std::vector<double>> sobol_points(std::size_t n, std::size_t dimension, unsigned int seed);

  /**
   * The designs that the section `Designs` asks for. The same on every process and machine for the same parameters.
   *
   * Latin hypercube (M. D. McKay, R. J. Beckman, W. J. Conover 1979): of n equal parts of every range each has one sample, at a random
   * place. Sobol's sequence (I. M. Sobol 1967), with all samples shifted by one random vector modulo 1 (R. Cranley, T. N. L. Patterson
   * 1976) unless the seed is 0. A list of n values is a range of n equal parts.
   *
   * Throws ParameterError where the variables or the file are not as the section says or set a number twice, FileError if the file
   * cannot be read.
   */
  DesignPlan design_plan(const Parameters &parameters);

  /// The plan as a CSV file that Designs/Plan = file reads.
  std::string as_csv(const DesignPlan &plan);

  /// The scene of a design, unchecked: @p parameters with the values of the variables. Throws ParameterError where there is no such
  /// parameter, naming the nearest, or where it refuses a value.
  Parameters with_design(const Parameters &parameters, const std::vector<std::string> &names, const std::vector<std::string> &values);

  /// The value that a variable has in a scene: that of the first of its parameters. Throws ParameterError as with_design() does.
  std::string current_value(const Parameters &parameters, const std::string &name);

  /// The k-th number of @p text, counted from one; digits of names are no numbers. Throws ParameterError if there are fewer.
  std::string number_of(const std::string &text, unsigned int k);

  /// @p text with another k-th number, counted from one; digits of names are no numbers. Throws ParameterError if there are fewer.
  std::string with_number(const std::string &text, unsigned int k, const std::string &value);

  /// Where the file of designs is: beside the parameter file, or in the current directory; empty where the designs come from none.
  std::string designs_file(const Parameters &parameters);

  /// The designs of the CSV file that Designs/File names: names of the variables in its first line, a design in each of the others. Throws
  /// FileError if it cannot be read, ParameterError with the line if it is no comma-separated text in UTF-8.
  DesignPlan read_design_file(const Parameters &parameters);
} // namespace Squeal
