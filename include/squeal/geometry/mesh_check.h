// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// How well cells are shaped.
  struct MeshQuality
  {
    double       worst_scaled_jacobian; ///< 1 for a box and other regular cells, 0 for a flat corner, negative if inverted
    unsigned int worst_element;         ///< index of the cell it was found in
    unsigned int n_bad;                 ///< cells below smallest_scaled_jacobian
  };

  /**
   * Least scaled Jacobian that check_mesh() accepts. Where a round pin is
   * filled by three blocks, each block has a corner on the circle whose angle
   * is 180° - 60°/k, so that the scaled Jacobian sin(60°/k) is small by
   * construction: 0.5 for 19 nodes, 0.26 for 61, 0.1 for k = 10 (331 nodes).
   * These elements are harmless; the limit refuses those that are flat.
   */
  inline constexpr double smallest_scaled_jacobian = 0.02;

  /// Scaled Jacobian: at each corner, the triple product of the three edges that meet there, each divided by its length, relative to that
  /// of a regular cell: 1 for hexahedra, √3/2 for wedges, 1/√2 for tetrahedra and pyramids, of whose corners the apex does not count; the
  /// smallest of a cell. Edges are taken for straight. Throws MeshError for a mesh without elements.
  MeshQuality mesh_quality(const Mesh &mesh);

  /**
   * The quality of a mesh that can be computed on.
   *
   * Throws MeshError for elements below smallest_scaled_jacobian, saying how
   * many there are, which one is the worst and where it is, and as mesh_quality() does; in degree 2 also
   * as check_curved() does.
   */
  MeshQuality check_mesh(const Mesh &mesh);

  /// Throws MeshError, naming @p where, for cells that occur twice, and where more than two share a face.
  void check_unique(const Mesh &mesh, const std::string &where);

  /**
   * Reorders the nodes of left-handed cells, which other programs and mirrored copies make: all corners have negative Jacobians.
   * Returns their number.
   *
   * Throws MeshError for one that then lies on the same side of a face as its neighbour: it is not left-handed, but folded over.
   */
  unsigned int make_right_handed(Mesh &mesh);

  /**
   * Throws MeshError, naming @p where, unless the mesh has the parts that every analysis needs: the disc's volumes (is_of_disc()) and others,
   * with no node in common; surfaces `disc_contact` and `pin_contact`, and those in @p additional_surfaces; and every named surface on the
   * outside of bodies of its kind (`disc_*` on the disc, `pin_*` on pins).
   */
  void check_parts(const Mesh &mesh, const std::vector<std::string> &additional_surfaces, const std::string &where);

  /// Throws MeshError, naming @p where, for a body in several pieces, a pin that touches nothing, that neither a clamp nor a mount holds,
  /// or whose clamp and contact are exchanged; and for a mount whose nodes are all clamped. Needs what check_parts() makes sure of.
  void check_bodies(const Mesh &mesh, const std::vector<std::string> &mounted_surfaces, const std::string &where);
} // namespace Squeal
