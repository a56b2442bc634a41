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
} // namespace Squeal
