#pragma once

#include <squeal/assembly/second_order_system.h>
#include <squeal/model/model.h>
#include <squeal/parameters/materials.h>

namespace Squeal
{
  /**
   * Mass, damping and stiffness of the bodies on the free dofs:
   *
   *   K_ij = ∫ 2 G ε(φ_i):ε(φ_j) + Λ div φ_i div φ_j dV + Σ_mounts ∫ φ_i · S φ_j dA
   *   C_ij = ∫ α ρ φ_i · φ_j + β (2 G ε(φ_i):ε(φ_j) + Λ div φ_i div φ_j) dV
   *   M_ij = ∫ ρ φ_i · φ_j dV
   *
   * C is null if no material is damped; mounts have no damping.
   * S = k_r e_r⊗e_r + k_θ e_θ⊗e_θ + k_z e_z⊗e_z [N/m³] about the disc's axis z.
   * Full Gauss quadrature, degree + 1 points per direction.
   *
   * Throws MeshError if a mounted surface does not exist.
   */
  SecondOrderSystem assemble(const Model &model, const MaterialParameters &materials);
} // namespace Squeal
