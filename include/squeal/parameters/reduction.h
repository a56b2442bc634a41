// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/parameters/declarations.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Which problem reduced bases are measured on.
  enum class ReductionProblem
  {
    frictionless, ///< real coupled modes (section 5 of the paper)
    friction      ///< complex modes at the friction coefficient of the operation (section 6)
  };

  template <>
  inline constexpr EnumName<ReductionProblem> enum_table<ReductionProblem>[] = {{ReductionProblem::frictionless, "frictionless"},
                                                                                {ReductionProblem::friction, "friction"}};

  /// How many component modes a basis gets: all up to a frequency, or given numbers of the lowest.
  struct ModeTruncation
  {
    double frequency    = 0.; ///< [Hz]; 0: by the numbers
    int    disc         = 0;  ///< modes of the disc, free or sliding
    int    pins_free    = 0;  ///< of all pins together
    int    pins_sliding = 0;  ///< of all pins together

    /// "10000 Hz" or "80/120/60".
    std::string text() const;
  };

  /// Reduced bases and how they are compared (section `Reduction`).
  struct ReductionParameters
  {
    std::vector<std::string>    bases; ///< names; empty: all that fit the problem
    ReductionProblem            problem             = ReductionProblem::friction;
    std::vector<ModeTruncation> truncations         = {{10000., 0, 0, 0}};
    std::vector<double>         coupled_frequencies = {0.};         ///< ends of the sets of real coupled modes [Hz]; 0: that of the band
    double                      rank_tolerance      = 1e-10;        ///< [-]
    std::vector<double>         grown_tolerances    = {1e-4, 1e-6}; ///< of residual-grown bases, on the estimated |δλ|/|λ| [-]
    std::vector<double>         snapshots           = {0.05, 0.25, 0.45}; ///< friction coefficients whose complex modes make the POD basis
    double                      pod_tolerance       = 1e-4;               ///< [-]

    void declare(Declarations &declarations);

    /// Of a mesh. Throws ParameterError.
    void check() const;

    /// Of a system file. Throws ParameterError.
    void check_of_system() const;
  };
} // namespace Squeal
