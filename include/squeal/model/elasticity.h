#pragma once

#include <squeal/model/model.h>
#include <squeal/parameters/materials.h>
#include <squeal/system/terms.h>

namespace Squeal
{
  /// The uncoupled bodies as a list of terms, with values of their parameters.
  struct BodyTerms
  {
    std::vector<Term> terms;
    ParameterValues   values;
  };

  /// Names of the parameters of body_terms() and add_rotation().
  namespace BodyParameter
  {
    std::string young_modulus(const std::string &body);  ///< E [Pa]
    std::string density(const std::string &body);        ///< ρ [kg/m³]
    std::string rayleigh_alpha(const std::string &body); ///< α [1/s]
    std::string rayleigh_beta(const std::string &body);  ///< β [s]

    /// k [N/m³] of a mount; @p direction is radial, tangential or axial.
    std::string mount_stiffness(const std::string &direction, const std::string &surface);

    inline constexpr const char *angular_velocity = "angular velocity of the disc"; ///< Ω [rad/s], positive about e_z
  }                                                                                 // namespace BodyParameter

  /**
   * Terms of the disc and of every pin on the free dofs, sparse and symmetric, at unit coefficients; E, ρ, α and β are
   * parameters of each body, such as "density, pin_top_1":
   *
   *   E K_b,   K_b,ij = ∫ 2 G ε(φ_i):ε(φ_j) + Λ div φ_i div φ_j dV for E = 1
   *   k K_e,   K_e,ij = ∫_mount (e·φ_i) (e·φ_j) dA, e the radial, tangential or axial direction about the z axis, k [N/m³]
   *   λ β E K_b + λ α ρ M_b
   *   λ² ρ M_b,  M_b,ij = ∫ φ_i · φ_j dV
   *
   * Elements with incompatible modes: K_b of CellStiffness. Mounts have no damping. Full Gauss quadrature, degree + 1 points per direction.
   *
   * Throws MeshError if a mounted surface does not exist or an element is inverted.
   */
  BodyTerms body_terms(const Model &model, const MaterialParameters &materials);

  /// Values of the parameters of body_terms(), but for stiffnesses of zero.
  ParameterValues body_values(const Model &model, const MaterialParameters &materials);

  /// M, C and K of the bodies, the sum of body_terms(); C is null if no material is damped.
  SecondOrderSystem assemble(const Model &model, const MaterialParameters &materials);
} // namespace Squeal
