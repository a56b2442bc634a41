// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/gmsh_mesh.h>
#include <squeal/geometry/mesh.h>

#include <iosfwd>
#include <string>
#include <vector>

namespace Squeal
{
  /**
   * Mesh of a solid model from Gmsh, with its cells, named faces and bodies. Volumes of the disc come first; the others follow in the order
   * of their physical groups. Unused nodes are dropped.
   *
   * Tetrahedra, pyramids, prisms and hexahedra of first or second order may be mixed. Serendipity elements get additional nodes at the
   * centres of faces and hexahedra, at the positions given by their shape functions.
   *
   * Throws a MeshError that names @p where for elements of other types, for mixed element orders, for volumes without a name, and for
   * surfaces whose name is neither standard nor in @p additional_surfaces.
   */
  Mesh make_mesh(const GmshMesh &mesh, const std::vector<std::string> &additional_surfaces, const std::string &where);

  /// Writes a mesh with its physical names as .msh (Gmsh 4.1, text). Reading the file restores the nodes, cells and named faces.
  void write_msh(const Mesh &mesh, std::ostream &stream);
} // namespace Squeal
