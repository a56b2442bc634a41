// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/common_points.h>

#include <vector>

namespace Squeal
{
  /// Counterpart of a mode on another mesh.
  struct PairedMode
  {
    int    partner    = -1;    ///< index of the mode on the other mesh; -1: none
    double overlap    = 0.;    ///< |φᴴWψ|² / (φᴴWφ ψᴴWψ) with the partner [-]
    bool   in_cluster = false; ///< one of several modes that mix differently on each mesh
  };

  struct ModePairing
  {
    std::vector<PairedMode> coarse, fine;
  };

  /**
   * Pairs modes of two meshes one to one by their shapes at common points; the inner product W contains the masses of the points.
   *
   * Modes need not be orthogonal to each other. A mode of the coarse mesh is approximated by the closest combination of fine modes, φ ≈ Σ
   * c_j ψ_j, all normalised, and |c_j|² is the share of ψ_j. The mode is connected with the fine modes of the largest shares until their
   * sum is ¾ of the total; shares below ¼ of the largest share do not connect. Modes of the fine mesh are connected with coarse modes in
   * the same way. A shape may therefore rotate by up to 30° towards another shape from mesh to mesh and still have a single counterpart.
   * Chains of connected modes form groups; two modes that are each connected only with the other form a pair.
   *
   * - A group with one mode of each mesh: the modes are counterparts.
   * - A group with several modes of a mesh: a cluster. The eigenvalues are so close that discretisation mixes the eigenvectors, as in a
   * doublet or for equal pins. Only their spans have counterparts: members are marked, and paired so that the sum of squared distances of
   * λ, after a common shift, is smallest.
   * - A mode with less than half of its energy in the span of the modes of the other mesh has no counterpart. The same applies to surplus
   * modes of a cluster. To provide counterparts near the end of a band, the band of the other mesh should be wider.
   *
   * Collective; the rows of both sets of modes must have the same distribution.
   */
  ModePairing pair_modes(const ModesAtPoints &coarse, const ModesAtPoints &fine);
} // namespace Squeal
