#pragma once

#include <squeal/studies/designs/design_family.h>
#include <squeal/studies/designs/design_results.h>
#include <squeal/studies/steps/reference_modes.h>

#include <string>

namespace Squeal
{
  /// The sweep of a design: what only adds to the results of a single run is left out.
  Parameters sweep_of(const Parameters &design);

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

  /// The same of a design of a family.
  DesignResult solve_member(DesignFamily &family, std::size_t design, const ReferenceModes &reference);
} // namespace Squeal
