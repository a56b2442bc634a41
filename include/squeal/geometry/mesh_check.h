// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>

#include <string>
#include <vector>

namespace Squeal
{
  struct MeshQuality
  {
    double       worst_scaled_jacobian; ///< 1 for regular cells, for example a box; 0 for a flat corner; negative if inverted
    unsigned int worst_element;         ///< index of the worst cell
    unsigned int n_bad;                 ///< number of cells below smallest_scaled_jacobian
  };

  /**
   * Smallest scaled Jacobian that check_mesh() accepts. If a round pin is filled with three blocks of k x k cells, each block has a corner
   * on the circle with an angle of 180° - 60°/k, so that the scaled Jacobian sin(60°/k) is small by construction: 0.5 for 19 nodes, 0.26
   * for 61, 0.1 for k = 10 (331 nodes). These elements are acceptable; the limit rejects flat elements.
   */
  inline constexpr double smallest_scaled_jacobian = 0.02;

  /// Smallest scaled Jacobian of the cells: the triple product of the three normalised edges at a corner, relative to its value in a
  /// regular cell (1 for hexahedra, √3/2 for wedges, 1/√2 for tetrahedra and for pyramids except at the apex). Edges are assumed straight.
  /// Throws MeshError for a mesh without elements.
  MeshQuality mesh_quality(const Mesh &mesh);

  /**
   * Checks the quality of a mesh and returns it.
   *
   * Throws MeshError for elements below smallest_scaled_jacobian, with their number and the position of the worst one, and if
   * mesh_quality() or, in degree 2, check_curved() throws.
   */
  MeshQuality check_mesh(const Mesh &mesh);

  /// Throws a MeshError that names @p where if there are duplicate cells or faces of more than two cells.
  void check_unique(const Mesh &mesh, const std::string &where);

  /**
   * Reorders the nodes of left-handed cells, whose Jacobians are negative at all corners. Such cells occur in mirrored copies and in meshes
   * of other programs. Returns their number.
   *
   * Throws MeshError if, after reordering, two cells are on the same side of their common face.
   */
  unsigned int make_right_handed(Mesh &mesh);

  /**
   * Throws a MeshError that names @p where unless the mesh has the required parts: volumes of the disc (is_of_disc()) and other volumes,
   * without common nodes; the surfaces `disc_contact`, `pin_contact` and @p additional_surfaces. Named faces must be outer faces. The
   * standard surfaces of the disc (`disc_contact`, `disc_bore`, `disc_rim`) must not be on pins, and vice versa.
   */
  void check_parts(const Mesh &mesh, const std::vector<std::string> &additional_surfaces, const std::string &where);

  /// Throws a MeshError that names @p where for a body in several pieces, except several discs that are all mounted; for a pin that has no
  /// contact, that has neither clamp nor mount, or whose clamp is closer to the disc than its contact; and for a mount whose nodes are all
  /// clamped. Requires check_parts().
  void check_bodies(const Mesh &mesh, const std::vector<std::string> &mounted_surfaces, const std::string &where);
} // namespace Squeal
