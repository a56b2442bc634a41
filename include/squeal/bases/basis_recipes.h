// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/bases/static_modes.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// What bases rest on, and what it costs to compute it.
  enum class BasisSource
  {
    disc_free,    ///< Φ_f^D, n_uncoupled × k, truncated as wanted
    disc_sliding, ///< Φ_s^D
    pins_free,    ///< Φ_f^P
    pins_sliding, ///< Φ_s^P
    real,         ///< Φ_R, n × n_R
    snapshots,    ///< real and imaginary parts of complex modes, n × k, φᴴ M_c φ = 1
    residuals,    ///< a basis grown by residuals, n × k
    normal_attachment,
    tangential_attachment,
    constraint_disc,
    constraint_pins,
    coupled_attachment, ///< K_c⁻¹ A
    uncoupled_factor,   ///< of K
    coupled_factor      ///< of K_c
  };

  template <>
  inline constexpr EnumName<BasisSource> enum_table<BasisSource>[] = {
    {BasisSource::disc_free, "free modes of the disc"},
    {BasisSource::disc_sliding, "sliding modes of the disc"},
    {BasisSource::pins_free, "free modes of the pins"},
    {BasisSource::pins_sliding, "sliding modes of the pins"},
    {BasisSource::real, "real coupled modes"},
    {BasisSource::snapshots, "complex modes of the snapshots"},
    {BasisSource::residuals, "growth by residuals"},
    {BasisSource::normal_attachment, "normal attachment modes"},
    {BasisSource::tangential_attachment, "tangential attachment modes"},
    {BasisSource::constraint_disc, "constraint modes of the disc"},
    {BasisSource::constraint_pins, "constraint modes of the pins"},
    {BasisSource::coupled_attachment, "coupled tangential attachment modes"},
    {BasisSource::uncoupled_factor, "factor of K"},
    {BasisSource::coupled_factor, "factor of K_c"}};

  /// Numbers of vectors that a basis is made of.
  struct BasisCounts
  {
    std::map<BasisSource, int> sets;
    int                        rigid_body = 0; ///< motions of a free disc that its modes do not contain
    int                        contact    = 0; ///< n_c
  };

  /// What bases are made from. What a basis does not need may be missing; what is pointed to must outlive the call only.
  struct BasisIngredients
  {
    std::map<BasisSource, const MultiVector *> sets; ///< of modes

    const StaticModes       *static_modes = nullptr; ///< of the uncoupled bodies
    const SecondOrderSystem *uncoupled    = nullptr; ///< for connected bases
    const ContactOperators  *contact      = nullptr; ///< for connected bases
    const CoupledSystem     *coupled      = nullptr;
    const UpdatedInverse    *inverse      = nullptr; ///< for responses of the coupled system

    double friction_coefficient = 0.; ///< μ of the rubbing attachment modes and of the response to damping

    /// Null if it is missing.
    const MultiVector *set(const BasisSource source) const
    {
      const auto found = sets.find(source);
      return found == sets.end() ? nullptr : found->second;
    }
  };

  /// Vectors that bases are made of: a set, or responses to be computed.
  struct BasisPart
  {
    const char                *symbol;
    std::vector<BasisSource>   rests_on; ///< what is computed beforehand
    std::optional<BasisSource> set;      ///< the vectors, or modes to each of which there is a response; else one per contact node
    bool                       is_uncoupled                     = false;   ///< whether the vectors are of the uncoupled bodies
    MultiVector (*compute)(const BasisIngredients &ingredients) = nullptr; ///< null: they are the set
  };

  /// A reduced basis: what it is made of, and for which problems.
  struct BasisRecipe
  {
    const char                    *name;
    std::vector<const BasisPart *> parts; ///< the columns of T_r0, from left to right
    bool                           needs_friction = true;
    bool                           needs_damping  = false;
    bool                           is_pod         = false; ///< the principal axes of the columns; else all that are independent

    /// The parts by their symbols: "Phi_f^D Phi_f^P (Psi_an^D - Psi_an^P)".
    std::string columns() const;

    /// Whether it is made on the uncoupled dofs and must be connected, eq. (22); the others have coupled columns.
    bool is_connected() const
    {
      return parts.front()->is_uncoupled;
    }

    /// Whether some of its columns belong to contact nodes instead of modes.
    bool needs_contact_nodes() const;

    /// Whether real coupled modes are among its columns.
    bool has_real_modes() const;

    bool rests_on(BasisSource source) const;
  };

  /// All bases: those of tables 2, 4 and 5 of the paper first, then what goes beyond them.
  const std::vector<BasisRecipe> &basis_recipes();

  /// The basis of that name; null if there is none.
  const BasisRecipe *find_recipe(const std::string &name);
} // namespace Squeal
