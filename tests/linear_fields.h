// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include "scenes.h"

#include <squeal/parameters/materials.h>

#include <deal.II/base/tensor.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace Squeal::Testing
{
  /// Gradient H of the field u = u_0 + H x, which contains all components of strain and rotation.
  inline constexpr double displacement_gradient[3][3] = {{1.1, 0.3, -0.4}, {-0.2, 0.7, 0.9}, {0.5, -0.8, -1.3}};

  inline Point3 linear_field(const Point3 &p)
  {
    Point3 u{{0.2, -0.3, 0.1}};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        u[i] += displacement_gradient[i][j] * p[j];
    return u;
  }

  using ElasticTensor = dealii::Tensor<4, 3>;

  /// C_ijkl [Pa] from the inverse compliance; the columns of @p axes are the material axes.
  inline ElasticTensor elastic_tensor(const Material &material, const Eigen::Matrix3d &axes = Eigen::Matrix3d::Identity())
  {
    ElasticTensor local, result;
    const double  E = material.young_modulus, nu = material.poisson_ratio, G = E / (2. * (1. + nu));
    const auto    o = material.orthotropy.value_or(Orthotropy{E, E, nu, nu, G, G, G});
    // Order of rows: 11, 22, 33, 12, 13, 23
    Eigen::Matrix<double, 6, 6> S = Eigen::Matrix<double, 6, 6>::Zero();
    S.diagonal() << 1. / E, 1. / o.E2, 1. / o.E3, 1. / o.G12, 1. / o.G13, 1. / o.G23;
    S(0, 1) = S(1, 0) = -nu / E;
    S(0, 2) = S(2, 0) = -o.nu13 / E;
    S(1, 2) = S(2, 1)         = -o.nu23 / o.E2;
    const Eigen::MatrixXd C   = S.inverse();
    const auto            row = [](const int i, const int j) { return i == j ? i : i + j + 2; };
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l < 3; ++l)
            local[i][j][k][l] = C(row(i, j), row(k, l));
    for (int n = 0; n < 81 * 81; ++n)
      {
        const int i = n % 3, j = n / 3 % 3, k = n / 9 % 3, l = n / 27 % 3, p = n / 81 % 3, q = n / 243 % 3, r = n / 729 % 3, s = n / 2187;
        result[i][j][k][l] += axes(i, p) * axes(j, q) * axes(k, r) * axes(l, s) * local[p][q][r][s];
      }
    return result;
  }

  /// Strain energy ½ H : C : H of linear_field(), per unit volume.
  inline double strain_energy(const ElasticTensor &C)
  {
    double      energy = 0.;
    const auto &H      = displacement_gradient;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l < 3; ++l)
            energy += 0.5 * H[i][j] * C[i][j][k][l] * H[k][l];
    return energy;
  }

  /// Orthotropic constants without any symmetry between the axes.
  inline Orthotropy skew_orthotropy()
  {
    return {90e9, 30e9, 0.5, 0.2, 50e9, 20e9, 15e9};
  }

  /// Orthonormal axes as columns, none of them along x, y or z.
  inline Eigen::Matrix3d oblique_axes()
  {
    return (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitX()) *
            Eigen::AngleAxisd(1.1, Eigen::Vector3d::UnitY()))
      .matrix();
  }

  /// Materials with an orthotropic disc; fixed axes are given as vectors that are neither normalised nor orthogonal.
  inline MaterialParameters orthotropic_disc(const Orthotropy &constants, const std::optional<Eigen::Matrix3d> &axes)
  {
    MaterialParameters materials = mounted({});
    materials.orthotropic        = {{{210e9, 0.3, 7850., 0., 0., constants}, "disc"}};
    if (axes)
      {
        const Eigen::Vector3d first = 2. * axes->col(0), second = 0.3 * axes->col(1) - 0.8 * axes->col(0);
        materials.axes = {{"disc", {{first[0], first[1], first[2], second[0], second[1], second[2]}}}};
      }
    return materials;
  }
} // namespace Squeal::Testing
