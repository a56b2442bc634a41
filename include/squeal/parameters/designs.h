// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/parameters/declarations.h>

#include <string>

namespace Squeal
{
  /// How the designs of a study are chosen.
  enum class DesignChoice
  {
    full_grid,       ///< every level of every variable with every level of the others
    one_at_a_time,   ///< the scene as it is, then every level of each variable with the others as they are
    latin_hypercube, ///< as many equal parts of every range as there are designs, each met once
    sobol,           ///< I. M. Sobol's sequence, shifted at random
    file             ///< rows of a CSV file
  };

  template <>
  inline constexpr EnumName<DesignChoice> enum_table<DesignChoice>[] = {{DesignChoice::full_grid, "full grid"},
                                                                        {DesignChoice::one_at_a_time, "one at a time"},
                                                                        {DesignChoice::latin_hypercube, "Latin hypercube"},
                                                                        {DesignChoice::sobol, "Sobol sequence"},
                                                                        {DesignChoice::file, "file"}};

  /// The designs of a study (section `Designs`); design_plan() lists them.
  struct DesignParameters
  {
    DesignChoice choice = DesignChoice::full_grid;
    std::string  variables;        ///< parameters and their values, as written
    std::string  file;             ///< CSV
    unsigned int n_samples   = 20; ///< of a Latin hypercube or a Sobol sequence
    unsigned int seed        = 1;
    unsigned int n_processes = 0; ///< designs that are solved side by side; 0: one for each core

    bool is_sampled() const
    {
      return choice == DesignChoice::latin_hypercube || choice == DesignChoice::sobol;
    }

    void declare(Declarations &declarations);
  };

  /// What a search for designs makes as good as it can.
  enum class SearchGoal
  {
    onset,           ///< the smallest μ at which a divergence rate exceeds weak_divergence: as large as possible
    divergence_rate, ///< the largest divergence rate of the sweep: as small as possible
    probability,     ///< of squeal with uncertain parameters: as small as possible
    quantile         ///< of the largest divergence rate with uncertain parameters: as small as possible
  };

  template <>
  inline constexpr EnumName<SearchGoal> enum_table<SearchGoal>[] = {{SearchGoal::onset, "onset"},
                                                                    {SearchGoal::divergence_rate, "divergence rate"},
                                                                    {SearchGoal::probability, "probability"},
                                                                    {SearchGoal::quantile, "quantile"}};

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
    double       quantile      = 0.95;  ///< of the goal of that name [-]
    double       first_step    = 0.15;  ///< of the methods, part of each range [-]
    double       smallest_step = 0.002; ///< at which they end, part of each range [-]

    void declare(Declarations &declarations);

    /// Throws ParameterError.
    void check() const;
  };
} // namespace Squeal
