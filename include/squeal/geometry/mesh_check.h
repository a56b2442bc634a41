#pragma once

#include <squeal/geometry/hex_mesh.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// How well hexahedra are shaped.
  struct MeshQuality
  {
    double       worst_scaled_jacobian; ///< 1 for a box, 0 for a flat corner, negative if inverted
    unsigned int worst_element;         ///< index of the hexahedron it was found in
    unsigned int n_bad;                 ///< hexahedra below smallest_scaled_jacobian
  };

  /**
   * Least scaled Jacobian that check_mesh() accepts. Where a round pin is
   * filled by three blocks, each block has a corner on the circle whose angle
   * is 180° - 60°/k, so that the scaled Jacobian sin(60°/k) is small by
   * construction: 0.5 for 19 nodes, 0.26 for 61, 0.1 for k = 10 (331 nodes).
   * These elements are harmless; the limit refuses those that are flat.
   */
  inline constexpr double smallest_scaled_jacobian = 0.02;

  /// Scaled Jacobian: at each corner, the triple product of the three edges that meet there, each divided by its length; the smallest of
  /// the eight. Throws MeshError for a mesh without elements.
  MeshQuality mesh_quality(const HexMesh &mesh);

  /**
   * The quality of a mesh that can be computed on.
   *
   * Throws MeshError for elements below smallest_scaled_jacobian, saying how
   * many there are, which one is the worst and where it is, and as mesh_quality() does.
   */
  MeshQuality check_mesh(const HexMesh &mesh);

  /**
   * Exchanges bottom and top of hexahedra that are left-handed, which other programs and mirrored copies make: all eight corners have
   * negative Jacobians. Returns their number.
   *
   * Throws MeshError for one that then lies on the same side of a face as its neighbour: it is not left-handed, but folded over.
   */
  unsigned int make_right_handed(HexMesh &mesh);

  /**
   * Throws MeshError, naming @p where, unless the mesh has the parts that
   * every analysis needs: volumes `disc` and `pin_*`, surfaces `disc_contact`
   * and `pin_contact`, and those in @p additional_surfaces; no node
   * shared by two volumes; and every named surface on the outside of volumes
   * of its kind (`disc_*` on the disc, `pin_*` on pins).
   */
  void check_parts(const HexMesh &mesh, const std::vector<std::string> &additional_surfaces, const std::string &where);

  /// Throws MeshError, naming @p where, for a body in several pieces, a pin that touches nothing, that neither a clamp nor a mount holds,
  /// or whose clamp and contact are exchanged; and for a mount whose nodes are all clamped. Needs what check_parts() makes sure of.
  void check_bodies(const HexMesh &mesh, const std::vector<std::string> &mounted_surfaces, const std::string &where);
} // namespace Squeal
