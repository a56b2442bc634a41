#pragma once

#include <squeal/bases/basis_recipes.h>
#include <squeal/parameters/parameters.h>

#include <vector>

namespace Squeal
{
  /// What a study of reduced bases measures, and on which problem.
  struct ReductionPlan
  {
    std::vector<const BasisRecipe *> recipes;
    bool                             has_friction;               ///< complex modes; else real ones
    double                           friction_coefficient;       ///< 0 without friction
    double                           largest_circular_frequency; ///< end of the band [rad/s]

    /// Whether one of the bases rests on something.
    bool rests_on(BasisSource source) const;
  };

  /// Throws ParameterError if the parameters name a basis that is none, or one that does not fit the problem.
  ReductionPlan reduction_plan(const Parameters &parameters);

  /// When a study of reduced bases leaves parameters unused.
  std::vector<UsageRule> reduction_usage();
} // namespace Squeal
