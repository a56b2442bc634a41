#pragma once

#include <squeal/model/elasticity.h>

namespace Squeal
{
  /**
   * Adds what the rotation of the disc about the z axis does in the fixed frame, where its material moves with
   * u̇ + Ω ∂_θ u, ∂_θ u = −y ∂_x u + x ∂_y u of Cartesian components, so that the base vectors turn, too:
   *
   *   λ Ω ρ G,  G_ij = ∫ φ_i · ∂_θ φ_j − ∂_θ φ_i · φ_j dV      skew: gyroscopic forces, 2 Ω ∫ ρ φ_i · ∂_θ φ_j of a body of revolution
   *   −Ω² ρ N,  N_ij = ∫ ∂_θ φ_i · ∂_θ φ_j dV                  symmetric: convective stiffness
   *
   * Stresses from centrifugal forces are left out.
   *
   * @param bodies           with the density of the disc
   * @param angular_velocity Ω [rad/s], positive about e_z
   */
  void add_rotation(BodyTerms &bodies, const Model &model, double angular_velocity);
} // namespace Squeal
