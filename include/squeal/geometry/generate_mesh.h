// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>
#include <squeal/parameters/contact.h>
#include <squeal/parameters/geometry.h>

#include <mpi.h>

#include <string>
#include <vector>

namespace Squeal
{
  /**
   * Generates the mesh of disc and pins: runs Gmsh on the geometry file in a separate process (see run_mesher()), then checks names, parts
   * and shapes. With the same version of Gmsh, equal parameters and files give equal meshes. If all lengths of the supplied plan of disc
   * and pins are multiplied by a power of ten, the mesh is scaled but otherwise unchanged.
   *
   * A .geo receives the parameters as variables; see GeometryParameters::script_variables(). The physical groups in the file determine its
   * type:
   *
   * - physical volumes: a solid model (see make_mesh());
   * - physical surfaces, but no physical volumes: a plan (see make_plan()), meshed with quadrilaterals, smoothed and extruded (see
   *   smooth(), extrude()). Gmsh halves every element of a plan after meshing; the element sizes in a .geo are therefore twice the sizes
   *   in the mesh.
   *
   * Additional variables of a .geo are set from GeometryParameters::variables.
   *
   * @param additional_surfaces names of further required surfaces, for example of elastic mounts
   * @param contact contact surfaces: their faces are added to `disc_contact` and `pin_contact`
   * @param communicator processes that receive the mesh; one of them runs Gmsh
   *
   * Throws ParameterError if GeometryParameters::check() fails, and MeshError for errors in file, geometry or mesh. If Gmsh fails,
   * processes that did not run it throw std::runtime_error with the same message.
   */
  Mesh generate_mesh(const GeometryParameters       &parameters,
                     const std::vector<std::string> &additional_surfaces = {},
                     MPI_Comm                        communicator        = MPI_COMM_SELF,
                     const ContactParameters        &contact             = {});
} // namespace Squeal
