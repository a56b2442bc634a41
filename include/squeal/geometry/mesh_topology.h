// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>

#include <optional>
#include <string>

namespace Squeal
{
  /**
   * Throws MeshError, naming @p where, with number and first place, for
   *
   * - nodes of one body that coincide: they would be a crack. Coinciding means closer than 1e-3 of the shortest edge there or 2e-5 of the
   *   size of the mesh, the error of coordinates with six digits, but not beyond 5e-3 of the longest edge there;
   * - nodes on faces or edges of elements of their own body, or inside these, that are not their nodes, and quadrilateral faces with two
   *   triangles on the other side;
   * - contact faces of disc and pin that coincide but have the same outward normal: one body is on the wrong side;
   * - bodies that overlap: nodes or centres of elements inside an element of another body by more than a twentieth of its extent and
   *   @p pairing_tolerance [m].
   *
   * Elements count with straight edges. Needs what check_parts() and check_mesh() make sure of. The effort is that of sorting the faces and of a spatial index.
   */
  void check_topology(const Mesh &mesh, double pairing_tolerance, const std::string &where);

  /// Nodes of two bodies that coincide without being on the named contact faces of both: the bodies touch, but nothing couples them.
  struct UnnamedContact
  {
    std::size_t n_nodes = 0; ///< of all pairs of bodies
    std::string body, other; ///< the first of these pairs
    Mesh::Point place;       ///< of its first node [m]
  };

  UnnamedContact find_unnamed_contact(const Mesh &mesh);
} // namespace Squeal
