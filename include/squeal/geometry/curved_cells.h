// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>

namespace Squeal
{
  /// Throws MeshError, for a mesh of degree 2, for middle nodes that neighbours do not share or that are corners elsewhere, for those off the
  /// middle of their edge by more than half of its length, and for cells whose isoparametric map has a Jacobian determinant that is not
  /// positive at quadrature points or negative at nodes.
  void check_curved(const Mesh &mesh);
} // namespace Squeal
