// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/parameters/declarations.h>

#include <string>

namespace Squeal
{
  enum class DesignChoice
  {
    full_grid,
    one_at_a_time,   ///< the given model, then every level of each variable with the other variables unchanged
    latin_hypercube, ///< one sample in each of n equal parts of every range
    sobol,           ///< Sobol sequence, shifted at random unless the seed is 0
    file             ///< rows of a CSV file
  };

  template <>
  inline constexpr EnumName<DesignChoice> enum_table<DesignChoice>[] = {{DesignChoice::full_grid, "full grid"},
                                                                        {DesignChoice::one_at_a_time, "one at a time"},
                                                                        {DesignChoice::latin_hypercube, "Latin hypercube"},
                                                                        {DesignChoice::sobol, "Sobol sequence"},
                                                                        {DesignChoice::file, "file"}};

  /// Designs of a study (section `Designs`); listed by design_plan().
  struct DesignParameters
  {
    DesignChoice choice = DesignChoice::full_grid;
    std::string  variables; ///< parameters and their values, not yet parsed
    std::string  file;
    unsigned int n_samples   = 20; ///< number of samples of a Latin hypercube or a Sobol sequence
    unsigned int seed        = 1;
    unsigned int n_processes = 0; ///< designs that each MPI process solves concurrently; 0: limited by cores and memory

    bool is_sampled() const
    {
      return choice == DesignChoice::latin_hypercube || choice == DesignChoice::sobol;
    }

    void declare(Declarations &declarations);
  };

  enum class SearchGoal
  {
    onset,           ///< maximise the smallest μ at which a divergence rate exceeds weak_divergence
    divergence_rate, ///< minimise the largest divergence rate of the sweep
    probability,     ///< minimise the probability of squeal with uncertain parameters
    quantile         ///< minimise a quantile of the largest divergence rate with uncertain parameters
  };

  template <>
  inline constexpr EnumName<SearchGoal> enum_table<SearchGoal>[] = {{SearchGoal::onset, "onset"},
                                                                    {SearchGoal::divergence_rate, "divergence rate"},
                                                                    {SearchGoal::probability, "probability"},
                                                                    {SearchGoal::quantile, "quantile"}};

  /// Derivative-free methods of NLopt with bounds.
  enum class SearchMethod
  {
    subplex, ///< T. H. Rowan 1990: simplices in subspaces; robust for nonsmooth objectives
    cobyla,  ///< M. J. D. Powell 1994: linear models
    bobyqa   ///< M. J. D. Powell 2009: quadratic models
  };

  template <>
  inline constexpr EnumName<SearchMethod> enum_table<SearchMethod>[] = {{SearchMethod::subplex, "subplex"},
                                                                        {SearchMethod::cobyla, "COBYLA"},
                                                                        {SearchMethod::bobyqa, "BOBYQA"}};

  /// Search for a quiet design within the ranges of Designs/Variables (section `Search`).
  struct SearchParameters
  {
    SearchGoal   goal          = SearchGoal::divergence_rate;
    SearchMethod method        = SearchMethod::subplex;
    unsigned int n_samples     = 10;    ///< samples of the Sobol sequence; the method starts from the best two of them
    unsigned int n_evaluations = 40;    ///< maximum number of evaluations, including these samples
    double       quantile      = 0.95;  ///< level of the quantile for the goal quantile [-]
    double       first_step    = 0.15;  ///< initial step of the method, as a fraction of each range [-]
    double       smallest_step = 0.002; ///< step at which the method stops, as a fraction of each range [-]

    void declare(Declarations &declarations);

    /// Throws ParameterError.
    void check() const;
  };
} // namespace Squeal
