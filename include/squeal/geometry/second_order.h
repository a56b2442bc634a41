// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>

namespace Squeal
{
  /**
   * The mesh with a node at the middle of every edge, at the centre of every quadrilateral face and of every hexahedron. One that has them is
   * returned as it is.
   *
   * New nodes follow cylinders: where all corners of a named surface (disc_bore, disc_rim; pin_side, pin by pin) lie on a circular cylinder
   * about an axis parallel to z, its edges and faces are moved onto it. So are
   *
   * - faces of pins behind them that lie on a cylinder about the same axis, ring by ring of hexahedra: a ring that is thinner than the arc is
   *   high would otherwise be squeezed between a curved and a straight face. A cell with two such faces side by side, whose edges would meet
   *   at 180 degrees, keeps them straight;
   * - coincident edges of the contact faces on the other side, so that contact nodes pair in degree 2 as well.
   *
   * Centres of other faces and cells follow their edges by transfinite interpolation. Surfaces of any other shape keep straight edges.
   */
  Mesh second_order(Mesh mesh);

  /// Gives serendipity elements, of a mesh of degree 2, the nodes that they lack at centres of quadrilateral faces and of hexahedra, where their
  /// own functions put them. Returns their number.
  std::size_t add_centres(Mesh &mesh);
} // namespace Squeal
