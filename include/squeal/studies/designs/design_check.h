#pragma once

#include <squeal/parameters/design_plan.h>
#include <squeal/studies/steps/parameter_usage.h>

namespace Squeal
{
  /// Variables of a plan that change nothing in what its designs are, with the reason. Throws ParameterError as with_design() does.
  std::vector<UnusedParameter> unused_variables(const Parameters &parameters, const DesignPlan &plan);

  /**
   * Throws ParameterError if a variable is no parameter; if it changes nothing, so that designs are equal that are written differently;
   * if a value is refused both with all others as they are and in every design that has it. Values that only together make no sense
   * are told in the rows of their designs.
   */
  void check_designs(const Parameters &parameters, const DesignPlan &plan);

  /// The same for a search in ranges, of which only the ends are checked, and only by their own bounds.
  void check_ranges(const Parameters &parameters, const std::vector<DesignVariable> &variables);
} // namespace Squeal
