// SPDX-License-Identifier: GPL-3.0-or-later

#include "boxes.h"
#include "faces.h"
#include "solutions.h"

#include <gtest/gtest.h>

#include <set>

using namespace Squeal;
using namespace Squeal::Testing;

// Contact patch test: constant pressure across non-matching flat faces, for all cell shapes.

namespace
{
  struct BlockCase
  {
    const char *name;
    Cut         disc, pin;
    Element     element;
    double      distortion = 0.15; ///< see Box
  };

  void PrintTo(const BlockCase &c, std::ostream *stream)
  {
    *stream << c.name;
  }

  const std::vector<BlockCase> block_cases = {{"3 nodes", Cut::tetrahedra, Cut::tetrahedra, Element::trilinear},
                                              {"4 nodes, rectangles", Cut::hexahedra, Cut::pyramids, Element::trilinear, 0.},
                                              {"4 nodes", Cut::pyramids, Cut::hexahedra, Element::trilinear},
                                              {"3 and 4 nodes", Cut::wedges, Cut::hexahedra, Element::trilinear},
                                              {"both", Cut::mixed, Cut::mixed, Element::trilinear},
                                              {"6 nodes", Cut::tetrahedra, Cut::tetrahedra, Element::quadratic},
                                              {"9 nodes, rectangles", Cut::hexahedra, Cut::hexahedra, Element::quadratic, 0.},
                                              {"9 nodes", Cut::hexahedra, Cut::pyramids, Element::quadratic},
                                              {"6 and 9 nodes", Cut::hexahedra, Cut::wedges, Element::quadratic},
                                              {"9 and 6 nodes", Cut::tetrahedra, Cut::hexahedra, Element::quadratic},
                                              {"both, quadratic", Cut::mixed, Cut::mixed, Element::quadratic}};

  // Number of bricks of the disc block and of the pin block
  const std::array<std::array<unsigned int, 3>, 2> fine = {{{{4, 3, 1}}, {{5, 2, 1}}}}, coarse = {{{{1, 2, 1}}, {{2, 1, 1}}}};

  class Blocks : public ::testing::TestWithParam<BlockCase>
  {
  protected:
    const Scene         s{two_blocks(GetParam().disc, GetParam().pin, fine, GetParam().distortion, "pin_end"), mounted({}), operating(),
                  GetParam().element};
    const SparseMatrix &P_n = *s.contact.normal, &S = *s.contact.reaction, &T_c = *s.contact.kernel;
    const int           n_c = s.interface.size();
  };
  INSTANTIATE_TEST_SUITE_P(Faces, Blocks, ::testing::ValuesIn(block_cases));
} // namespace

TEST_P(Blocks, ConstantPressureIsInEquilibrium)
{
  // Prescribe uniaxial stress along the normal with free lateral expansion
  constexpr double      p = 2e6;
  const Eigen::Vector3d n = block_turn.col(2);
  MultiVector           u(s.model.free_map(), 1);
  for (const unsigned int component : {0, 1})
    {
      const Material material = component == 0 ? MaterialParameters().disc : MaterialParameters().pin;
      u += displacements(s.model, component, [&](const Point3 &point) {
        const Eigen::Vector3d x = Eigen::Vector3d::Map(point.data()) - block_centre;
        const Eigen::Vector3d v = -p / material.young_modulus * ((1. + material.poisson_ratio) * n * n.dot(x) - material.poisson_ratio * x);
        return Point3{{v[0], v[1], v[2]}};
      });
    }

  // Contact forces K u − f with the forces f on both ends
  MultiVector forces = *s.system.stiffness * u;
  for (const Node &node : s.model.nodes())
    for (const int dof : node.dofs)
      if (const int i = forces.map().place(dof);
          i >= 0 && std::abs(n.dot(Eigen::Vector3d::Map(node.position.data()) - block_centre)) > 1e-9)
        forces(i, 0) = 0.;
  // Quadrature is inexact on distorted quadrilaterals, where shape functions are not polynomials of the coordinates
  const bool   has_triangles_only = GetParam().disc == Cut::tetrahedra && GetParam().pin == Cut::tetrahedra;
  const double tolerance          = has_triangles_only || GetParam().distortion == 0. ? 1e-12 : 1e-10;
  EXPECT_LT(largest_entry(transpose_times(T_c, forces)), tolerance * largest_entry(forces));

  const DenseMatrix r    = replicate(S * forces);
  double            area = 0.;
  for (int c = 0; c < n_c; ++c)
    {
      EXPECT_NEAR(r(c, 0), -p * s.interface[c].area, tolerance * p * 0.06 / n_c) << c;
      area += s.interface[c].area;
    }
  EXPECT_NEAR(area, 0.06, 1e-14);
}

