#include <squeal/base/exceptions.h>
#include <squeal/bases/basis_recipes.h>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    using In     = BasisIngredients;
    using Counts = BasisCounts;
    using Source = BasisSource;

    /// @p pointer, or an error that names what it should point to.
    template <typename Type>
    const Type &required(const Type *pointer, const std::string &basis, const std::string &what, const std::string &change)
    {
      if (pointer == nullptr)
        throw SolverError("the basis needs " + what + ", which is missing or empty", "reduced basis `" + basis + "`", change);
      return *pointer;
    }

    const MultiVector &modes(const MultiVector *set, const std::string &basis, const char *symbol)
    {
      return required(set, basis, symbol, "compute these modes, up to a higher frequency if none was found");
    }

    const MultiVector &real_modes(const In &in, const std::string &basis)
    {
      return modes(in.real, basis, "Phi_R");
    }

    const StaticModes &statics(const In &in, const std::string &basis)
    {
      return required(in.static_modes, basis, "static modes of the bodies", "pass a StaticModes");
    }

    const CoupledSystem &coupled(const In &in, const std::string &basis)
    {
      return required(in.coupled, basis, "the coupled system", "pass it");
    }

    const UpdatedInverse &inverse(const In &in, const std::string &basis)
    {
      return required(in.inverse, basis, "the inverse of the coupled stiffness", "pass an UpdatedInverse");
    }

    // --------------------------------------------------------- uncoupled bodies

    const BasisPart disc_free = {
      "Phi_f^D",
      [](const In &in, const std::string &basis) -> MultiVector { return modes(in.disc_free, basis, "Phi_f^D"); },
      &Counts::disc_free,
      {Source::disc_free},
      true};

    const BasisPart disc_sliding = {
      "Phi_s^D",
      [](const In &in, const std::string &basis) -> MultiVector { return modes(in.disc_sliding, basis, "Phi_s^D"); },
      &Counts::disc_sliding,
      {Source::disc_sliding},
      true};

    const BasisPart pins_free = {
      "Phi_f^P",
      [](const In &in, const std::string &basis) -> MultiVector { return modes(in.pins_free, basis, "Phi_f^P"); },
      &Counts::pins_free,
      {Source::pins_free},
      true};

    const BasisPart pins_sliding = {
      "Phi_s^P",
      [](const In &in, const std::string &basis) -> MultiVector { return modes(in.pins_sliding, basis, "Phi_s^P"); },
      &Counts::pins_sliding,
      {Source::pins_sliding},
      true};

    const BasisPart normal_attachment = {"(Psi_an^D - Psi_an^P)",
                                         [](const In &in, const std::string &basis) { return statics(in, basis).normal_attachment(); },
                                         &Counts::contact,
                                         {Source::uncoupled_factor, Source::normal_attachment},
                                         true};

    const BasisPart normal_attachment_disc = {
      "Psi_an^D",
      [](const In &in, const std::string &basis) { return statics(in, basis).normal_attachment(Component::disc); },
      &Counts::contact,
      {Source::uncoupled_factor, Source::normal_attachment},
      true};

    const BasisPart tangential_attachment = {
      "(Psi_at^D - Psi_at^P)",
      [](const In &in, const std::string &basis) { return statics(in, basis).tangential_attachment(); },
      &Counts::contact,
      {Source::uncoupled_factor, Source::tangential_attachment},
      true};

    const BasisPart rubbing_attachment = {
      "(Psi_amu^D - Psi_amu^P)",
      [](const In &in, const std::string &basis) { return statics(in, basis).rubbing_attachment(in.friction_coefficient); },
      &Counts::contact,
      {Source::uncoupled_factor, Source::normal_attachment, Source::tangential_attachment},
      true};

    const BasisPart constraint_disc = {
      "Psi_cn^D",
      [](const In &in, const std::string &basis) { return statics(in, basis).constraint(Component::disc); },
      &Counts::contact,
      {Source::constraint_disc},
      true};

    const BasisPart constraint_pins = {
      "Psi_cn^P",
      [](const In &in, const std::string &basis) { return statics(in, basis).constraint(Component::pins); },
      &Counts::contact,
      {Source::constraint_pins},
      true};

    // ----------------------------------------------------------- coupled system

    const BasisPart real = {"Phi_R",
                            [](const In &in, const std::string &basis) -> MultiVector { return real_modes(in, basis); },
                            &Counts::real,
                            {Source::coupled_factor, Source::real}};

    const BasisPart coupled_tangential_attachment = {
      "(Psi_cat^D - Psi_cat^P)",
      [](const In &in, const std::string &basis) -> MultiVector { return inverse(in, basis).attachment_modes(); },
      &Counts::contact,
      {Source::coupled_factor}};

    const BasisPart friction_right = {"Psi_Rmu",
                                      [](const In &in, const std::string &basis) {
                                        return friction_response(coupled(in, basis), inverse(in, basis), real_modes(in, basis),
                                                                 Side::right);
                                      },
                                      &Counts::real,
                                      {}};

    const BasisPart friction_left = {"K_c^-1 V_K^T A^T Phi_R",
                                     [](const In &in, const std::string &basis) {
                                       return friction_response(coupled(in, basis), inverse(in, basis), real_modes(in, basis), Side::left);
                                     },
                                     &Counts::real,
                                     {}};

    const BasisPart damping = {"K_c^-1 C_c Phi_R",
                               [](const In &in, const std::string &basis) {
                                 return damping_response(coupled(in, basis), inverse(in, basis), real_modes(in, basis),
                                                         in.friction_coefficient);
                               },
                               &Counts::real,
                               {}};

    const BasisPart snapshots = {"complex modes at several mu",
                                 [](const In &in, const std::string &basis) -> MultiVector {
                                   return required(in.snapshots, basis, "complex modes", "compute them at some friction coefficients");
                                 },
                                 &Counts::snapshots,
                                 {Source::coupled_factor, Source::snapshots}};

    const BasisPart residuals = {"Phi_R and residuals K_c^-1 R_F, K_c^-1 L_F",
                                 [](const In &in, const std::string &basis) -> MultiVector {
                                   return required(in.residuals, basis, "vectors grown by residuals", "grow them first");
                                 },
                                 &Counts::residuals,
                                 {Source::coupled_factor, Source::real, Source::residuals}};
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
