// SPDX-License-Identifier: GPL-3.0-or-later

#include "boxes.h"
#include "linear_fields.h"
#include "matrices.h"

#include <squeal/geometry/second_order.h>
#include <squeal/model/elastic_law.h>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  const std::optional<Eigen::Matrix3d> cylindrical;

  Eigen::Matrix3d axes_at(const double angle)
  {
    return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).matrix();
  }

  /// A box around the z axis, with nodes and quadrature points on the axis.
  Mesh box_about_axis(const Cut cut)
  {
    Mesh mesh;
    add_box(mesh, {cut, {{5, 3, 1}}, {-0.5, -0.3, -0.05}, {0.5, 0.3, 0.05}, 0.}, "disc", {{"lower", "upper"}});
    return mesh;
  }

  class OrthotropicElements : public ::testing::TestWithParam<Element>
  {};
  INSTANTIATE_TEST_SUITE_P(Elements,
                           OrthotropicElements,
                           ::testing::Values(Element::trilinear, Element::incompatible_modes, Element::quadratic));

  double largest_difference(const ElasticLaw::Stiffness &C, const double E, const ElasticTensor &expected)
  {
    double result = 0.;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l < 3; ++l)
            result = std::max(result, std::abs(E * C(voigt[i][j], voigt[k][l]) - expected[i][j][k][l]));
    return result / expected.norm();
  }
} // namespace

TEST(ElasticLaws, TurnWithTheirAxes)
{
  const Material fixed = orthotropic_disc(skew_orthotropy(), oblique_axes()).of("disc"),
                 round = orthotropic_disc(skew_orthotropy(), cylindrical).of("disc"), isotropic = mounted({}).of("disc");
  for (const double angle : {0., 0.4, 2., -3.})
    {
      const dealii::Point<3> x(0.2 * std::cos(angle), 0.2 * std::sin(angle), 0.1);
      EXPECT_LT(largest_difference(ElasticLaw(isotropic).at(x), isotropic.young_modulus, elastic_tensor(isotropic)), 1e-14);
      EXPECT_LT(largest_difference(ElasticLaw(fixed).at(x), fixed.young_modulus, elastic_tensor(fixed, oblique_axes())), 1e-14);
      EXPECT_LT(largest_difference(ElasticLaw(round).at(x), round.young_modulus, elastic_tensor(round, axes_at(angle))), 1e-14);
    }
  // On the axis, the radial direction is defined as x
  EXPECT_LT(largest_difference(ElasticLaw(round).at({0., 0., 0.1}), round.young_modulus, elastic_tensor(round)), 1e-14);
}

TEST(ElasticLaws, BarsStretchByTheFormulaOfTheirAngle)
{
  // Uniaxial stress along x, with material axis 1 at an angle to x
  const Orthotropy o = skew_orthotropy();
  for (const double angle : {0., 0.3, 0.8, 0.5 * M_PI})
    {
      const Material material = orthotropic_disc(o, axes_at(angle)).of("disc");
      const double   E1 = material.young_modulus, c = std::cos(angle), s = std::sin(angle);
      const double stretch = std::pow(c, 4) / E1 + std::pow(s, 4) / o.E2 + (1. / o.G12 - 2. * material.poisson_ratio / E1) * s * s * c * c;
      EXPECT_NEAR(ElasticLaw(material).at({}).inverse()(0, 0) / E1 / stretch, 1., 1e-13);
    }
}

TEST_P(OrthotropicElements, WithIsotropicConstantsAreIsotropic)
{
  for (const Cut cut : all_cuts)
    {
      const Model  model(box_about_axis(cut), GetParam(), MPI_COMM_WORLD);
      const auto   isotropic = assemble(model, mounted({}));
      const double E = 210e9, nu = 0.3, G = E / (2. * (1. + nu));
      for (const auto &axes : {cylindrical, std::optional(oblique_axes())})
        {
          const auto system = assemble(model, orthotropic_disc({E, E, nu, nu, G, G, G}, axes));
          EXPECT_LT(max_norm(*add(1., *system.stiffness, -1., *isotropic.stiffness)), 1e-13 * max_norm(*isotropic.stiffness));
          EXPECT_EQ(max_norm(*add(1., *system.mass, -1., *isotropic.mass)), 0.);
        }
    }
}

