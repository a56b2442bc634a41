#pragma once

#include <squeal/parameters/geometry.h>

namespace Squeal
{
  /**
   * The geometry with a mesh @p factor times as fine in every direction: elements of the size divided by it, layers times
   * it, and pin faces of as many blocks, k × k elements each with 3 k (k + 1) + 1 nodes; numbers are rounded, and one at
   * least. A factor of 1 changes nothing.
   *
   * Throws ParameterError for a geometry whose mesh does not follow these parameters: a mesh file, or a script that does not
   * use the element size and the numbers of layers; MeshError if there is no such file.
   */
  GeometryParameters refined(const GeometryParameters &geometry, double factor);
} // namespace Squeal
