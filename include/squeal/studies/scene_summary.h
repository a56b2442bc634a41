#pragma once

#include <squeal/geometry/hex_mesh.h>
#include <squeal/studies/run.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Disc, or pins that are alike.
  struct BodySummary
  {
    std::vector<std::string> names;                      ///< of the volumes
    double                   inner_radius, outer_radius; ///< least and greatest distance of a node from the z axis [m]
    double                   height;                     ///< extent along z [m]
    double                   contact_area;               ///< of one body [m²]
    double                   volume, mass;               ///< of one body [m³], [kg]
    double                   bar_speed;                  ///< of longitudinal waves in a bar, √(E/ρ) [m/s]
  };

  /// The disc first, then the pins: those with the same height, contact area and volume as one.
  std::vector<BodySummary> summarise_bodies(const HexMesh &mesh, const MaterialParameters &materials);

  /// What in bodies and materials suggests other units than those that the program takes, one sentence each.
  std::vector<std::string> implausible(const std::vector<BodySummary> &bodies, const MaterialParameters &materials);

  /**
   * Says, before the work, what the program understood: sizes, masses, about how many modes
   * to expect and how much memory they take; warns of what is implausible, and refuses what memory
   * cannot hold and a disc that is not round about z but about another axis. Throws MeshError.
   */
  void summarise_scene(const HexMesh &mesh, Run &run);
} // namespace Squeal
