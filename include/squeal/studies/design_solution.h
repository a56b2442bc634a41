#pragma once

#include <squeal/studies/design_results.h>
#include <squeal/studies/reference_modes.h>

#include <string>

namespace Squeal
{
  /**
   * Follows the modes of a scene over the friction coefficients of the sweep, and says what a study of designs wants to know of them.
   *
   * @param parameters of the design
   * @param reference  names its modes
   * @param folder     keeps what has been found, until the design is solved
   * @param run        of which this is a part
   *
   * Throws Error where the design cannot be meshed or solved.
   */
  DesignResult solve_design(const Parameters &parameters, const ReferenceModes &reference, const std::string &folder, Run &run);
} // namespace Squeal
