#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/parameters/declarations.h>

namespace Squeal
{
  /// What a search for designs makes as good as it can.
  enum class SearchGoal
  {
    onset,          ///< the smallest μ at which a divergence rate exceeds weak_divergence: as large as possible
    divergence_rate ///< the largest divergence rate of the sweep: as small as possible
  };

  template <>
  inline constexpr EnumName<SearchGoal> enum_table<SearchGoal>[] = {{SearchGoal::onset, "onset"},
                                                                    {SearchGoal::divergence_rate, "divergence rate"}};

  /// Methods of NLopt that need no derivatives and keep within a box.
  enum class SearchMethod
  {
    subplex, ///< T. H. Rowan 1990: simplices in subspaces; takes kinks well
    cobyla,  ///< M. J. D. Powell 1994: linear models
    bobyqa   ///< M. J. D. Powell 2009: quadratic models
  };

  template <>
  inline constexpr EnumName<SearchMethod> enum_table<SearchMethod>[] = {{SearchMethod::subplex, "subplex"},
                                                                        {SearchMethod::cobyla, "COBYLA"},
                                                                        {SearchMethod::bobyqa, "BOBYQA"}};

  /// A search for a quiet design (section `Search`), in the ranges of Designs/Variables.
  struct SearchParameters
  {
    SearchGoal   goal          = SearchGoal::divergence_rate;
    SearchMethod method        = SearchMethod::subplex;
    unsigned int n_samples     = 10;    ///< of Sobol's sequence, before the methods start from the best of them
    unsigned int n_evaluations = 40;    ///< at most, with those samples
    double       first_step    = 0.15;  ///< of the methods, part of each range [-]
    double       smallest_step = 0.002; ///< at which they end, part of each range [-]

    void declare(Declarations &declarations);

    /// Throws ParameterError.
    void check() const;
  };
} // namespace Squeal
