// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/common_points.h>

#include <vector>

namespace Squeal
{
  /// What became of a mode of one mesh on another one.
  struct PairedMode
  {
    int    partner    = -1;    ///< number of the mode on the other mesh; -1 if it has none there
    double overlap    = 0.;    ///< |φᴴWψ|² / (φᴴWφ ψᴴWψ) with the partner [-]
    bool   in_cluster = false; ///< the mesh decides which of several modes is the partner
  };

  /// Modes of two meshes, each with its partner on the other one.
  struct ModePairing
  {
    std::vector<PairedMode> coarse, fine;
  };

  /**
   * Pairs modes of two meshes by their shapes at common points, one to one. W are the masses of the points.
   *
   * Modes need not be orthogonal to each other: a mode of the coarse mesh is close to the combination of those of the fine one,
   * φ ≈ Σ c_j ψ_j, all normalised, that differs least from it, and |c_j|² is the share of ψ_j. It is connected with the modes of
   * the largest shares that together have ¾ of all, those left out that have less than ¼ of the largest; and so are the modes of
   * the fine mesh with those of the coarse one. A shape may thus turn by up to 30° towards another one from mesh to mesh and still
   * has but one counterpart. Connections make groups, in chains, but for pairs of modes that are connected with each other alone
   * seen from either side.
   *
   * - One mode of each mesh: they are partners.
   * - Several: a cluster. Their eigenvalues are so close that discretisation turns the eigenvectors among each other, as those of a
   *   doublet or of equal pins. Their spans have partners, single modes have none by shape: members are paired so that the squared
   *   distances of their λ, but for a common shift, have the least sum, and they are marked.
   * - A mode with less than half of its energy in the span of the others has no partner, as beyond the end of the other band; neither has
   *   the surplus of a cluster. So that none near the end of a band lacks its partner, the modes of the other mesh reach beyond it.
   *
   * All processes must call; the values must be distributed alike.
   */
  ModePairing pair_modes(const ModesAtPoints &coarse, const ModesAtPoints &fine);
} // namespace Squeal
