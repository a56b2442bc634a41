// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>

namespace Squeal
{
  /// Checks a mesh of degree 2. Throws MeshError for second-order nodes that neighbours do not share or that are corners of other cells;
  /// for mid-edge nodes farther from the middle of their edge than half its length; and for cells whose Jacobian determinant is not
  /// positive at quadrature points or clearly negative at nodes.
  void check_curved(const Mesh &mesh);
} // namespace Squeal