TEST_P(Blocks, RigidMotionsDoNotMoveThemAgainstEachOther)
{
  const MultiVector r = rigid_motions(s.model, 0) + rigid_motions(s.model, 1);
  for (const auto &P : {s.contact.normal, s.contact.tangential, s.contact.radial})
    EXPECT_LT(largest_entry(*P * r), 1e-13) << largest_entry(r);
}

TEST_P(Blocks, OperatorsFitTogether)
{
  const auto unit = [](const RowMap &map) { return Testing::diagonal(map, [](int) { return 1.; }); };
  EXPECT_LT(max_norm(*add(1., *multiply(S, P_n, false, true), -1., *unit(P_n.rows()))), 1e-13);
  for (const auto &P : {s.contact.tangential, s.contact.radial})
    EXPECT_LT(max_norm(*multiply(S, *P, false, true)), 1e-13);
  EXPECT_LT(max_norm(*multiply(P_n, T_c)), 1e-13);

  // T_c has dim ker P_n columns and full rank, because it contains a selection of dofs
  EXPECT_EQ(T_c.n_rows(), s.model.free_map().n());
  EXPECT_EQ(T_c.n_columns(), T_c.n_rows() - n_c);
  const auto G = multiply(T_c, T_c, true, false);
  EXPECT_EQ(count_negative_eigenvalues(*add(1., *G, -0.999, *unit(G->rows())), "TᵀT - 1"), 0);
  EXPECT_LT(max_norm(T_c), 10.);
  const MultiVector q = random_vectors(T_c.columns(), 2);
  EXPECT_EQ(largest_entry(coordinates(T_c, T_c * q) - q), 0.);
}

TEST_P(Blocks, ComponentsSlide)
{
  std::set<std::int64_t> nodes_of_disc;
  for (const ContactNode &node : s.interface)
    for (const WeightedNode &on_disc : node.on_disc)
      nodes_of_disc.insert(on_disc.node.number);
  int n_sum = 0;
  for (const Component component : {Component::disc, Component::pins})
    {
      const auto free    = component_kernel(s.model, s.interface, component, ContactBoundary::free),
                 sliding = component_kernel(s.model, s.interface, component, ContactBoundary::sliding);
      const int n_fixed  = component == Component::pins ? n_c : nodes_of_disc.size();
      EXPECT_EQ(sliding->n_columns(), free->n_columns() - n_fixed);
      n_sum += free->n_columns();
      EXPECT_LT(max_norm(*multiply(P_n, *sliding)), 1e-13);
      for (const auto &P : {s.contact.tangential, s.contact.radial})
        EXPECT_GT(max_norm(*multiply(*P, *sliding)), 0.1);
      const MultiVector q = random_vectors(sliding->columns(), 2);
      EXPECT_EQ(largest_entry(coordinates(*sliding, *sliding * q) - q), 0.);
    }
  EXPECT_EQ(n_sum, s.model.free_map().n());
}

TEST(BlocksReactions, AnyLeftInverseGivesTheSameEigenvalues)
{
  for (const Element element : {Element::trilinear, Element::quadratic})
    {
      const bool  is_linear = element == Element::trilinear;
      const Scene s(two_blocks(is_linear ? Cut::tetrahedra : Cut::wedges, Cut::tetrahedra, is_linear ? fine : coarse, 0.15, "pin_clamp"),
                    damped(mounted(held)), operating(RadialDissipation::consistent), element);
      const int   n_c = s.interface.size(), n = s.model.free_map().n();
      DenseMatrix B(3 * n_c, n);
      B << to_dense(*s.contact.normal), to_dense(*s.contact.tangential), to_dense(*s.contact.radial);
      DenseMatrix BW = B;
      for (int i = 0; i < n; ++i)
        BW.col(i) *= 1. + 0.9 * std::sin(1. + i);
      const DenseMatrix pseudo = (BW * B.transpose()).lu().solve(BW).topRows(n_c);

      const auto eigenvalues = [&](const std::shared_ptr<const SparseMatrix> &S, const double mu) {
        ContactOperators contact   = s.contact;
        contact.reaction           = S;
        const auto        matrices = with_friction(couple(s.system, contact, s.damping), mu);
        const DenseMatrix damping  = to_dense(*matrices.damping);
        return dense_quadratic_modes(to_dense(*matrices.mass), &damping, to_dense(*matrices.stiffness), 1e9).values;
      };
      const auto S      = sparse(s.contact.normal->rows(), s.contact.normal->columns(), pseudo);
      const auto values = eigenvalues(s.contact.reaction, 0.4);
      ASSERT_GT(values.size(), 100u);
      EXPECT_GT(max_norm(*add(1., *S, -1., *s.contact.reaction)), 0.1);
      EXPECT_GT(largest(distances(eigenvalues(s.contact.reaction, 0.), values)), 1e-3); // friction changes the eigenvalues
      EXPECT_LT(largest(distances(eigenvalues(S, 0.4), values)), 1e-10);
    }
}
