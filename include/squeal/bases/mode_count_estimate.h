#pragma once

#include <squeal/geometry/hex_mesh.h>
#include <squeal/parameters/materials.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// What the mesh says of a body.
  struct BodyShape
  {
    std::string name;                       ///< of its volume
    double      inner_radius, outer_radius; ///< least and greatest distance of a node from the z axis [m]
    double      height;                     ///< extent along z [m]
    double      volume;                     ///< [m³]
    double      outline;                    ///< of a section across z: area of the upright faces over the height [m]
    double      contact_area;               ///< [m²]
  };

  /// Those of all volumes of the mesh, in their order: the disc first.
  std::vector<BodyShape> body_shapes(const HexMesh &mesh);

  /**
   * Estimates the number of modes of the coupled system up to @p largest_circular_frequency [rad/s] from volumes and outlines in the mesh and
   * from wave speeds; nothing is assembled. Within a factor of two from some ten modes on.
   *
   * Every body is taken for a prism along z of area S, outline L and height h. A wave of number k in the plane counts
   *
   *   N(k) = (S k² + β L k) / 4π,   β = 1 for free edges, 1.7126 for plate bending (H. Weyl; P. Bertelsen, C. Ellegaard,
   *                                 E. Hugues, Eur. Phys. J. B 15 (2000) 87)
   *
   * modes. Disc: one bending, one shear and one longitudinal wave, each with one uniform motion, and their thickness orders
   * k² = (ω/c)² − (nπ/h)². Pins: bending twice, torsion and extension of a bar, and waves across the section for every order
   * along it. Bending follows 1/ω² = 1/ω_b² + 1/ω_s² with ω_b ∝ k² (thin) and ω_s ∝ k (shear). Mounts are left out, and so is the
   * coupling: the sum of the modes of the free disc and of the pins, held at their backs and sliding on the disc.
   */
  double expected_number_of_modes(const HexMesh &mesh, const MaterialParameters &materials, double largest_circular_frequency);

  /**
   * Throws ParameterError where an element, of given @p degree, is so long that less than one distance of nodes fits into a shear
   * wave of @p largest_circular_frequency [rad/s]: the modes at the end of the band are those of the mesh.
   */
  void check_wave_resolution(const HexMesh            &mesh,
                             const MaterialParameters &materials,
                             unsigned int              degree,
                             double                    largest_circular_frequency);
} // namespace Squeal
