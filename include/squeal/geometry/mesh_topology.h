// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>

#include <optional>
#include <string>

namespace Squeal
{
  /**
   * Throws MeshError, naming @p where, with number and first position, for
   *
   * - coincident nodes of one body, which would be a crack. Nodes coincide if they are closer than 1e-3 of the shortest edge there or 2e-5
   * of the mesh size, the error of coordinates with six digits, but at most 5e-3 of the longest edge there;
   * - nodes of other elements on faces or edges of elements of their own body, or inside them, and quadrilateral faces with two triangles
   * on the other side;
   * - contact faces of disc and pin that coincide but have the same outward normal: one body is on the wrong side;
   * - overlapping bodies: nodes or element centres inside an element of another body by more than a twentieth of its extent and @p
   * pairing_tolerance [m].
   *
   * Element edges are assumed straight. Requires check_parts() and check_mesh(). Cost: sorting of the faces and a spatial index.
   */
  void check_topology(const Mesh &mesh, double pairing_tolerance, const std::string &where);

  /// Nodes of two bodies that coincide but are not on the named contact faces of both: the bodies touch without being coupled.
  struct UnnamedContact
  {
    std::size_t n_nodes = 0; ///< of all pairs of bodies
    std::string body, other; ///< the first of these pairs
    Mesh::Point place;       ///< of its first node [m]
  };

  UnnamedContact find_unnamed_contact(const Mesh &mesh);
} // namespace Squeal
