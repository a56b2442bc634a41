#pragma once

#include <squeal/contact/coupled_system.h>
#include <squeal/system/term_families.h>

#include <vector>

namespace Squeal
{
  /// A coupled system that belongs to a family.
  struct SystemMember
  {
    CoupledSystem           system; ///< with the fewest terms
    std::vector<TermShares> shares; ///< what each of its terms is made of
  };

  /**
   * The system of a family of terms: bodies coupled as couple() does, each term with its own part in the reactions. Its mass and
   * stiffness, the parameter values with it, are those in the middle of the family.
   */
  CoupledSystem coupled_family(const TermFamily &bodies, const ContactOperators &contact, const ContactDamping &damping = {});

  /**
   * The member of a family of systems where the scales of terms have these @p values: terms of the same kind are summed. What is left
   * free are the friction coefficient and the damping of the contact.
   */
  SystemMember member_of(const CoupledSystem &family, const ParameterValues &values);
} // namespace Squeal
