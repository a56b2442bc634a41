#pragma once

#include <squeal/base/text.h>

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

namespace Squeal
{
  /**
   * Declares a number and binds it to @p value. Unlike deal.II's add_parameter(),
   * which prints six digits, it is printed so that it reads back unchanged: the
   * parameter file that a run leaves behind repeats that run.
   */
  void add_number_parameter(dealii::ParameterHandler            &prm,
                            const std::string                   &name,
                            double                              &value,
                            const std::string                   &documentation,
                            const dealii::Patterns::PatternBase &pattern);

  /// The same for a list of numbers, separated by commas.
  void add_number_parameter(dealii::ParameterHandler            &prm,
                            const std::string                   &name,
                            std::vector<double>                 &values,
                            const std::string                   &documentation,
                            const dealii::Patterns::PatternBase &pattern);
} // namespace Squeal
