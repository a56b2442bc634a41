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
