// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/system/terms.h>

#include <string>
#include <vector>

namespace Squeal
{
  /**
   * θ(p) from an expression of muParser in named parameters, such as `mu*omega^2` or `1/(a + b)`. Products of numbers and of powers of
   * parameters become monomials, which have exact derivatives; all others have central differences of sixth order.
   *
   * Throws ParameterError with the message of muParser if the expression cannot be parsed or contains an unknown parameter.
   */
  Coefficient parsed_coefficient(const std::string &expression, const std::vector<std::string> &parameters);

  /// Whether a text may be the name of a parameter in an expression.
  bool is_parameter_name(const std::string &text);
} // namespace Squeal
