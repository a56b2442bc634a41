#pragma once

#include <squeal/geometry/hex_mesh.h>
#include <squeal/parameters/materials.h>

namespace Squeal
{
  /// About how many modes there are below a frequency.
  struct ModeCountEstimate
  {
    double disc = 0.; ///< of the free disc [-]
    double pins = 0.; ///< of all pins, held at their backs and sliding on the disc [-]

    /// Of the coupled system.
    double coupled() const;
  };

  /**
   * Estimates the numbers of modes up to @p largest_circular_frequency [rad/s] from volumes and outlines in the mesh and
   * from wave speeds; nothing is assembled. Within a factor of two from some ten modes on.
   *
   * Every body is taken for a prism along z of area S, outline L and height h. A wave of number k in the plane counts
   *
   *   N(k) = (S k² + β L k) / 4π,   β = 1 for free edges, 1.7126 for plate bending (H. Weyl; P. Bertelsen, C. Ellegaard,
   *                                 E. Hugues, Eur. Phys. J. B 15 (2000) 87)
   *
   * modes. Disc: one bending, one shear and one longitudinal wave, each with one uniform motion, and their thickness orders
   * k² = (ω/c)² − (nπ/h)². Pins: bending twice, torsion and extension of a bar, and waves across the section for every order
   * along it. Bending follows 1/ω² = 1/ω_b² + 1/ω_s² with ω_b ∝ k² (thin) and ω_s ∝ k (shear). Mounts are left out.
   */
  ModeCountEstimate expected_number_of_modes(const HexMesh &mesh, const MaterialParameters &materials, double largest_circular_frequency);

  /**
   * Throws ParameterError where an element, of given @p degree, is so long that less than one distance of nodes fits into a shear
   * wave of @p largest_circular_frequency [rad/s]: the modes at the end of the band are those of the mesh.
   */
  void check_wave_resolution(const HexMesh            &mesh,
                             const MaterialParameters &materials,
                             unsigned int              degree,
                             double                    largest_circular_frequency);
} // namespace Squeal
