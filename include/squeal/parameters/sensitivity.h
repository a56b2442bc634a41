#pragma once

#include <squeal/parameters/declarations.h>

namespace Squeal
{
  /// Of what `Study = sensitivity` gives derivatives, and how accurately (section `Sensitivity`).
  struct SensitivityParameters
  {
    unsigned int modes      = 10;   ///< most modes with derivatives
    bool         thresholds = true; ///< whether thresholds have derivatives, too
    double       tolerance  = 1e-4; ///< change of a derivative by the last growth of the basis, over the largest one of the mode [-]

    void declare(Declarations &declarations);
  };
} // namespace Squeal
