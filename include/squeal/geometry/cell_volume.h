// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>

namespace Squeal
{
  /// Volume of a cell, from its isoparametric map [m³].
  double volume_of(const Mesh &mesh, const Mesh::Cell &cell);

  /// Smallest det(∂x/∂ξ) of the isoparametric map at the points of quadrature(); values at nodes count only if they are clearly negative
  /// [m³].
  double worst_determinant(const Mesh &mesh, const Mesh::Cell &cell);
} // namespace Squeal
