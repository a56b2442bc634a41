// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>

#include <optional>
#include <string>

namespace Squeal
{
  /**
   * Throws a MeshError that names @p where, the number of errors and the first position, for
   *
   * - coincident nodes of one body, which would form a crack. Nodes coincide if their distance is below 1e-3 of the shortest adjacent edge
   * or 2e-5 of the mesh size, the error of coordinates with six digits, but at most a tenth of the shortest and 5e-3 of the longest
   * adjacent edge;
   * - nodes on faces or edges of other elements of the same body, or inside these elements, and quadrilateral faces with two triangles on
   * the other side;
   * - contact faces of disc and pin that coincide but have the same outward normal: one body is on the wrong side;
   * - overlapping bodies: nodes or element centres inside an element of another body by more than both a twentieth of its extent and @p
   * pairing_tolerance [m].
   *
   * Element edges are assumed straight. Requires check_parts() and check_mesh(). The cost is dominated by sorting the faces and by a
   * spatial index.
   */
  void check_topology(const Mesh &mesh, double pairing_tolerance, const std::string &where);

  /// Coincident nodes of two bodies that are not on the named contact faces of both bodies: the bodies touch without being coupled.
  struct UnnamedContact
  {
    std::size_t n_nodes = 0; ///< number of such nodes of all pairs of bodies
    std::string body, other; ///< names of the first of these pairs
    Mesh::Point place;       ///< position of the first node of this pair [m]
  };

  UnnamedContact find_unnamed_contact(const Mesh &mesh);
} // namespace Squeal
