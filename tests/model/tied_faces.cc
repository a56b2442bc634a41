// SPDX-License-Identifier: GPL-3.0-or-later

#include "boxes.h"
#include "matrices.h"

#include <squeal/bases/rigid_body.h>
#include <squeal/geometry/second_order.h>
#include <squeal/geometry/tied_faces.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

// Patch test of tied faces: constant stress is transmitted between two blocks of tetrahedra, wedges or hexahedra.

namespace
{
  struct TieCase
  {
    const char *name;
    Cut         lower, upper;
    Element     element;
    double      distortion = 0.15; ///< see Box
  };

  void PrintTo(const TieCase &c, std::ostream *stream)
  {
    *stream << c.name;
  }

  const std::vector<TieCase> tie_cases = {{"3 nodes", Cut::tetrahedra, Cut::tetrahedra, Element::trilinear},
                                          {"rectangles", Cut::hexahedra, Cut::hexahedra, Element::trilinear, 0.},
                                          {"3 and 4 nodes", Cut::wedges, Cut::hexahedra, Element::incompatible_modes},
                                          {"6 nodes", Cut::tetrahedra, Cut::tetrahedra, Element::quadratic},
                                          {"9 and 6 nodes", Cut::tetrahedra, Cut::hexahedra, Element::quadratic},
                                          {"6 and 9 nodes", Cut::hexahedra, Cut::wedges, Element::quadratic}};

  constexpr double edge = 0.1; // height of each box; the other sides are 3 and 2 times as long

  Mesh tied_boxes(const TieCase &c)
  {
    Mesh mesh;
    add_box(mesh, {c.lower, {{4, 3, 1}}, {0., 0., -edge}, {3. * edge, 2. * edge, 0.}, c.distortion, 1}, "disc", {{"end", "below"}});
    add_box(mesh, {c.upper, {{5, 2, 1}}, {0., 0., 0.}, {3. * edge, 2. * edge, edge}, c.distortion, 2}, "hub", {{"above", "other_end"}});
    mesh.tied = {{"above", "below"}};
    find_bodies(mesh);
    return mesh;
  }

  class Tied : public ::testing::TestWithParam<TieCase>
  {
  protected:
    const Mesh               mesh = tied_boxes(GetParam());
    const Model              model{mesh, GetParam().element, MPI_COMM_WORLD};
    const MaterialParameters materials = [] {
      MaterialParameters result = mounted({});
      result.pin                = result.disc;
      return result;
    }();
    const SecondOrderSystem system = assemble(model, materials);
    // The quadrature of the coupling is inexact on distorted quadrilaterals, where integrands are not polynomials
    const double tolerance =
      GetParam().distortion == 0. || GetParam().name == std::string("3 nodes") || GetParam().name == std::string("6 nodes") ? 1e-12 : 1e-10;
  };
  INSTANTIATE_TEST_SUITE_P(Cells, Tied, ::testing::ValuesIn(tie_cases));
} // namespace

TEST_P(Tied, ConstantStressPasses)
{
  ASSERT_EQ(model.component_names(), std::vector<std::string>{"disc"});
  // Prescribe uniaxial stress along the normal of the tied faces, plus a rotation; the other faces are free
  const double      nu      = materials.disc.poisson_ratio;
  const double      H[3][3] = {{-nu, 0.3, -0.4}, {-0.3, -nu, 0.9}, {0.4, -0.9, 1.}};
  const MultiVector u       = displacements(model, 0, [&](const Point3 &p) {
    Point3 value{{0.2, -0.3, 0.1}};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        value[i] += H[i][j] * p[j];
    return value;
  });
  const MultiVector f       = *system.stiffness * u;
  double            rest    = 0.;
  for (const Node &node : model.nodes())
    if (std::abs(node.position[2]) < edge - 1e-9)
      for (const int dof : node.dofs)
        if (const int i = f.map().place(dof); i >= 0)
          rest = std::max(rest, std::abs(f(i, 0)));
  EXPECT_LT(rest, tolerance * largest_entry(f));
}

TEST_P(Tied, MovesAsARigidBody)
{
  const MultiVector r = rigid_motions(model, 0);
  EXPECT_LT(largest_entry(*system.stiffness * r), tolerance * max_norm(*system.stiffness) * largest_entry(r));
  const double      mass = materials.disc.density * 12. * edge * edge * edge;
  const DenseMatrix M    = gram(r, *system.mass * r) / mass;
  EXPECT_LT(max_norm(M.topLeftCorner(3, 3) - DenseMatrix::Identity(3, 3)), 1e-12);
}

TEST(TiedNodes, ReproduceLinearFunctions)
{
  for (const TieCase &c : tie_cases)
    {
      SCOPED_TRACE(c.name);
      Mesh mesh = tied_boxes(c);
      if (degree_of(c.element) == 2)
        mesh = second_order(mesh);
      const TiedNodes tied = tied_nodes(mesh);
      for (const auto &[slave, row] : tied.masters)
        {
          Mesh::Point place;
          double      sum = 0.;
          for (const auto &[master, weight] : row)
            {
              EXPECT_EQ(tied.masters.count(master), 0u);
              place += weight * mesh.points[master];
              sum += weight;
            }
          EXPECT_NEAR(sum, 1., 1e-13);
          EXPECT_LT(place.distance(mesh.points[slave]), 1e-10 * edge);
        }
      EXPECT_GE(tied.masters.size(), 18u);
    }
}
