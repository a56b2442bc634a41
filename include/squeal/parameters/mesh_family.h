#pragma once

#include <squeal/parameters/geometry.h>

namespace Squeal
{
  /// Throws ParameterError for a geometry whose mesh does not follow the element size and the numbers of layers, and MeshError if there is no such file.
  void check_follows(const GeometryParameters &geometry);

  /**
   * The geometry with a mesh @p factor times as fine in every direction: elements of the size divided by it, layers times
   * it, and pin faces of as many blocks, k × k elements each with 3 k (k + 1) + 1 nodes, and of as many rings; numbers are rounded, and one at
   * least. Neighbouring graded layers and rings become as much more alike. A factor of 1 changes nothing.
   *
   * Throws as check_follows().
   */
  GeometryParameters refined(const GeometryParameters &geometry, double factor);
} // namespace Squeal
