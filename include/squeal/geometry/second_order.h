// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>

namespace Squeal
{
  /**
   * Adds nodes at the middle of every edge, at the centre of every quadrilateral face and of every hexahedron. A mesh that already has
   * these nodes is returned unchanged.
   *
   * New nodes follow cylinders: if all corners of a named surface (disc_bore, disc_rim; pin_side of each pin) lie on a circular cylinder
   * about an axis parallel to z, the new nodes on its edges and faces are moved onto the cylinder. The same applies to
   *
   * - inner faces of pins on a cylinder about the same axis, in successive rings of hexahedra: a ring thinner than the height of the arc
   * would otherwise be squeezed between a curved and a straight face. If a cell has two such adjacent faces, whose edges would meet at 180
   * degrees, both remain straight;
   * - coincident edges of the contact faces on the other side, so that contact nodes also match in degree 2.
   *
   * Centres of other faces and cells follow their edges by transfinite interpolation. Other surfaces keep straight edges.
   */
  Mesh second_order(Mesh mesh);

  /// Adds the missing nodes of serendipity elements in a mesh of degree 2, at the centres of quadrilateral faces and hexahedra as defined
  /// by their shape functions. Returns the number of added nodes.
  std::size_t add_centres(Mesh &mesh);
} // namespace Squeal
