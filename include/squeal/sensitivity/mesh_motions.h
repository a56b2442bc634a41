// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>
#include <squeal/parameters/geometry.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Motion of the nodes of a mesh when a length or angle of the geometry changes; the topology is unchanged.
  struct MeshMotion
  {
    std::string              parameter; ///< name, for example "Geometry/Pin height"
    std::string              pin;       ///< pin that moves; empty: the parameter applies to the disc or to all pins
    std::string              unit;
    double                   value;
    std::vector<Mesh::Point> velocity;      ///< dx/dp of each node [m per unit]
    bool                     moves_contact; ///< contact nodes move in the plane of the disc
  };

  /**
   * Motions of disc and pins of the built-in geometry (disc_pins.geo): faces, rims and outlines follow the parameter, and interior nodes
   * are interpolated so that the bodies remain conforming at the contact. With the disc between z = ± t/2, its axis z, a pin of radius a
   * about c, and a function ρ that is 1 within a circle of radius a about c and falls to 0 towards the nearest other pin or rim:
   *
   *   disc thickness t     z/t e_z in the disc, ± ½ e_z in the pins
   *   pin height h         ± (|z| − t/2)/h e_z in the pins
   *   outer radius R       r/R e_r at the rim, falling to 0 at the outermost pin; inner radius likewise
   *   pin diameter d       (x − c)/d within a pin, a/d (x − c)/|x − c| ρ outside
   *   radius of a pin      ρ e_r(c)
   *   angle of a pin       ρ π/180 e_z × x
   *
   * In the disc, the last three motions vary linearly from the face of the pin to zero on the opposite face. The derivative of an
   * eigenvalue of the continuum does not depend on the motion of interior nodes; on a mesh, the difference is a discretisation error.
   *
   * Empty if the mesh does not match these parameters, or if pins touch each other or a rim.
   */
  std::vector<MeshMotion> mesh_motions(const Mesh &mesh, const GeometryParameters &parameters);

  /// The mesh with its nodes at x + change · dx/dp.
  Mesh moved(Mesh mesh, const MeshMotion &motion, double change);

  /// Largest |dx/dp| [m per unit].
  double largest_velocity(const MeshMotion &motion);
} // namespace Squeal
