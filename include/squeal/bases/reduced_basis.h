#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/bases/static_modes.h>

#include <memory>
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

  template <>
  struct EnumTable<BasisKind>
  {
    static constexpr std::array<EnumName<BasisKind>, 14> names = {
      {{BasisKind::free, "free"},
       {BasisKind::fixed, "fixed"},
       {BasisKind::mixed, "mixed"},
       {BasisKind::free_tangential, "free + t.a.m."},
       {BasisKind::free_rubbing, "free with r.a.m."},
       {BasisKind::fixed_tangential, "fixed + t.a.m."},
       {BasisKind::mixed_tangential, "mixed + t.a.m."},
       {BasisKind::real, "real"},
       {BasisKind::real_tangential, "real + t.a.m."},
       {BasisKind::real_first_order, "real + 1st-ord."},
       {BasisKind::real_two_sided, "real + 1st-ord. two-sided"},
       {BasisKind::real_two_sided_damped, "real + 1st-ord. two-sided + damping"},
       {BasisKind::pod, "POD"},
       {BasisKind::residual_grown, "residual-grown"}}};
  };

  /// Sets of vectors that bases are made of, by their symbols.
  enum class BasisPart
  {
    disc_free,
    disc_sliding,
    pins_free,
    pins_sliding,
    normal_attachment,
    normal_attachment_disc,
    tangential_attachment,
    rubbing_attachment,
    constraint_disc,
    constraint_pins,
    real,
    coupled_tangential_attachment,
    friction_right,
    friction_left,
    damping,
    snapshots,
    residuals
  };

  template <>
  struct EnumTable<BasisPart>
  {
    static constexpr std::array<EnumName<BasisPart>, 17> names = {
      {{BasisPart::disc_free, "Phi_f^D"},
       {BasisPart::disc_sliding, "Phi_s^D"},
       {BasisPart::pins_free, "Phi_f^P"},
       {BasisPart::pins_sliding, "Phi_s^P"},
       {BasisPart::normal_attachment, "(Psi_an^D - Psi_an^P)"},
       {BasisPart::normal_attachment_disc, "Psi_an^D"},
       {BasisPart::tangential_attachment, "(Psi_at^D - Psi_at^P)"},
       {BasisPart::rubbing_attachment, "(Psi_amu^D - Psi_amu^P)"},
       {BasisPart::constraint_disc, "Psi_cn^D"},
       {BasisPart::constraint_pins, "Psi_cn^P"},
       {BasisPart::real, "Phi_R"},
       {BasisPart::coupled_tangential_attachment, "(Psi_cat^D - Psi_cat^P)"},
       {BasisPart::friction_right, "Psi_Rmu"},
       {BasisPart::friction_left, "K_c^-1 V_K^T A^T Phi_R"},
       {BasisPart::damping, "K_c^-1 C_c Phi_R"},
       {BasisPart::snapshots, "complex modes at several mu"},
       {BasisPart::residuals, "Phi_R and residuals K_c^-1 R_F, K_c^-1 L_F"}}};
  };

  /// The columns of T_r0, from left to right.
  std::vector<BasisPart> basis_parts(BasisKind kind);

  /// The same in words: "Phi_f^D Phi_f^P (Psi_an^D - Psi_an^P)".
  std::string basis_columns(BasisKind kind);

  /// Whether a basis is made on the uncoupled dofs and must be connected, eq. (22); the others have coupled columns.
  bool is_connected(BasisKind kind);

  /// Whether a basis is meant for the problem with friction only.
  bool needs_friction(BasisKind kind);

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

  /// Columns of T_r0 and of T_r before any decision on rank, tables 2, 4 and 5 of the paper.
  struct BasisSize
  {
    int n_r0, n_r;
  };
  BasisSize nominal_size(BasisKind kind, const BasisCounts &counts);

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

  /// Decisions on rank.
  struct BasisOptions
  {
    /// Directions whose M-norm is below this part of the largest are dropped [-].
    double tolerance = 1e-10;

    /// Singular values of P_n T_r0, columns scaled to unit M-norm, below this part of the largest count as zero [-].
    double connection_tolerance = 1e-12;

    double pod_tolerance = 1e-6; ///< principal axes of the snapshots below this part of the largest are dropped [-]
    int    pod_size      = 0;    ///< principal axes kept at most; 0: as many as the tolerance leaves
  };

  /// How the components were connected: T_cr spans the kernel of P_n T_r0.
  struct ConnectionRank
  {
    int    rank             = 0;  ///< of P_n T_r0; 0 for a basis that needs no connection
    double smallest_kept    = 0.; ///< singular value / largest one [-]
    double largest_dropped  = 0.; ///< singular value / largest one [-]; 0 if none was dropped
    double constraint_error = 0.; ///< max |P_n T_r0 T_cr| / max |T_r0 T_cr| before the last digit is mended [-]
  };

  /// A basis of the coupled system, and how it came about.
  struct ReducedBasis
  {
    std::string                  name;
    std::shared_ptr<MultiVector> vectors;   ///< T_r in coupled coordinates, n × r, M_c-orthonormal
    int                          n_r0;      ///< columns of T_r0
    int                          n_nominal; ///< columns of T_r by the formula
    int                          n_dropped; ///< columns of T_r0 T_cr found dependent, or left out by POD
    double                       tolerance; ///< of that decision [-]
    double                       condition; ///< of the Gram matrix of T_r0 T_cr, columns scaled to unit M-norm (POD: as they are)
    double                       orthonormality; ///< max |T_rᵀ M_c T_r − I|, below 1e-10
    ConnectionRank               connection;

    /// r
    int size() const;
  };

  /**
   * Builds a basis: joins the columns of T_r0; for component modes finds T_cr
   * with P_n T_r0 T_cr = 0 by a singular value decomposition of P_n T_r0, its
   * columns scaled to unit M-norm, and goes over to coupled coordinates; then
   * makes the columns M_c-orthonormal. The disc_free modes of a free disc
   * are completed by its rigid-body motions where they lack them.
   *
   * Throws SolverError if an ingredient is missing or an empty set, if the
   * basis is larger than the system, or if it cannot be made orthonormal.
   */
  ReducedBasis reduced_basis(BasisKind kind, const BasisIngredients &ingredients, const BasisOptions &options = {});
} // namespace Squeal
