// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/model/elastic_law.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace Squeal
{
  namespace
  {
    /// C / E_1 in the axes of the material.
    ElasticLaw::Stiffness stiffness_in_axes(const Material &material)
    {
      const double          E1 = material.young_modulus, nu12 = material.poisson_ratio;
      const Orthotropy     &o   = *material.orthotropy;
      const double          S23 = -o.nu23 * E1 / o.E2;
      Eigen::Matrix3d       compliance;
      ElasticLaw::Stiffness result = ElasticLaw::Stiffness::Zero();
      compliance << 1., -nu12, -o.nu13, //
        -nu12, E1 / o.E2, S23,          //
        -o.nu13, S23, E1 / o.E3;
      result.topLeftCorner<3, 3>() = compliance.inverse();
      result.diagonal().tail<3>() << o.G23 / E1, o.G13 / E1, o.G12 / E1;
      return result;
    }

    /// C in x, y and z from C in the material axes, which are the columns of R.
    ElasticLaw::Stiffness rotated(const ElasticLaw::Stiffness &C, const Eigen::Matrix3d &R)
    {
      // Rotation of stresses, σ_ij = R_ik R_jl σ_kl
      ElasticLaw::Stiffness turn;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = i; j < 3; ++j)
          for (unsigned int k = 0; k < 3; ++k)
            for (unsigned int l = k; l < 3; ++l)
              turn(voigt[i][j], voigt[k][l]) = R(i, k) * R(j, l) + (k == l ? 0. : R(i, l) * R(j, k));
      return turn * C * turn.transpose();
    }
  } // namespace

  ElasticLaw::ElasticLaw(const Material &material)
  {
    if (!material.orthotropy)
      {
        const double nu = material.poisson_ratio, G = 1. / (2. * (1. + nu)), lame = 2. * G * nu / (1. - 2. * nu);
        stiffness.setZero();
        stiffness.topLeftCorner<3, 3>().setConstant(lame);
        stiffness.diagonal().head<3>().array() += 2. * G;
        stiffness.diagonal().tail<3>().setConstant(G);
        return;
      }
    stiffness      = stiffness_in_axes(material);
    is_cylindrical = !material.has_fixed_axes();
    if (is_cylindrical)
      return;
    const double         *axes  = material.orthotropy->axes->data();
    const Eigen::Vector3d first = Eigen::Vector3d::Map(axes).normalized(), in_plane = Eigen::Vector3d::Map(axes + 3).normalized();
    const Eigen::Vector3d second = (in_plane - first.dot(in_plane) * first).normalized();
    Eigen::Matrix3d       R;
    R << first, second, first.cross(second);
    stiffness = rotated(stiffness, R);
  }

  ElasticLaw::Stiffness ElasticLaw::at(const dealii::Point<3> &x) const
  {
    if (!is_cylindrical)
      return stiffness;
    const double    r = std::hypot(x[0], x[1]), c = r > 0. ? x[0] / r : 1., s = r > 0. ? x[1] / r : 0.;
    Eigen::Matrix3d R;
    R << c, -s, 0., s, c, 0., 0., 0., 1.;
    return rotated(stiffness, R);
  }
} // namespace Squeal
