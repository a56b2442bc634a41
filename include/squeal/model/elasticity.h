// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/model/model.h>
#include <squeal/parameters/materials.h>
#include <squeal/system/terms.h>

namespace Squeal
{
  /// Terms of the uncoupled bodies and the values of their parameters.
  struct BodyTerms
  {
    std::vector<Term> terms;
    ParameterValues   values;
  };

  /// Names of the parameters of body_terms() and add_rotation().
  namespace BodyParameter
  {
    std::string young_modulus(const std::string &volume);  ///< E [Pa]; E_1 of an orthotropic material, which scales all moduli
    std::string density(const std::string &volume);        ///< ρ [kg/m³]
    std::string rayleigh_alpha(const std::string &volume); ///< α [1/s]
    std::string rayleigh_beta(const std::string &volume);  ///< β [s]

    inline constexpr const char *angular_velocity = "angular velocity of the disc"; ///< Ω [rad/s], positive about e_z
  }                                                                                 // namespace BodyParameter

  /// A nonzero coefficient of a mount in one direction about the axis of the disc; the coefficient is the parameter of a term.
  struct MountParameter
  {
    std::string name;  ///< name in ParameterValues
    std::string path;  ///< name in parameter files: "Mounts/Elastic mounts: disc_bore radial"
    const char *unit;  ///< SI unit of the coefficient, per area
    double      value; ///< k [N/m³] of springs, c [N s/m³] of dashpots, m [kg/m²] of masses
    int         power; ///< power of λ in the term
    std::string surface;
    int         direction; ///< 0 radial, 1 tangential, 2 axial, 3 all
  };

  std::vector<MountParameter> mount_parameters(const MaterialParameters &materials);

  /**
   * Sparse symmetric terms of every volume and mount on the free dofs; E, ρ, α and β of each volume are parameters ("density, pin_top_1"):
   *
   *   E K_b,   K_b,ij = ∫ ε(φ_i) : C/E : ε(φ_j) dV; C/E depends on Poisson's ratios, and on ratios of moduli if orthotropic
   *   k K_e,   K_e,ij = ∫_mount (e·φ_i) (e·φ_j) dA, e the radial, tangential or axial direction about the z axis, k [N/m³]
   *   λ c K_e of dashpots, c [N s/m³];  λ² m ∫ φ_i · φ_j dA of masses, m [kg/m²]
   *   λ β E K_b + λ α ρ M_b
   *   λ² ρ M_b,  M_b,ij = ∫ φ_i · φ_j dV
   *
   * add_stiffness() defines K_b of elements with incompatible modes. Integrals use the points of quadrature().
   *
   * Throws MeshError if a mounted surface does not exist or an element is inverted.
   */
  BodyTerms body_terms(const Model &model, const MaterialParameters &materials);

  /// Terms of a volume: stiffness, mass, and damping proportional to each of them.
  std::vector<Term> volume_terms(const Model &model, unsigned int volume, const Material &material);

  /// Values of the parameters of body_terms(); zero coefficients of mounts are omitted.
  ParameterValues body_values(const Model &model, const MaterialParameters &materials);

  /**
   * Adds terms for the rotation of the disc about the z axis in the fixed frame. The velocity of the material is u̇ + Ω ∂_θ u with ∂_θ u =
   * −y ∂_x u + x ∂_y u for Cartesian components, which includes the rotation of the base vectors:
   *
   *   λ Ω ρ G,  G_ij = ∫ φ_i · ∂_θ φ_j − ∂_θ φ_i · φ_j dV      skew: gyroscopic forces, 2 Ω ∫ ρ φ_i · ∂_θ φ_j for a body of revolution
   *   −Ω² ρ N,  N_ij = ∫ ∂_θ φ_i · ∂_θ φ_j dV                  symmetric: convective stiffness
   *
   * Centrifugal prestress is not included.
   *
   * @param bodies           must contain the density of the disc
   * @param angular_velocity Ω [rad/s], positive about e_z
   */
  void add_rotation(BodyTerms &bodies, const Model &model, double angular_velocity);
} // namespace Squeal
