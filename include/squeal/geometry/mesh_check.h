// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Shape quality of the cells.
  struct MeshQuality
  {
    double       worst_scaled_jacobian; ///< 1 for a box and other regular cells, 0 for a flat corner, negative if inverted
    unsigned int worst_element;         ///< index of this cell
    unsigned int n_bad;                 ///< cells below smallest_scaled_jacobian
  };

  /**
   * Smallest scaled Jacobian that check_mesh() accepts. If a round pin is filled with three blocks, each block has a corner on the circle
   * with an angle of 180° - 60°/k, so that the scaled Jacobian sin(60°/k) is small by construction: 0.5 for 19 nodes, 0.26 for 61, 0.1 for
   * k = 10 (331 nodes). These elements are acceptable; the limit rejects flat ones.
   */
  inline constexpr double smallest_scaled_jacobian = 0.02;

  /// Smallest scaled Jacobian: the triple product of the three normalised edges at each corner, relative to that of a regular cell, which
  /// is 1 for hexahedra, √3/2 for wedges, 1/√2 for tetrahedra and pyramids (without the apex). Edges are assumed straight. Throws MeshError
  /// for a mesh without elements.
  MeshQuality mesh_quality(const Mesh &mesh);

  /**
   * Quality of a mesh, checked for computation.
   *
   * Throws MeshError for elements below smallest_scaled_jacobian, with their number and the worst one with its position; and as
   * mesh_quality() does; in degree 2 also as check_curved() does.
   */
  MeshQuality check_mesh(const Mesh &mesh);

  /// Throws MeshError, naming @p where, for duplicate cells and for faces of more than two cells.
  void check_unique(const Mesh &mesh, const std::string &where);

  /**
   * Reorders the nodes of left-handed cells, such as those in mirrored copies or from other programs: all corners have negative Jacobians.
   * Returns their number.
   *
   * Throws MeshError if a reordered cell is on the same side of a face as its neighbour: then it is folded, not left-handed.
   */
  unsigned int make_right_handed(Mesh &mesh);

  /**
   * Throws MeshError, naming @p where, unless the mesh has the required parts: volumes of the disc (is_of_disc()) and other volumes,
   * without common nodes; surfaces `disc_contact` and `pin_contact`, and those in @p additional_surfaces; and every named surface on the
   * outside of the matching bodies (`disc_*` on the disc, `pin_*` on pins).
   */
  void check_parts(const Mesh &mesh, const std::vector<std::string> &additional_surfaces, const std::string &where);

  /// Throws MeshError, naming @p where, for a body in several pieces; for a pin without contact, without clamp and mount, or with clamp and
  /// contact exchanged; and for a mount with all nodes clamped. Requires check_parts().
  void check_bodies(const Mesh &mesh, const std::vector<std::string> &mounted_surfaces, const std::string &where);
} // namespace Squeal
