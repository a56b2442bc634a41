// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>

namespace Squeal
{
  /// Volume of a cell by the map of its nodes [m³].
  double volume_of(const Mesh &mesh, const Mesh::Cell &cell);

  /// Least det(∂x/∂ξ) of that map at the points of quadrature() and, where it is clearly negative there, at nodes [m³].
  double worst_determinant(const Mesh &mesh, const Mesh::Cell &cell);
} // namespace Squeal
