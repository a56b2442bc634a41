// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/studies/steps/friction_modes.h>

namespace Squeal
{
  /// The parameters as text with ones in the place of those that are only coefficients of terms, or zeros where a term is missing: equal
  /// for scenes that share a mesh and its matrices.
  std::string text_without_coefficients(Parameters parameters);

  /// Systems on one mesh that differ in the coefficients of their terms, with the modes of the one in their middle.
  struct SystemFamily
  {
    TermFamily        terms;
    FrictionlessModes middle; ///< with the system of the family, damping included; real modes and factor know of none

    /// A scale as a multiple of the coefficient of a term, by its name.
    std::map<std::string, std::pair<double, Coefficient>> scales;

    /// The scales of a member with other values of the bodies' parameters. Right if those of which the family was made vary all that
    /// varies, independently: terms that kept their ratios there must keep them.
    ParameterValues member(const ParameterValues &values) const;
  };

  /**
   * The family of the values of @p members, with its real modes as steps of the run.
   *
   * @param bodies        terms of the assembled scene
   * @param linearisation contact and its damping
   * @param margin        part of the band by which real modes go beyond it
   */
  SystemFamily system_family(const BodyTerms                    &bodies,
                             const std::vector<ParameterValues> &members,
                             Linearisation                       linearisation,
                             double                              margin,
                             Run                                &run);
} // namespace Squeal
