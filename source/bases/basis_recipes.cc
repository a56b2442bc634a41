// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/bases/basis_recipes.h>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    using In     = BasisIngredients;
    using Source = BasisSource;

    /// Response to low-rank friction, or to all nonsymmetric stiffness terms if some are not of low rank.
    MultiVector response(const In &in, const Side side)
    {
      std::vector<Term> nonsymmetric;
      for (const Term &term : in.coupled->terms)
        if (term.power == 0 && !term.is_frictionless())
          nonsymmetric.push_back(term);
      if (std::any_of(nonsymmetric.begin(), nonsymmetric.end(), [](const Term &term) { return term.matrix != nullptr; }))
        return in.inverse->solve_frictionless(
          times(nonsymmetric, in.coupled->at(in.friction_coefficient), 0, *in.set(Source::real), side == Side::left));
      return friction_response(*in.coupled, *in.inverse, *in.set(Source::real), side);
    }

    // ------------------------------------------------------- sets of the input

    const BasisPart disc_free    = {"Phi_f^D", {Source::disc_free}, Source::disc_free, true};
    const BasisPart disc_sliding = {"Phi_s^D", {Source::disc_sliding}, Source::disc_sliding, true};
    const BasisPart pins_free    = {"Phi_f^P", {Source::pins_free}, Source::pins_free, true};
    const BasisPart pins_sliding = {"Phi_s^P", {Source::pins_sliding}, Source::pins_sliding, true};

    const BasisPart real      = {"Phi_R", {Source::real, Source::coupled_factor}, Source::real};
    const BasisPart snapshots = {"complex modes at several mu",
                                 {Source::snapshots, Source::coupled_factor, Source::coupled_attachment},
                                 Source::snapshots};
    const BasisPart residuals = {"Phi_R and residuals K_c^-1 R_F, K_c^-1 L_F",
                                 {Source::real, Source::residuals, Source::coupled_factor},
                                 Source::residuals};

    // ------------------------- uncoupled vectors, one for each contact node

    const std::vector<Source> normal     = {Source::uncoupled_factor, Source::normal_attachment};
    const std::vector<Source> tangential = {Source::uncoupled_factor, Source::tangential_attachment};
    const std::vector<Source> both       = {Source::uncoupled_factor, Source::normal_attachment, Source::tangential_attachment};

    const BasisPart normal_attachment      = {"(Psi_an^D - Psi_an^P)", normal, {}, true, [](const In &in) {
                                           return in.static_modes->normal_attachment();
                                         }};
    const BasisPart normal_attachment_disc = {"Psi_an^D", normal, {}, true, [](const In &in) {
                                                return in.static_modes->normal_attachment(Component::disc);
                                              }};
    const BasisPart tangential_attachment  = {"(Psi_at^D - Psi_at^P)", tangential, {}, true, [](const In &in) {
                                               return in.static_modes->tangential_attachment();
                                             }};
    const BasisPart rubbing_attachment     = {"(Psi_amu^D - Psi_amu^P)", both, {}, true, [](const In &in) {
                                            return in.static_modes->rubbing_attachment(in.friction_coefficient);
                                          }};
    const BasisPart constraint_disc        = {"Psi_cn^D", {Source::constraint_disc}, {}, true, [](const In &in) {
                                         return in.static_modes->constraint(Component::disc);
                                       }};
    const BasisPart constraint_pins        = {"Psi_cn^P", {Source::constraint_pins}, {}, true, [](const In &in) {
                                         return in.static_modes->constraint(Component::pins);
                                       }};

    // ------------------------------------------- responses of the coupled system

    const std::vector<Source> factor = {Source::coupled_factor}, attachment = {Source::coupled_factor, Source::coupled_attachment};

    const BasisPart coupled_tangential_attachment = {"(Psi_cat^D - Psi_cat^P)", attachment, {}, false, [](const In &in) -> MultiVector {
                                                       return in.inverse->attachment_modes();
                                                     }};
    const BasisPart friction_right = {"Psi_Rmu", attachment, Source::real, false, [](const In &in) { return response(in, Side::right); }};
    const BasisPart friction_left  = {"K_c^-1 V_K^T A^T Phi_R", factor, Source::real, false,
                                      [](const In &in) { return response(in, Side::left); }};
    const BasisPart damping        = {"K_c^-1 C_c Phi_R", factor, Source::real, false, [](const In &in) {
                                 return damping_response(*in.coupled, *in.inverse, *in.set(Source::real), in.friction_coefficient);
                               }};
  } // namespace

  // -------------------------------------------------------------------- recipes

  const std::vector<BasisRecipe> &basis_recipes()
  {
    static const std::vector<BasisRecipe> table = {
      {"free", {&disc_free, &pins_free, &normal_attachment}, false},
      {"fixed", {&disc_sliding, &pins_sliding, &constraint_disc, &constraint_pins}, false},
      {"mixed", {&disc_free, &pins_sliding, &normal_attachment_disc, &constraint_pins}, false},
      {"free + t.a.m.", {&disc_free, &pins_free, &normal_attachment, &tangential_attachment}},
      {"free with r.a.m.", {&disc_free, &pins_free, &rubbing_attachment}},
      {"fixed + t.a.m.", {&disc_sliding, &pins_sliding, &constraint_disc, &constraint_pins, &tangential_attachment}},
      {"mixed + t.a.m.", {&disc_free, &pins_sliding, &normal_attachment_disc, &constraint_pins, &tangential_attachment}},
      {"real", {&real}},
      {"real + t.a.m.", {&real, &coupled_tangential_attachment}},
      {"real + 1st-ord.", {&real, &friction_right}},
      {"real + 1st-ord. two-sided", {&real, &friction_right, &friction_left}},
      {"real + 1st-ord. two-sided + damping", {&real, &friction_right, &friction_left, &damping}, true, true},
      {"POD", {&snapshots}, true, false, true},
      {"residual-grown", {&residuals}}};
    return table;
  }

  const BasisRecipe *find_recipe(const std::string &name)
  {
    const auto &all   = basis_recipes();
    const auto  found = std::find_if(all.begin(), all.end(), [&](const BasisRecipe &recipe) { return recipe.name == name; });
    return found == all.end() ? nullptr : &*found;
  }

  std::string BasisRecipe::columns() const
  {
    std::string text;
    for (const BasisPart *part : parts)
      text += (text.empty() ? "" : " ") + std::string(part->symbol);
    return text;
  }

  bool BasisRecipe::needs_contact_nodes() const
  {
    return std::any_of(parts.begin(), parts.end(), [](const BasisPart *part) { return !part->set; });
  }

  bool BasisRecipe::has_real_modes() const
  {
    return std::any_of(parts.begin(), parts.end(), [](const BasisPart *part) { return part->set == Source::real; });
  }

  bool BasisRecipe::rests_on(const BasisSource source) const
  {
    return std::any_of(parts.begin(), parts.end(), [source](const BasisPart *part) {
      return std::find(part->rests_on.begin(), part->rests_on.end(), source) != part->rests_on.end();
    });
  }
} // namespace Squeal
