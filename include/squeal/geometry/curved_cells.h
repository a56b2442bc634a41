// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>

namespace Squeal
{
  /// Checks a mesh of degree 2. Throws MeshError for mid-edge nodes that neighbours do not share or that are corners of other cells, for
  /// mid-edge nodes whose distance from the middle of their edge exceeds half its length, and for cells whose isoparametric map has a
  /// Jacobian determinant that is not positive at quadrature points or negative at nodes.
  void check_curved(const Mesh &mesh);
} // namespace Squeal
