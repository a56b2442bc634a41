// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/parameters/declarations.h>

#include <string>

namespace Squeal
{
  /// A fit of parameters to measured modes (section `Updating`), within the ranges of Designs/Variables.
  struct UpdatingParameters
  {
    std::string  measured_modes;       ///< CSV: modes with their frequencies and damping ratios
    std::string  sensors;              ///< CSV: positions and directions of sensors, and measured shapes; empty: modes are paired by labels
    double       tolerance     = 1e-8; ///< step size at which the fit ends, fraction of each range [-]
    double       least_overlap = 0.5;  ///< MAC below which a shape has no counterpart [-]
    unsigned int n_iterations  = 50;

    void declare(Declarations &declarations);
  };
} // namespace Squeal
