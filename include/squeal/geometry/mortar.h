// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>

#include <string>
#include <utility>
#include <vector>

namespace Squeal
{
  /// A face of a contact surface: triangle or quadrilateral of degree 1 or 2.
  struct SurfaceElement
  {
    Shape       shape;
    Mesh::Nodes nodes; ///< indices into SurfacePatch::points, in the order of reference_nodes(), outwards by the right-hand rule
  };

  /// One side of a contact; all its elements have the same degree.
  struct SurfacePatch
  {
    std::vector<dealii::Point<3>> points; ///< [m]
    std::vector<SurfaceElement>   elements;
  };

  /// Nodes with weights [-].
  using NodeWeights = std::vector<std::pair<unsigned int, double>>;

  /// Multiplier j of a slave node; see mortar() for the formulas.
  struct MortarRow
  {
    unsigned int node;         ///< slave node of the multiplier
    double       area;         ///< D_j = ∫ ψ_j over the overlap, positive [m²]
    NodeWeights  slave;        ///< B_ji; the sum is one
    NodeWeights  master;       ///< W_jl = ∫ ψ_j N_l / D_j; the sum is one, entries below 1e-13 are dropped
    NodeWeights  left_inverse; ///< G_ji, in general not the transpose of B
  };

  struct Mortar
  {
    std::vector<MortarRow> rows;         ///< rows by ascending slave node; slave nodes without a row are not in contact
    double                 slave_area;   ///< area of all slave elements [m²]
    double                 overlap_area; ///< slave area opposite the master [m²]
    double                 coarseness;   ///< largest ratio of a slave element's size to the mean size of the opposite master elements [-]
    double                 largest_gap;  ///< largest gap or penetration, along the normals of the slave [m]
  };

  /**
   * Couples two surfaces whose nodes do not match, by Lagrange multipliers with dual shape functions on the slave.
   *
   * The multiplier j is the pressure λ = Σ ψ_j λ_j; its force r_j = D_j λ_j acts on the relative displacement
   *
   *     g_j = Σ_i B_ji u_i − Σ_l W_jl u_l
   *
   * with forces f_i = Σ_j B_ji r_j on the slave and −Σ_j W_jl r_j on the master. The slave forces determine r_j: r_j = Σ_i G_ji f_i, G Bᵀ =
   * I. On flat faces, g vanishes for linear displacements, and a constant pressure gives both sides their consistent nodal forces. If the
   * meshes match, W = B.
   *
   * On an element ψ = diag(∫ Ñ) (∫ Ñ Ñᵀ)⁻¹ Ñ, so that ∫ ψ_i Ñ_j = δ_ij ∫ Ñ_j. Both integrals extend over the overlap and use the quadrature
   * points of ∫ ψ_j N_l: linear displacements are therefore exact for any quadrature rule. Ñ = N and B = G = I, except on slaves with
   * 6-node triangles, where ∫ N vanishes for a corner. There, with α = 1/5,
   *
   *     Ñ_v = N_v + α Σ_e N_e,   Ñ_e = (1 − 2 α) N_e,   ũ_v = u_v,   ũ_e = (u_e − α (u_v + u_v')) / (1 − 2 α)
   *     r_v = f_v + α Σ_e f_e,   r_e = (1 − 2 α) f_e
   *
   * for corners v and mid-edge nodes e of an edge v v'. 9-node quadrilaterals of such a slave are transformed as well, because they share
   * edges with triangles; their centre node is unchanged. B u = ũ.
   *
   * At the edge of the overlap, D_j may be small or negative. If D_j is less than a tenth of ∫ Ñ_j over the whole elements, multiplier j is
   * merged with the neighbour that has the largest D: the rows of B and W are averaged with the weights D, and D and the rows of G are
   * summed. Slave elements that overlap by less than 2 % carry no multiplier, so that ∫ Ñ Ñᵀ remains invertible; Σ D_j excludes their area.
   *
   * B. I. Wohlmuth, SIAM J. Numer. Anal. 38 (2000) 989–1012 (dual functions); M. A. Puso, T. A. Laursen, Comput. Methods Appl. Mech.
   * Engrg. 193 (2004) 601–629 (segments); A. Popp, B. I. Wohlmuth, M. W. Gee, W. A. Wall, SIAM J. Sci. Comput. 34 (2012) B421–B446
   * (degree 2); T. Cichosz, M. Bischoff, Comput. Methods Appl. Mech. Engrg. 200 (2011) 1317–1332 (partial overlap).
   *
   * @param search_distance largest gap or penetration of the two surfaces, along the normals of the slave [m]
   *
   * Throws MeshError if the overlap is less than 10⁻³ of the slave, if the normals are not opposite (mean cosine above −½), or if the
   * reference coordinates of a point cannot be found.
   */
  Mortar mortar(const SurfacePatch &slave, const SurfacePatch &master, double search_distance);

  /// Half the mean size of the slave faces: surfaces with a smaller gap count as touching [m].
  double largest_gap(const SurfacePatch &slave);

  /// Notes for the user on a coupling of two named surfaces: overlap, and gaps and face sizes that reduce the accuracy.
  std::vector<std::string> coupling_notes(const Mortar      &coupling,
                                          double             largest_gap, ///< see largest_gap() [m]
                                          const std::string &slave,
                                          const std::string &master);
} // namespace Squeal
