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
   * The mesh of disc and pins described by the parameters: runs Gmsh on the
   * file in a process of its own (see run_mesher()), then checks names, parts and shapes of what comes out. The same
   * parameters give the same mesh; the supplied plan of disc and pins gives the same
   * mesh in every decimal unit of length.
   *
   * A .geo is given all parameters as variables of the names of the members of
   * GeometryParameters (lists: top_pin_radii(), top_pin_angles(),
   * bottom_pin_radii(), bottom_pin_angles()). What the file holds decides:
   *
   * - physical volumes: a solid, taken as it is (see make_mesh());
   * - physical surfaces and curves only: a plan (see make_plan()), meshed with
   *   quadrilaterals, smoothed and extruded (see smooth(), extrude()). Gmsh halves every element of
   *   a plan after meshing, so sizes in the file are twice those of the mesh.
   *
   * The variables of a .geo are set as GeometryParameters::variables says.
   *
   * @param additional_surfaces names of surfaces that must exist besides those
   *   every geometry has, such as those of elastic mounts
   * @param contact surfaces that rub: their faces are on `disc_contact` and `pin_contact`, too
   * @param communicator processes that all get the mesh; one of them runs Gmsh
   *
   * Throws ParameterError as GeometryParameters::check() does, and MeshError
   * for all that is wrong with file, geometry or mesh, quoting Gmsh's log where
   * Gmsh failed; other processes than the one that ran it throw std::runtime_error then.
   */
  Mesh generate_mesh(const GeometryParameters       &parameters,
                     const std::vector<std::string> &additional_surfaces = {},
                     MPI_Comm                        communicator        = MPI_COMM_SELF,
                     const ContactParameters        &contact             = {});
} // namespace Squeal
