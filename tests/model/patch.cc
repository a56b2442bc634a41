// SPDX-License-Identifier: GPL-3.0-or-later

#include "boxes.h"
#include "linear_fields.h"
#include "matrices.h"

#include <squeal/bases/rigid_body.h>
#include <squeal/geometry/second_order.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

// Patch test: constant stress in distorted cells of every shape.

namespace
{
  const Mesh::Point below(0.4, -0.1, -0.05), above(0.8, 0.2, 0.1);
  const double      box_volume = 0.4 * 0.3 * 0.15;

  struct PatchCase
  {
    const char *name;
    Cut         cut;
    Element     element;
    bool        is_curved = false; ///< interior second-order nodes are shifted as well
  };

  void PrintTo(const PatchCase &c, std::ostream *stream)
  {
    *stream << c.name;
  }

  const std::vector<PatchCase> patch_cases = {{"hexahedra", Cut::hexahedra, Element::trilinear},
                                              {"hexahedra with incompatible modes", Cut::hexahedra, Element::incompatible_modes},
                                              {"wedges", Cut::wedges, Element::trilinear},
                                              {"pyramids", Cut::pyramids, Element::trilinear},
                                              {"tetrahedra", Cut::tetrahedra, Element::trilinear},
                                              {"mixed", Cut::mixed, Element::trilinear},
                                              {"mixed with incompatible modes", Cut::mixed, Element::incompatible_modes},
                                              {"quadratic hexahedra", Cut::hexahedra, Element::quadratic},
                                              {"quadratic wedges", Cut::wedges, Element::quadratic},
                                              {"quadratic pyramids", Cut::pyramids, Element::quadratic},
                                              {"quadratic tetrahedra", Cut::tetrahedra, Element::quadratic},
                                              {"quadratic, mixed", Cut::mixed, Element::quadratic},
                                              {"curved hexahedra", Cut::hexahedra, Element::quadratic, true},
                                              {"curved wedges", Cut::wedges, Element::quadratic, true},
                                              {"curved pyramids", Cut::pyramids, Element::quadratic, true},
                                              {"curved tetrahedra", Cut::tetrahedra, Element::quadratic, true},
                                              {"curved, mixed", Cut::mixed, Element::quadratic, true}};

  bool is_inside(const double *position)
  {
    for (unsigned int d = 0; d < 3; ++d)
      if (position[d] < below[d] + 1e-9 || position[d] > above[d] - 1e-9)
        return false;
    return true;
  }

  Mesh patch_mesh(const PatchCase &c)
  {
    Mesh mesh;
    add_box(mesh, {c.cut, {{4, 3, 2}}, below, above, 0.2}, "disc", {{"lower", "upper"}});
    if (c.is_curved)
      {
        const std::size_t n_corners = mesh.points.size();
        mesh                        = second_order(mesh);
        std::mt19937                     random(3);
        std::uniform_real_distribution<> shift(-0.003, 0.003);
        for (std::size_t i = n_corners; i < mesh.points.size(); ++i)
          if (is_inside(&mesh.points[i][0]))
            for (unsigned int d = 0; d < 3; ++d)
              mesh.points[i][d] += shift(random);
      }
    return mesh;
  }

  class Patch : public ::testing::TestWithParam<PatchCase>
  {
  protected:
    const Mesh               mesh = patch_mesh(GetParam());
    const Model              model{mesh, GetParam().element, MPI_COMM_WORLD};
    const MaterialParameters materials = mounted({});
    const SecondOrderSystem  system    = assemble(model, materials);
  };
  INSTANTIATE_TEST_SUITE_P(Cells, Patch, ::testing::ValuesIn(patch_cases));
} // namespace

TEST_P(Patch, ConstantStressIsInEquilibrium)
{
  for (const MaterialParameters &material : {materials, orthotropic_disc(skew_orthotropy(), oblique_axes())})
    {
      const MultiVector u = displacements(model, 0, linear_field), f = *assemble(model, material).stiffness * u;
      const double      scale = largest_entry(f);
      double            rest  = 0.;
      for (const Node &node : model.nodes())
        if (is_inside(node.position.data()))
          for (const int dof : node.dofs)
            if (const int i = f.map().place(dof); i >= 0)
              rest = std::max(rest, std::abs(f(i, 0)));
      EXPECT_LT(rest, 1e-12 * scale);
      EXPECT_NEAR(0.5 * gram(u, f)(0, 0) / (box_volume * strain_energy(elastic_tensor(material.of("disc"), oblique_axes()))), 1., 1e-12);
    }
}

TEST_P(Patch, MassAndRigidMotionsAreExact)
{
  const MultiVector r = rigid_motions(model, 0), f = *system.stiffness * r;
  EXPECT_LT(largest_entry(f), 1e-12 * max_norm(*system.stiffness) * largest_entry(r));
  const DenseMatrix M = gram(r, *system.mass * r) / (materials.disc.density * box_volume);
  EXPECT_LT(max_norm(M.topLeftCorner(3, 3) - DenseMatrix::Identity(3, 3)), 1e-12);
}

TEST(PatchElements, IncompatibleModesChangeHexahedraOnly)
{
  const auto stiffness = [](const Cut cut, const Element element) {
    return assemble(Model(patch_mesh({"", cut, element}), element, MPI_COMM_WORLD), mounted({})).stiffness;
  };
  for (const Cut cut : all_cuts)
    {
      const auto   K          = stiffness(cut, Element::trilinear);
      const double difference = max_norm(*add(1., *K, -1., *stiffness(cut, Element::incompatible_modes))) / max_norm(*K);
      if (cut == Cut::hexahedra || cut == Cut::mixed)
        EXPECT_GT(difference, 1e-2);
      else
        EXPECT_EQ(difference, 0.) << int(cut);
    }
}
