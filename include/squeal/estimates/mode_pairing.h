// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/common_points.h>

#include <vector>

namespace Squeal
{
  /// Counterpart of a mode on another mesh.
  struct PairedMode
  {
    int    partner    = -1;    ///< number of the mode on the other mesh; -1: none
    double overlap    = 0.;    ///< |φᴴWψ|² / (φᴴWφ ψᴴWψ) with the partner [-]
    bool   in_cluster = false; ///< one of several modes that mix from mesh to mesh
  };

  /// Modes of two meshes with their counterparts.
  struct ModePairing
  {
    std::vector<PairedMode> coarse, fine;
  };

  /**
   * Pairs modes of two meshes one to one by their shapes at common points. W: masses of the points.
   *
   * Modes need not be orthogonal to each other: a mode of the coarse mesh is approximated by the closest combination of fine modes, φ ≈ Σ
   * c_j ψ_j, all normalised, and |c_j|² is the share of ψ_j. It is connected with the modes of the largest shares that together have ¾ of
   * the total, except those with less than ¼ of the largest; modes of the fine mesh are connected likewise. A shape may thus rotate by up
   * to 30° towards another one from mesh to mesh and still have a single counterpart. Connected modes form groups, in chains, except pairs
   * that are connected only with each other from both sides.
   *
   * - One mode of each mesh: they are counterparts.
   * - Several: a cluster. The eigenvalues are so close that discretisation mixes the eigenvectors, as in a doublet or for equal pins. Only
   * their spans have counterparts: members are paired so that the sum of squared distances of λ, after a common shift, is smallest, and are
   * marked.
   * - A mode with less than half of its energy in the span of the others has no counterpart, for example beyond the end of the other band;
   * neither have surplus modes of a cluster. To provide counterparts near the end of a band, the other mesh should have a wider one.
   *
   * Collective; the values must be distributed alike.
   */
  ModePairing pair_modes(const ModesAtPoints &coarse, const ModesAtPoints &fine);
} // namespace Squeal
