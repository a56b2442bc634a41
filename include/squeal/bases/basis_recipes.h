#pragma once

#include <squeal/bases/static_modes.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Reduced bases: tables 2, 4 and 5 of the paper, and what goes beyond them.
  enum class BasisKind
  {
    free,
    fixed,
    mixed,
    free_tangential,
    free_rubbing,
    fixed_tangential,
    mixed_tangential,
    real,
    real_tangential,
    real_first_order,
    real_two_sided,        ///< responses to friction of the right and of the left problem
    real_two_sided_damped, ///< and to damping
    pod,                   ///< principal axes of complex modes
    residual_grown         ///< by right and left residuals
  };

  /// Numbers of vectors in the sets that a basis is made of.
  struct BasisCounts
  {
    int disc_free = 0, disc_sliding = 0, pins_free = 0, pins_sliding = 0;
    int rigid_body = 0; ///< motions of a free disc that its modes do not contain
    int contact    = 0; ///< n_c
    int real       = 0; ///< n_R
    int snapshots  = 0;
    int residuals  = 0;
  };

  /**
   * What bases are made from. Sets of modes that a kind does not need may be
   * null; what is pointed to must outlive the call only.
   */
  struct BasisIngredients
  {
    const MultiVector *disc_free    = nullptr; ///< Φ_f^D, n_uncoupled × k, truncated as wanted
    const MultiVector *disc_sliding = nullptr; ///< Φ_s^D
    const MultiVector *pins_free    = nullptr; ///< Φ_f^P
    const MultiVector *pins_sliding = nullptr; ///< Φ_s^P
    const StaticModes *static_modes = nullptr; ///< of the uncoupled bodies
    const MultiVector *real         = nullptr; ///< Φ_R, n × n_R

    const SecondOrderSystem *uncoupled = nullptr; ///< for connected bases
    const ContactOperators  *contact   = nullptr; ///< for connected bases
    const CoupledSystem     *coupled   = nullptr;
    const UpdatedInverse    *inverse   = nullptr; ///< for responses of the coupled system

    const MultiVector *snapshots = nullptr; ///< real and imaginary parts of complex modes, n × k, φᴴ M_c φ = 1
    const MultiVector *residuals = nullptr; ///< a basis grown by residuals, n × k

    double friction_coefficient = 0.; ///< μ of the rubbing attachment modes and of the response to damping
  };

  /// What a set of vectors rests on, and what it cost to compute.
  enum class BasisSource
  {
    disc_free,
    disc_sliding,
    pins_free,
    pins_sliding,
    uncoupled_factor, ///< of K
    normal_attachment,
    tangential_attachment,
    constraint_disc,
    constraint_pins,
    coupled_factor, ///< of K_c
    real,
    snapshots,
    residuals
  };

  /// A set of vectors that bases are made of: one at hand, or one to be computed.
  struct BasisPart
  {
    const char *symbol;
    int BasisCounts::       *count;                ///< how many they are
    std::vector<BasisSource> rests_on;             ///< what is computed beforehand
    bool                     is_uncoupled = false; ///< whether the vectors are of the uncoupled bodies

    const MultiVector *BasisIngredients::*set                   = nullptr;
    MultiVector (*compute)(const BasisIngredients &ingredients) = nullptr;
  };

  /// A reduced basis: what it is made of, and for which problems.
  struct BasisRecipe
  {
    BasisKind                      kind;
    const char                    *name;
    std::vector<const BasisPart *> parts; ///< the columns of T_r0, from left to right
    bool                           needs_friction = true;
    bool                           needs_damping  = false;

    /// The parts by their symbols: "Phi_f^D Phi_f^P (Psi_an^D - Psi_an^P)".
    std::string columns() const;

    /// Whether it is made on the uncoupled dofs and must be connected, eq. (22); the others have coupled columns.
    bool is_connected() const;

    bool rests_on(BasisSource source) const;
  };

  /// All bases, those of the paper first.
  const std::vector<BasisRecipe> &basis_recipes();

  const BasisRecipe &recipe(BasisKind kind);

  /// Its name, as in `set Bases = ...`.
  std::string to_string(BasisKind kind);
} // namespace Squeal
