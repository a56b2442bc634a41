// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/model/elastic_law.h>
#include <squeal/model/element_values.h>

#include <deal.II/lac/full_matrix.h>

namespace Squeal
{
  /**
   * Adds the stiffness of one cell divided by Young's modulus, K_ij = ∫ ε(φ_i) : C/E : ε(φ_j) dV.
   *
   * Hexahedra with incompatible modes (E. L. Wilson, R. L. Taylor et al. 1973; R. L. Taylor, P. J. Beresford, E. L. Wilson 1976) have nine
   * additional internal displacements, (1 − ξ_a²) e_b with ξ in [−1, 1]³, which are eliminated by static condensation:
   *
   *   K = K_uu − K_uα K_αα⁻¹ K_αu.
   *
   * These modes avoid shear locking in bending. Their gradients use the Jacobian J₀ at the centre of the cell, ∇(1 − ξ_a²) := (det J₀ / det
   * J) J₀⁻ᵀ ∇_ξ (1 − ξ_a²). The mean of these gradients over the cell vanishes, so that constant strains are exact in hexahedra of any
   * shape. Incompatible modes have no mass. Other cell shapes have no incompatible modes.
   */
  void add_stiffness(const ElementValues &values, Element element, const ElasticLaw &law, dealii::FullMatrix<double> &stiffness);
} // namespace Squeal
