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
   * The cells and named faces of a meshed three-dimensional model, with its bodies. Volumes of the disc come first, then the others in the
   * order of their physical groups. Nodes that no cell uses are left out.
   *
   * Tetrahedra, pyramids, prisms and hexahedra of first or second order, mixed, with triangles and quadrilaterals on their faces. Serendipity
   * elements get the nodes that they lack at centres of faces and of hexahedra, where their own functions put them.
   *
   * Throws MeshError, naming @p where, for other elements with their count and type; for elements of both orders; for volumes without a
   * name; and for surfaces whose name is neither a known one nor in @p additional_surfaces.
   */
  Mesh make_mesh(const GmshMesh &mesh, const std::vector<std::string> &additional_surfaces, const std::string &where);

  /// Writes a mesh with its physical names as .msh (Gmsh 4.1, text), from where it reads back unchanged.
  void write_msh(const Mesh &mesh, std::ostream &stream);
} // namespace Squeal
