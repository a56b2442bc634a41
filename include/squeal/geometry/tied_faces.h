// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>
#include <squeal/linear_algebra/slave_rows.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Nodes whose displacements are those of others, because they are on a face that is bonded to another one.
  struct TiedNodes
  {
    SlaveRows                masters; ///< nodes of the mesh; the coefficients of a row sum to one
    std::vector<std::string> notes;   ///< how faces were coupled, for the user
  };

  /**
   * Nodes of the first surface of each of Mesh::tied: u_j = (Σ_l W_jl u_l − Σ_{i≠j} B_ji u_i) / B_jj in all directions, with W and B of
   * mortar(). On flat faces linear displacements and constant stresses pass exactly. Nodes beyond the overlap stay free.
   *
   * Throws MeshError as mortar() does, for nodes that are tied twice or in a circle, and where less than a fifth of a surface overlaps.
   */
  TiedNodes tied_nodes(const Mesh &mesh);
} // namespace Squeal
