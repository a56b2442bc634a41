#include <squeal/bases/basis_recipes.h>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    using In     = BasisIngredients;
    using Counts = BasisCounts;
    using Source = BasisSource;

    using Compute = MultiVector (*)(const In &);

    MultiVector response(const In &in, const Side side)
    {
      return friction_response(*in.coupled, *in.inverse, *in.real, side);
    }

    // ----------------------------------------------------------- sets at hand

    const BasisPart disc_free    = {"Phi_f^D", &Counts::disc_free, {Source::disc_free}, true, &In::disc_free};
    const BasisPart disc_sliding = {"Phi_s^D", &Counts::disc_sliding, {Source::disc_sliding}, true, &In::disc_sliding};
    const BasisPart pins_free    = {"Phi_f^P", &Counts::pins_free, {Source::pins_free}, true, &In::pins_free};
    const BasisPart pins_sliding = {"Phi_s^P", &Counts::pins_sliding, {Source::pins_sliding}, true, &In::pins_sliding};

    BasisPart coupled_set(const char *symbol, int Counts::*count, const MultiVector *In::*set, std::vector<Source> rests_on)
    {
      rests_on.push_back(Source::coupled_factor);
      return {symbol, count, rests_on, false, set};
    }

    const BasisPart real      = coupled_set("Phi_R", &Counts::real, &In::real, {Source::real});
    const BasisPart snapshots = coupled_set("complex modes at several mu", &Counts::snapshots, &In::snapshots, {Source::snapshots});
    const BasisPart residuals =
      coupled_set("Phi_R and residuals K_c^-1 R_F, K_c^-1 L_F", &Counts::residuals, &In::residuals, {Source::real, Source::residuals});

    // ------------------------------------- one for each contact node, uncoupled

    BasisPart at_contact(const char *symbol, const std::vector<Source> &rests_on, const Compute compute)
    {
      return {symbol, &Counts::contact, rests_on, true, nullptr, compute};
    }

    const std::vector<Source> normal     = {Source::uncoupled_factor, Source::normal_attachment};
    const std::vector<Source> tangential = {Source::uncoupled_factor, Source::tangential_attachment};
    const std::vector<Source> both       = {Source::uncoupled_factor, Source::normal_attachment, Source::tangential_attachment};

    const BasisPart normal_attachment =
      at_contact("(Psi_an^D - Psi_an^P)", normal, [](const In &in) { return in.static_modes->normal_attachment(); });
    const BasisPart normal_attachment_disc =
      at_contact("Psi_an^D", normal, [](const In &in) { return in.static_modes->normal_attachment(Component::disc); });
    const BasisPart tangential_attachment =
      at_contact("(Psi_at^D - Psi_at^P)", tangential, [](const In &in) { return in.static_modes->tangential_attachment(); });
    const BasisPart rubbing_attachment = at_contact("(Psi_amu^D - Psi_amu^P)", both, [](const In &in) {
      return in.static_modes->rubbing_attachment(in.friction_coefficient);
    });
    const BasisPart constraint_disc =
      at_contact("Psi_cn^D", {Source::constraint_disc}, [](const In &in) { return in.static_modes->constraint(Component::disc); });
    const BasisPart constraint_pins =
      at_contact("Psi_cn^P", {Source::constraint_pins}, [](const In &in) { return in.static_modes->constraint(Component::pins); });

    // ------------------------------------------- responses of the coupled system

    BasisPart coupled_response(const char *symbol, int Counts::*count, const Compute compute)
    {
      return {symbol, count, {Source::coupled_factor}, false, nullptr, compute};
    }

    const BasisPart coupled_tangential_attachment =
      coupled_response("(Psi_cat^D - Psi_cat^P)", &Counts::contact, [](const In &in) -> MultiVector {
        return in.inverse->attachment_modes();
      });
    const BasisPart friction_right = coupled_response("Psi_Rmu", &Counts::real, [](const In &in) { return response(in, Side::right); });
    const BasisPart friction_left =
      coupled_response("K_c^-1 V_K^T A^T Phi_R", &Counts::real, [](const In &in) { return response(in, Side::left); });
    const BasisPart damping = coupled_response("K_c^-1 C_c Phi_R", &Counts::real, [](const In &in) {
      return damping_response(*in.coupled, *in.inverse, *in.real, in.friction_coefficient);
    });
  } // namespace

  // -------------------------------------------------------------------- recipes

  const std::vector<BasisRecipe> &basis_recipes()
  {
    using Kind                                  = BasisKind;
    static const std::vector<BasisRecipe> table = {
      {Kind::free, "free", {&disc_free, &pins_free, &normal_attachment}, false},
      {Kind::fixed, "fixed", {&disc_sliding, &pins_sliding, &constraint_disc, &constraint_pins}, false},
      {Kind::mixed, "mixed", {&disc_free, &pins_sliding, &normal_attachment_disc, &constraint_pins}, false},
      {Kind::free_tangential, "free + t.a.m.", {&disc_free, &pins_free, &normal_attachment, &tangential_attachment}},
      {Kind::free_rubbing, "free with r.a.m.", {&disc_free, &pins_free, &rubbing_attachment}},
      {Kind::fixed_tangential,
       "fixed + t.a.m.",
       {&disc_sliding, &pins_sliding, &constraint_disc, &constraint_pins, &tangential_attachment}},
      {Kind::mixed_tangential,
       "mixed + t.a.m.",
       {&disc_free, &pins_sliding, &normal_attachment_disc, &constraint_pins, &tangential_attachment}},
      {Kind::real, "real", {&real}},
      {Kind::real_tangential, "real + t.a.m.", {&real, &coupled_tangential_attachment}},
      {Kind::real_first_order, "real + 1st-ord.", {&real, &friction_right}},
      {Kind::real_two_sided, "real + 1st-ord. two-sided", {&real, &friction_right, &friction_left}},
      {Kind::real_two_sided_damped, "real + 1st-ord. two-sided + damping", {&real, &friction_right, &friction_left, &damping}, true, true},
      {Kind::pod, "POD", {&snapshots}},
      {Kind::residual_grown, "residual-grown", {&residuals}}};
    return table;
  }

  const BasisRecipe &recipe(const BasisKind kind)
  {
    const auto &all = basis_recipes();
    return *std::find_if(all.begin(), all.end(), [kind](const BasisRecipe &candidate) { return candidate.kind == kind; });
  }

  std::string to_string(const BasisKind kind)
  {
    return recipe(kind).name;
  }

  std::string BasisRecipe::columns() const
  {
    std::string text;
    for (const BasisPart *part : parts)
      text += (text.empty() ? "" : " ") + std::string(part->symbol);
    return text;
  }

  bool BasisRecipe::is_connected() const
  {
    return parts.front()->is_uncoupled;
  }

  bool BasisRecipe::rests_on(const BasisSource source) const
  {
    return std::any_of(parts.begin(), parts.end(), [source](const BasisPart *part) {
      return std::find(part->rests_on.begin(), part->rests_on.end(), source) != part->rests_on.end();
    });
  }
} // namespace Squeal
