// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/parameters/declarations.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Eigenproblem on which reduced bases are compared.
  enum class ReductionProblem
  {
    frictionless, ///< real coupled modes (section 5 of the paper)
    friction      ///< complex modes at Operation/Friction coefficient (section 6)
  };

  template <>
  inline constexpr EnumName<ReductionProblem> enum_table<ReductionProblem>[] = {{ReductionProblem::frictionless, "frictionless"},
                                                                                {ReductionProblem::friction, "friction"}};

  /// Number of component modes in a basis: all modes up to a frequency, or given numbers of modes.
  struct ModeTruncation
  {
    double frequency    = 0.; ///< [Hz]; 0: use the numbers
    int    disc         = 0;
    int    pins_free    = 0; ///< free modes of all pins together
    int    pins_sliding = 0; ///< sliding modes of all pins together

    /// "10000 Hz" or "80/120/60".
    std::string text() const;
  };

  /// Reduced bases and their comparison (section `Reduction`).
  struct ReductionParameters
  {
    std::vector<std::string>    bases; ///< names of the bases; empty: all bases for the eigenproblem
    ReductionProblem            problem             = ReductionProblem::friction;
    std::vector<ModeTruncation> truncations         = {{10000., 0, 0, 0}};
    std::vector<double>         coupled_frequencies = {0.};  ///< upper limits of the sets of real coupled modes [Hz]; 0: end of the band
    double                      rank_tolerance      = 1e-10; ///< [-]
    std::vector<double>         grown_tolerances    = {1e-4, 1e-6};       ///< tolerances of residual-grown bases: estimated |δλ|/|λ| [-]
    std::vector<double>         snapshots           = {0.05, 0.25, 0.45}; ///< friction coefficients of the complex modes in the POD basis
    double                      pod_tolerance       = 1e-4;               ///< [-]

    void declare(Declarations &declarations);

    /// Checks parameters for a mesh. Throws ParameterError.
    void check() const;

    /// Checks parameters for a system file. Throws ParameterError.
    void check_of_system() const;
  };
} // namespace Squeal
