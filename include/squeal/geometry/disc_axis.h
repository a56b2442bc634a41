#pragma once

#include <squeal/geometry/hex_mesh.h>

#include <string>

namespace Squeal
{
  /// The axis about which a disc is round, as far as it is, beside the z axis about which the program turns it.
  struct DiscAxis
  {
    dealii::Tensor<1, 3> direction;     ///< unit vector, its largest component positive
    HexMesh::Point       centre;        ///< point of the axis nearest to the disc's centre [m]
    double               angle;         ///< between the axis and z [rad]
    double               offset;        ///< distance of the centre from the z axis [m]
    double               round;         ///< share of the surface that is round about the axis [-]
    double               round_about_z; ///< the same about z [-]
  };

  /**
   * Finds the axis from the disc's outer faces alone, named or not: a rotation (a, v) about
   * it moves the surface within itself, so that n·(a × x + v) vanishes on every
   * face (N. Gelfand, L. J. Guibas, Shape segmentation using local slippage
   * analysis, 2004). The sum of squares over all faces is made least for |a| = 1,
   * with weights that leave out faces that do not fit, such as those of holes and ears.
   */
  DiscAxis find_disc_axis(const HexMesh &mesh);

  /// Throws MeshError, naming @p where, for a disc that is round about another axis than z.
  void check_disc_axis(const DiscAxis &axis, const HexMesh &mesh, const std::string &where);
} // namespace Squeal
