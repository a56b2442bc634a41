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
   * Mesh of disc and pins from the parameters: runs Gmsh on the file in a separate process (see run_mesher()), then checks names, parts and
   * shapes. The same parameters give the same mesh; the supplied plan of disc and pins gives the same mesh in every decimal unit of length.
   *
   * A .geo receives all parameters as variables with the names of the members of GeometryParameters (lists: top_pin_radii(),
   * top_pin_angles(), bottom_pin_radii(), bottom_pin_angles()). The physical groups in the file decide the type:
   *
   * - physical volumes: a solid model, used unchanged (see make_mesh());
   * - physical surfaces and curves only: a plan (see make_plan()), meshed with
   *   quadrilaterals, smoothed and extruded (see smooth(), extrude()). Gmsh halves every element of
   *   a plan after meshing, so sizes in the file are twice those of the mesh.
   *
   * Additional variables of a .geo are set from GeometryParameters::variables.
   *
   * @param additional_surfaces names of further required surfaces, such as those of elastic mounts
   * @param contact contact surfaces: their faces are also on `disc_contact` and `pin_contact`
   * @param communicator processes that receive the mesh; one of them runs Gmsh
   *
   * Throws ParameterError as GeometryParameters::check() does, and MeshError for errors in file, geometry or mesh, with Gmsh's log if Gmsh
   * failed; the processes that did not run Gmsh then throw std::runtime_error.
   */
  Mesh generate_mesh(const GeometryParameters       &parameters,
                     const std::vector<std::string> &additional_surfaces = {},
                     MPI_Comm                        communicator        = MPI_COMM_SELF,
                     const ContactParameters        &contact             = {});
} // namespace Squeal
