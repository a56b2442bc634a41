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
   * Cells, named faces and bodies of a meshed solid model. Volumes of the disc come first, then the others in the order of their physical
   * groups. Unused nodes are dropped.
   *
   * Tetrahedra, pyramids, prisms and hexahedra of first or second order, mixed, with triangular and quadrilateral faces. Serendipity
   * elements get additional nodes at the centres of faces and hexahedra, at the positions given by their shape functions.
   *
   * Throws MeshError, naming @p where, for other elements, with number and type; for mixed element orders; for volumes without a name; and
   * for surfaces with a name that is neither known nor in @p additional_surfaces.
   */
  Mesh make_mesh(const GmshMesh &mesh, const std::vector<std::string> &additional_surfaces, const std::string &where);

  /// Writes a mesh with its physical names as .msh (Gmsh 4.1, text); reading it returns the same mesh.
  void write_msh(const Mesh &mesh, std::ostream &stream);
} // namespace Squeal
