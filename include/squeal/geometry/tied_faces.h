// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>
#include <squeal/linear_algebra/slave_rows.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Tied nodes, on faces that are bonded to other faces: their displacements are combinations of displacements of other nodes.
  struct TiedNodes
  {
    SlaveRows                masters; ///< rows by node of the mesh; the coefficients of a row sum to one
    std::vector<std::string> notes;   ///< notes on the coupling of the faces, for the user
  };

  /**
   * Tied nodes on the first surface of each pair in Mesh::tied: u_j = (Σ_l W_jl u_l − Σ_{i≠j} B_ji u_i) / B_jj in all directions, with W
   * and B from mortar(). On flat faces, linear displacements and constant stresses are transferred exactly. Nodes outside the overlap are
   * free.
   *
   * Throws MeshError if mortar() fails, for nodes that are tied twice or circularly, and if less than a fifth of the first surface
   * overlaps.
   */
  TiedNodes tied_nodes(const Mesh &mesh);
} // namespace Squeal
