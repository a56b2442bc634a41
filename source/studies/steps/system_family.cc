// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/studies/steps/system_family.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Squeal
{
  namespace
  {
    /// Placeholder for a coefficient: one, or zero if that part of the model is missing.
    double presence(const double coefficient)
    {
      return coefficient == 0. ? 0. : 1.;
    }
  } // namespace

  std::string text_without_coefficients(Parameters parameters)
  {
    std::ostringstream stream;
    for (Material *material : parameters.materials.each())
      {
        if (Orthotropy *o = material->orthotropy ? &*material->orthotropy : nullptr)
          for (double *modulus : {&o->E2, &o->E3, &o->G12, &o->G13, &o->G23})
            *modulus = std::round(1e12 * *modulus / material->young_modulus); // removes rounding errors of the ratio
        material->young_modulus = material->density = 1.;
        for (double *damping : {&material->rayleigh_alpha, &material->rayleigh_beta})
          {
            stream << presence(*damping) << ' ';
            *damping = 0.;
          }
      }
    for (double *value : parameters.materials.mount_values())
      *value = presence(*value);
    OperationParameters &operation = parameters.operation;
    operation.load_per_side        = presence(operation.load_per_side);
    operation.friction_slope       = presence(operation.friction_slope);
    operation.friction_coefficient = operation.rotation_speed = 1.;
    parameters.print(stream, false);
    return stream.str();
  }

  SystemFamily system_family(const BodyTerms                    &bodies,
                             const std::vector<ParameterValues> &members,
                             Linearisation                       linearisation,
                             const double                        margin,
                             Run                                &run)
  {
    SystemFamily result;
    result.terms               = term_family(bodies.terms, members);
    const CoupledSystem system = coupled_family(result.terms, linearisation.contact, linearisation.damping);
    linearisation.coupled      = undamped(system);
    result.middle              = frictionless_modes(linearisation, run, margin);

    result.middle.linearisation.coupled = system;
    for (const Term &merged : result.terms.terms)
      for (const auto &[scale, ones] : result.terms.values)
        if (merged.coefficient.contains(scale))
          {
            const Term &first = *std::find_if(bodies.terms.begin(), bodies.terms.end(),
                                              [&](const Term &term) { return term.name == merged.name && term.power == merged.power; });
            for (std::size_t m = 0; m < members.size(); ++m)
              if (const double coefficient = first.coefficient.at(members[m]); coefficient != 0.)
                {
                  result.scales[scale] = {result.terms.members[m].at(scale).front() / coefficient, first.coefficient};
                  break;
                }
          }
    return result;
  }

  ParameterValues SystemFamily::member(const ParameterValues &values) const
  {
    ParameterValues result;
    for (const auto &[name, scale] : scales)
      result[name] = {scale.first * scale.second.at(values)};
    return result;
  }
} // namespace Squeal