TEST_P(OrthotropicElements, FrequenciesDoNotChangeWhenMeshAndAxesTurn)
{
  const Eigen::Matrix3d turn        = oblique_axes().transpose() * axes_at(0.6);
  const auto            eigenvalues = [](const Mesh &mesh, const std::optional<Eigen::Matrix3d> &axes) {
    const auto system = assemble(Model(mesh, GetParam(), MPI_COMM_WORLD), orthotropic_disc(skew_orthotropy(), axes));
    return Eigen::GeneralizedSelfAdjointEigenSolver<DenseMatrix>(to_dense(*system.stiffness), to_dense(*system.mass),
                                                                 Eigen::EigenvaluesOnly)
      .eigenvalues()
      .eval();
  };
  Mesh mesh;
  add_box(mesh, {Cut::hexahedra, {{2, 2, 1}}, {0.4, -0.1, -0.05}, {0.8, 0.2, 0.1}, 0.2}, "disc", {{"lower", "upper"}});
  const auto turned = [&](const Eigen::Matrix3d &by) {
    return mapped(mesh, [&](const Point3 &p) {
      const Eigen::Vector3d x = by * Eigen::Vector3d::Map(p.data());
      return Point3{{x[0], x[1], x[2]}};
    });
  };
  const Eigen::VectorXd fixed = eigenvalues(mesh, oblique_axes()), round = eigenvalues(mesh, cylindrical);
  EXPECT_LT((eigenvalues(turned(turn), (turn * oblique_axes()).eval()) - fixed).cwiseAbs().maxCoeff(), 1e-10 * fixed.maxCoeff());
  EXPECT_LT((eigenvalues(turned(axes_at(0.6)), cylindrical) - round).cwiseAbs().maxCoeff(), 1e-10 * round.maxCoeff());
  // The material changes if its axes do not rotate with the mesh
  EXPECT_GT((eigenvalues(turned(turn), oblique_axes()) - fixed).cwiseAbs().maxCoeff(), 1e-3 * fixed.maxCoeff());
}

TEST(OrthotropicRings, RadialFieldsHaveTheirEnergy)
{
  // For u_r = r², ε_r = 2 r and ε_θ = r, and the energy is ½ (4 C_11 + 4 C_12 + C_22) ∫ r² dV
  const double             inner = 0.15, outer = 0.3, height = GeometryParameters().disc_thickness;
  const MaterialParameters materials = orthotropic_disc(skew_orthotropy(), cylindrical);
  const ElasticTensor      C         = elastic_tensor(materials.of("disc"));
  const double             exact =
    0.5 * (4. * C[0][0][0][0] + 4. * C[0][0][1][1] + C[1][1][1][1]) * 2. * M_PI * height * (std::pow(outer, 4) - std::pow(inner, 4)) / 4.;
  const auto error = [&](const int n) {
    const Mesh        mesh = extrude(polar_plan(inner, outer, n, 12 * n, {{Plan::Side::top, 0, 1, 0, 1}}), layers(1, 1));
    const Model       model(mesh, Element::quadratic, MPI_COMM_WORLD);
    const MultiVector u = displacements(model, 0, [](const Point3 &p) {
      const double r = std::hypot(p[0], p[1]);
      return Point3{{r * p[0], r * p[1], 0.}};
    });
    return 0.5 * product(u, *assemble(model, materials).stiffness, u) / exact - 1.;
  };
  const double coarse = error(1), fine = error(2);
  EXPECT_LT(std::abs(fine), 1e-3);
  EXPECT_GT(std::abs(coarse / fine), 3.);
}
