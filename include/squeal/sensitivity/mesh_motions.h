// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>
#include <squeal/parameters/geometry.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// How the nodes of a mesh move with a length or angle of the geometry, while elements stay what they are.
  struct MeshMotion
  {
    std::string              parameter; ///< "Geometry/Pin height"
    std::string              pin;       ///< the only one that moves; empty: all
    std::string              unit;
    double                   value;         ///< of the parameter, in this unit
    std::vector<Mesh::Point> velocity;      ///< dx/dp of each node [m per unit]
    bool                     moves_contact; ///< whether contact nodes move in the plane of the disc
  };

  /**
   * Motions of disc and pins of the built-in geometry (disc_pins.geo): faces, rims and outlines move as the parameter says, nodes within as it is convenient, so
   * that the bodies stay conforming at the contact. With the disc between z = ± t/2, its axis z, a pin of radius a about c, and ρ = 1 within a
   * circle of radius a about c that falls to 0 on the way to the nearest other pin or rim:
   *
   *   disc thickness t     z/t e_z in the disc, ± ½ e_z in the pins
   *   pin height h         ± (|z| − t/2)/h e_z in the pins
   *   outer radius R       r/R e_r at the rim, falling to 0 at the outermost pin; inner radius likewise
   *   pin diameter d       (x − c)/d within a pin, a/d (x − c)/|x − c| ρ outside
   *   radius of a pin      ρ e_r(c)
   *   angle of a pin       ρ π/180 e_z × x
   *
   * In the disc the latter three vary linearly from the face of the pin to zero on the other one. The derivative of an eigenvalue of the continuum does not depend on
   * how nodes within move; that of a mesh does by its error of discretisation.
   *
   * Empty where the mesh is not that of these parameters or pins touch each other or a rim.
   */
  std::vector<MeshMotion> mesh_motions(const Mesh &mesh, const GeometryParameters &parameters);

  /// The mesh with x + change · dx/dp.
  Mesh moved(Mesh mesh, const MeshMotion &motion, double change);

  /// Largest |dx/dp| [m per unit].
  double largest_velocity(const MeshMotion &motion);
} // namespace Squeal
