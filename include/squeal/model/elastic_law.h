// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/parameters/materials.h>

#include <deal.II/base/point.h>

#include <Eigen/Core>

namespace Squeal
{
  /// Index of a pair of directions in Voigt's order xx, yy, zz, yz, xz, xy.
  inline constexpr unsigned int voigt[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};

  /// Hooke's law of a material, divided by its Young's modulus (E_1 of an orthotropic material).
  class ElasticLaw
  {
  public:
    using Stiffness = Eigen::Matrix<double, 6, 6>; ///< C_ijkl in row voigt[i][j] and column voigt[k][l]

    /// Orthonormalises the axes of an orthotropic material by Gram-Schmidt.
    explicit ElasticLaw(const Material &material);

    /// C/E at a point; on the z axis, the radial direction is x.
    Stiffness at(const dealii::Point<3> &x) const;

  private:
    Stiffness stiffness; ///< C/E in the axes of the material if these are cylindrical, else in x, y and z
    bool      is_cylindrical = false;
  };
} // namespace Squeal
