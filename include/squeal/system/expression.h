// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/system/terms.h>

#include <string>
#include <vector>

namespace Squeal
{
  /**
   * θ(p) from a muParser expression in named parameters, such as `mu*omega^2` or `1/(a + b)`. Products of numbers and powers of parameters
   * become monomials with exact derivatives; other expressions are differentiated by sixth-order central differences.
   *
   * Throws ParameterError with the message of muParser if the expression cannot be parsed or contains an unknown parameter.
   */
  Coefficient parsed_coefficient(const std::string &expression, const std::vector<std::string> &parameters);

  /// True if a string is a valid parameter name in expressions.
  bool is_parameter_name(const std::string &text);
} // namespace Squeal
