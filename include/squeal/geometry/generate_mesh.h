#pragma once

#include <squeal/geometry/hex_mesh.h>
#include <squeal/parameters/geometry.h>

#include <string>
#include <vector>

namespace Squeal
{
  /**
   * The mesh of disc and pins described by the parameters: runs Gmsh on the
   * file, then checks names, parts and shapes of what comes out. The same
   * parameters give the same mesh. Gmsh must not be running already.
   *
   * A .geo is given all parameters as variables of the names of the members of
   * GeometryParameters (lists: top_pin_radii(), top_pin_angles(),
   * bottom_pin_radii(), bottom_pin_angles()). What the file holds decides:
   *
   * - physical volumes: a solid, taken as it is (see make_hex_mesh());
   * - physical surfaces and curves only: a plan (see make_plan()), meshed with
   *   quadrilaterals, smoothed and extruded (see smooth(), extrude()). Gmsh halves every element of
   *   a plan after meshing, so sizes in the file are twice those of the mesh.
   *
   * A file name without a directory is looked for in the current directory,
   * then among the geometries that come with the program.
   *
   * @param additional_surfaces names of surfaces that must exist besides those
   *   every geometry has, such as those of elastic mounts
   *
   * Throws ParameterError as GeometryParameters::check() does, and MeshError
   * for all that is wrong with file, geometry or mesh, quoting Gmsh's log where
   * Gmsh failed.
   */
  HexMesh generate_mesh(const GeometryParameters       &parameters,
                        const std::vector<std::string> &additional_surfaces = {});
} // namespace Squeal
