// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>

namespace Squeal
{
  /// Volume of a cell, from the map of its nodes [m³].
  double volume_of(const Mesh &mesh, const Mesh::Cell &cell);

  /// Smallest det(∂x/∂ξ) of that map at the points of quadrature() and, if clearly negative there, at the nodes [m³].
  double worst_determinant(const Mesh &mesh, const Mesh::Cell &cell);
} // namespace Squeal
