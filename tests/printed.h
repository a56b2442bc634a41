// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/parameters/parameters.h>

#include <sstream>
#include <string>

namespace Squeal::Testing
{
  /// All parameters as a parameter file.
  inline std::string printed(const Parameters &parameters)
  {
    std::ostringstream stream;
    parameters.print(stream, false);
    return stream.str();
  }
} // namespace Squeal::Testing
