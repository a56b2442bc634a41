#pragma once

#include <squeal/geometry/gmsh_mesh.h>
#include <squeal/geometry/hex_mesh.h>

#include <iosfwd>
#include <string>
#include <vector>

namespace Squeal
{
  /**
   * The hexahedra and named faces of a meshed three-dimensional model. The
   * disc comes first, then the pins in the order of their physical groups.
   * Nodes that no hexahedron uses are left out.
   *
   * Throws MeshError, naming @p where, for other elements than eight-node
   * hexahedra and four-node quadrilaterals (also of second order), with their
   * count and type; for volumes without a name or named neither `disc` nor
   * `pin_*`; and for surfaces whose name is neither a known one nor in
   * @p additional_surfaces.
   */
  HexMesh make_hex_mesh(const GmshMesh &mesh, const std::vector<std::string> &additional_surfaces, const std::string &where);

  /// Writes a mesh with its physical names as .msh (Gmsh 4.1, text), from where it reads back unchanged.
  void write_msh(const HexMesh &mesh, std::ostream &stream);
} // namespace Squeal
