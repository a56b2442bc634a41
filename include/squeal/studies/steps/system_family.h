// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/studies/steps/friction_modes.h>

namespace Squeal
{
  /// Text of the parameters in which coefficients of terms are replaced by one, or by zero if the term is missing: equal for models that
  /// share a mesh and its matrices.
  std::string text_without_coefficients(Parameters parameters);

  /// Factor and coefficient of a term, whose product is a scale, for each scale of a family.
  using FamilyScales = std::map<std::string, std::pair<double, Coefficient>>;

  /// Systems on one mesh that differ in the coefficients of their terms, with the modes of the averaged system.
  struct SystemFamily
  {
    TermFamily        terms;
    FrictionlessModes middle; ///< with the system of the family, including damping; real modes and factor are undamped
    FamilyScales      scales;

    /// Scales of a member at other parameter values of the bodies. Valid only if the members that define the family vary all these
    /// parameters independently, because terms with proportional coefficients share a scale.
    ParameterValues member(const ParameterValues &values) const;
  };

  /**
   * Family of systems with the values of @p members, and the real modes of the averaged system, as steps of the run.
   *
   * @param bodies        terms of the assembled model
   * @param linearisation contact and its damping
   * @param margin        relative margin of the real modes above the band [-]
   */
  SystemFamily system_family(const BodyTerms                    &bodies,
                             const std::vector<ParameterValues> &members,
                             Linearisation                       linearisation,
                             double                              margin,
                             Run                                &run);
} // namespace Squeal
