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
  /// Quantities from which bases are built. The cost of a basis includes the cost of the quantities that it uses.
  enum class BasisSource
  {
    disc_free,    ///< Φ_f^D, n_uncoupled × k, truncated as requested
    disc_sliding, ///< Φ_s^D
    pins_free,    ///< Φ_f^P
    pins_sliding, ///< Φ_s^P
    real,         ///< Φ_R, n × n_R
    snapshots,    ///< real and imaginary parts of complex modes, n × k, φᴴ M_c φ = 1
    residuals,    ///< basis enriched by residuals, n × k
    normal_attachment,
    tangential_attachment,
    constraint_disc,
    constraint_pins,
    coupled_attachment, ///< K_c⁻¹ A
    uncoupled_factor,   ///< factor of K, uncoupled bodies
    coupled_factor      ///< factor of K_c, coupled system
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

  /// Numbers of vectors in the parts of a basis.
  struct BasisCounts
  {
    std::map<BasisSource, int> sets;
    int                        rigid_body = 0; ///< rigid-body motions of a free disc that are not among its modes
    int                        contact    = 0; ///< n_c
  };

  /// Input of reduced_basis(). Objects that a basis does not need may be null; pointers need to be valid only during the call.
  struct BasisIngredients
  {
    std::map<BasisSource, const MultiVector *> sets; ///< sets of modes or vectors

    const StaticModes       *static_modes = nullptr; ///< static modes of the uncoupled bodies
    const SecondOrderSystem *uncoupled    = nullptr; ///< for connected bases
    const ContactOperators  *contact      = nullptr; ///< for connected bases
    const CoupledSystem     *coupled      = nullptr;
    const UpdatedInverse    *inverse      = nullptr; ///< for responses of the coupled system

    double friction_coefficient = 0.; ///< μ of the rubbing attachment modes and of the response to damping

    /// The set of this source; null if it is missing.
    const MultiVector *set(const BasisSource source) const
    {
      const auto found = sets.find(source);
      return found == sets.end() ? nullptr : found->second;
    }
  };

  /// A block of basis vectors: a set from the input, or computed responses.
  struct BasisPart
  {
    const char              *symbol;
    std::vector<BasisSource> rests_on; ///< quantities that must be computed beforehand
    std::optional<BasisSource>
         set;                  ///< input set: the vectors themselves, or modes with one response each; none: one vector per contact node
    bool is_uncoupled = false; ///< the vectors are defined on the uncoupled dofs

    MultiVector (*compute)(const BasisIngredients &ingredients) = nullptr; ///< null: use the set itself
  };

  /// Recipe of a reduced basis: its parts, and the kinds of system to which it applies.
  struct BasisRecipe
  {
    const char                    *name;
    std::vector<const BasisPart *> parts; ///< columns of T_r0, from left to right
    bool                           needs_friction = true;
    bool                           needs_damping  = false;
    bool                           is_pod         = false; ///< true: principal axes of the columns (POD); false: all independent columns

    /// Symbols of the parts: "Phi_f^D Phi_f^P (Psi_an^D - Psi_an^P)".
    std::string columns() const;

    /// True if the columns are defined on the uncoupled dofs and are connected by eq. (22); other bases have columns in coupled
    /// coordinates.
    bool is_connected() const
    {
      return parts.front()->is_uncoupled;
    }

    /// True if some columns belong to contact nodes instead of modes.
    bool needs_contact_nodes() const;

    /// True if the columns include real coupled modes.
    bool has_real_modes() const;

    bool rests_on(BasisSource source) const;
  };

  /// All bases: first the bases of tables 2, 4 and 5 of the paper, then additional bases.
  const std::vector<BasisRecipe> &basis_recipes();

  /// Basis with this name; null if there is none.
  const BasisRecipe *find_recipe(const std::string &name);
} // namespace Squeal
