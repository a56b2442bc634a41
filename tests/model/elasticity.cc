// SPDX-License-Identifier: GPL-3.0-or-later

#include "linear_fields.h"
#include "matrices.h"
#include "scenes.h"

#include <squeal/bases/component_modes.h>
#include <squeal/linear_algebra/factorization.h>
#include <squeal/model/element_values.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  const std::vector<PolarPin> two_pins = {{Plan::Side::top, 1, 2, 1, 1}, {Plan::Side::bottom, 5, 2, 0, 1}};

  /// Annulus and two pins with polygonal boundaries, smoothly distorted in all directions to warp the faces.
  Mesh distorted_mesh()
  {
    return mapped(extrude(polar_plan(0.15, 0.3, 3, 12, two_pins, "inner", "outer"), layers(2, 2)), [](const Point3 &p) {
      return Point3{{p[0] + 0.01 * std::sin(40. * p[1] + 60. * p[2]), p[1] + 0.01 * std::sin(30. * p[2] + 35. * p[0]),
                     p[2] + 0.004 * std::sin(45. * p[0] - 30. * p[1])}};
    });
  }

  class Elasticity : public ::testing::TestWithParam<Element>
  {
  protected:
    const Mesh         mesh = distorted_mesh();
    const Model        model{mesh, GetParam(), MPI_COMM_WORLD};
    MaterialParameters materials = mounted({});
  };
  INSTANTIATE_TEST_SUITE_P(Elements, Elasticity, ::testing::Values(Element::trilinear, Element::incompatible_modes, Element::quadratic));

  double max_entry(const MultiVector &X)
  {
    return dealii::Utilities::MPI::max(max_norm(X.local()), X.communicator());
  }
} // namespace

TEST_P(Elasticity, ConstantStrainOnADistortedMesh)
{
  const auto        system = assemble(model, materials);
  const MultiVector u      = displacements(model, 0, linear_field);
  const MultiVector f      = *system.stiffness * u;
  EXPECT_NEAR(0.5 * gram(u, f)(0, 0) / (volume(mesh, 0) * strain_energy(elastic_tensor(materials.disc))), 1., 1e-12);

  // A linear field causes no forces on interior nodes
  std::vector<bool> on_boundary(model.nodes().size(), false);
  for (const Face &face : model.faces())
    for (const unsigned int node : face.nodes)
      on_boundary[node] = true;
  unsigned int n_inside = 0;
  double       largest  = 0.;
  for (unsigned int i = 0; i < on_boundary.size(); ++i)
    if (model.nodes()[i].component == 0 && !on_boundary[i])
      {
        ++n_inside;
        for (const int dof : model.nodes()[i].dofs)
          if (const int local = f.map().place(dof); local >= 0)
            largest = std::max(largest, std::abs(f(local, 0)));
      }
  EXPECT_GT(dealii::Utilities::MPI::sum(n_inside, MPI_COMM_WORLD), 10u);
  EXPECT_LT(largest, 1e-12 * max_entry(f));
}

TEST_P(Elasticity, MassOfEachBody)
{
  const auto system = assemble(model, materials);
  for (int k = 0; k < 3; ++k)
    {
      const auto direction = [](const int i) {
        return [i](const Point3 &) { return Point3{{i == 0 ? 1. : 0., i == 1 ? 1. : 0., i == 2 ? 1. : 0.}}; };
      };
      const MultiVector e = displacements(model, 0, direction(k));
      EXPECT_NEAR(product(e, *system.mass, e) / (materials.disc.density * volume(mesh, 0)), 1., 1e-13);
      // Different directions are not coupled
      EXPECT_EQ(product(e, *system.mass, displacements(model, 0, direction((k + 1) % 3))), 0.);
      const MultiVector pin = displacements(model, 1, [](const Point3 &) { return Point3{{1., 1., 1.}}; });
      EXPECT_EQ(product(e, *system.mass, pin), 0.);
      EXPECT_EQ(product(e, *system.stiffness, pin), 0.);
    }
}

TEST_P(Elasticity, EveryBodyHasTermsAndParametersOfItsOwn)
{
  const auto bodies    = body_terms(model, materials);
  const auto total     = sparse_matrices(bodies.terms, bodies.values);
  int        n_entries = 0;
  for (const Term &term : bodies.terms)
    n_entries += term.power == 0 ? term.matrix->n_entries() : 0;
  EXPECT_EQ(n_entries, total.stiffness->n_entries());

  // A change of values after assembly is equivalent to assembly with the new values
  ParameterValues values                  = bodies.values;
  values.at("Young's modulus, pin_top_1") = {3e9};
  values.at("density, pin_top_1")         = {2000.};
  materials.volumes                       = {{{3e9, materials.pin.poisson_ratio, 2000.}, "pin_top_1"}};
  const SecondOrderSystem changed = sparse_matrices(bodies.terms, values), expected = assemble(model, materials);
  EXPECT_EQ(max_norm(*add(1., *changed.stiffness, -1., *expected.stiffness)), 0.);
  EXPECT_EQ(max_norm(*add(1., *changed.mass, -1., *expected.mass)), 0.);
}

TEST_P(Elasticity, MatricesAreSymmetricAndMassIsPositive)
{
  const auto system = assemble(model, mounted({{"inner", 1e10, 2e10, 3e10}}));
  EXPECT_LT(symmetry_defect(*system.mass), 1e-15);
  EXPECT_LT(symmetry_defect(*system.stiffness), 1e-14);
  EXPECT_EQ(count_negative_eigenvalues(*system.mass, "mass"), 0);
  EXPECT_EQ(count_negative_eigenvalues(*system.stiffness, "stiffness"), 0);
}

TEST_P(Elasticity, RayleighDampingIsThatOfEachMaterial)
{
  // Expect α M + β K for displacements of one component, with K without the mount
  materials                     = mounted({{"inner", 1e10, 2e10, 3e10}});
  const auto unmounted          = assemble(model, mounted({}));
  materials.disc.rayleigh_alpha = 3.;
  materials.disc.rayleigh_beta  = 2e-7;
  materials.pin.rayleigh_beta   = 5e-6;
  const auto system             = assemble(model, materials);
  ASSERT_NE(system.damping, nullptr);
  EXPECT_LT(symmetry_defect(*system.damping), 1e-14);

  for (unsigned int component = 0; component <= two_pins.size(); ++component)
    {
      const Material   &material = component == 0 ? materials.disc : materials.pin;
      const MultiVector u        = displacements(model, component, [](const Point3 &p) {
        return Point3{{std::sin(30. * p[1]) + 0.2, std::cos(20. * p[0]), p[2] * std::sin(15. * p[0])}};
      });
      const double      expected =
        material.rayleigh_alpha * product(u, *unmounted.mass, u) + material.rayleigh_beta * product(u, *unmounted.stiffness, u);
      EXPECT_NEAR(product(u, *system.damping, u) / expected, 1., 1e-12);
    }
}

TEST_P(Elasticity, MountsResistInTheirDirections)
{
  const Mesh  mesh = extrude(polar_plan(0.15, 0.3, 3, 12, two_pins, "inner", "outer"), layers(2, 2));
  const Model model(mesh, GetParam(), MPI_COMM_WORLD);

  // Area of the polygonal bore and ∫r² dA
  double       area = 0., r2_area = 0.;
  const double t = GeometryParameters().disc_thickness, side = 2. * 0.15 * std::sin(M_PI / 12.), apothem = 0.15 * std::cos(M_PI / 12.);
  area    = 12. * side * t;
  r2_area = area * (apothem * apothem + side * side / 12.);

  const auto energy = [&](const Mount &mount, const std::function<Point3(const Point3 &)> &motion) {
    const auto        with = assemble(model, mounted({mount})), without = assemble(model, mounted({}));
    const MultiVector u = displacements(model, 0, motion);
    return 0.5 * product(u, *add(1., *with.stiffness, -1., *without.stiffness), u);
  };
  const double k         = 3e10;
  const auto   axial     = [](const Point3 &) { return Point3{{0., 0., 1.}}; };
  const auto   across    = [](const Point3 &) { return Point3{{0.6, 0.8, 0.}}; };
  const auto   turning   = [](const Point3 &p) { return Point3{{-p[1], p[0], 0.}}; };
  const auto   breathing = [](const Point3 &p) { return Point3{{p[0], p[1], 0.}}; };
  EXPECT_NEAR(energy({"inner", 0., 0., k}, axial) / (0.5 * k * area), 1., 1e-11);
  EXPECT_NEAR(energy({"inner", 0., k, 0.}, turning) / (0.5 * k * r2_area), 1., 1e-11);
  EXPECT_NEAR(energy({"inner", k, 0., 0.}, breathing) / (0.5 * k * r2_area), 1., 1e-11);
  EXPECT_NEAR(energy({"inner", k, k, 0.}, across) / (0.5 * k * area), 1., 1e-11);
  // The damping matrix of dashpots equals the stiffness of springs with the same coefficients
  MaterialParameters dashpots = mounted({});
  dashpots.dashpots           = {{"inner", 2. * k, 3. * k, k}};
  const auto springs = assemble(model, mounted({{"inner", 2. * k, 3. * k, k}})), none = assemble(model, mounted({})),
             damped_bore = assemble(model, dashpots);
  EXPECT_EQ(none.damping, nullptr);
  EXPECT_LT(max_norm(*add(1., *damped_bore.stiffness, -1., *none.stiffness)), 1e-15 * max_norm(*none.stiffness));
  EXPECT_LT(max_norm(*linear_combination({{1., springs.stiffness.get()}, {-1., none.stiffness.get()}, {-1., damped_bore.damping.get()}})),
            1e-14 * max_norm(*springs.stiffness));
  // The mean of e_r ⊗ e_r over the circle is one half of the identity
  EXPECT_NEAR(energy({"inner", k, 0., 0.}, across) / (0.25 * k * area), 1., 1e-11);
}

namespace
{
  /// Frequency [rad/s] of the mode of the clamped-free pin that is most similar to @p shape.
  double pin_frequency(const Mesh                                  &mesh,
                       const MaterialParameters                    &materials,
                       const Element                                element,
                       const std::function<Point3(const Point3 &)> &shape,
                       const double                                 limit)
  {
    const Model model(mesh, element, MPI_COMM_WORLD);
    const auto  interface = contact_nodes(model, ContactParameters().pairs, Rotation::positive, 1e-6).interface;
    const auto  system    = assemble(model, materials);
    const auto  modes     = component_modes(model, interface, interface, system, Component::pins, ContactBoundary::free, limit * limit, {});
    const MultiVector u   = displacements(model, 1, shape);
    const DenseMatrix shares = gram(u, *system.mass * *modes.vectors);
    int               best   = 0;
    for (int j = 0; j < shares.cols(); ++j)
      if (std::abs(shares(0, j)) > std::abs(shares(0, best)))
        best = j;
    EXPECT_GT(shares(0, best) * shares(0, best) / product(u, *system.mass, u), 0.95);
    return std::sqrt(modes.eigenvalues[best]);
  }

  /// Quarter-wave of a cosine over the height of an upper pin, largest at the contact.
  double quarter_wave(const double z)
  {
    const GeometryParameters geometry;
    return std::cos(0.5 * M_PI * (z - geometry.disc_thickness / 2.) / geometry.pin_height);
  }
} // namespace

TEST_P(Elasticity, LongitudinalVibrationOfABarConverges)
{
  // For ν = 0, the longitudinal mode has ω = π c / (2 L) with c = √(E/ρ) for any cross-section; refine the mesh along the axis
  MaterialParameters materials = mounted({});
  materials.pin.poisson_ratio  = 0.;
  const double length          = GeometryParameters().pin_height;
  const double exact           = 0.5 * M_PI / length * std::sqrt(materials.pin.young_modulus / materials.pin.density);
  const auto   plan            = polar_plan(0.15, 0.3, 2, 12, {{Plan::Side::top, 0, 1, 0, 1}}, "inner", "outer");

  std::vector<double> errors;
  for (const int n : {1, 2, 4})
    errors.push_back(pin_frequency(
                       extrude(plan, layers(1, n)), materials, GetParam(),
                       [](const Point3 &p) {
                         return Point3{{0., 0., quarter_wave(p[2])}};
                       },
                       1.5 * exact) /
                       exact -
                     1.);
  for (std::size_t i = 1; i < errors.size(); ++i)
    {
      const double order = std::log2(errors[i - 1] / errors[i]);
      EXPECT_GT(errors[i], 0.); // convergence is from above, as in a Rayleigh–Ritz method
      EXPECT_NEAR(order, 2. * degree_of(GetParam()), 0.1 + (i == 1 ? 0.3 : 0.)) << "error " << errors[i];
    }
}

TEST(Assembly, TorsionOfACylinderOnCurvedElements)
{
  // The torsional mode of a circular cross-section has ω = π c_s / (2 L) with c_s = √(G/ρ)
  const MaterialParameters materials = mounted({});
  const double             G         = materials.pin.young_modulus / (2. * (1. + materials.pin.poisson_ratio));
  const double             exact     = 0.5 * M_PI / GeometryParameters().pin_height * std::sqrt(G / materials.pin.density);
  const auto               error     = [&](const Element element, const int n) {
    const auto turning = [](const Point3 &p) { return Point3{{-p[1] * quarter_wave(p[2]), (p[0] - 0.2) * quarter_wave(p[2]), 0.}}; };
    return pin_frequency(extrude(round_plan(0.2, 0.026, n), layers(1, 2 * n)), materials, element, turning, 1.2 * exact) / exact - 1.;
  };
  // With geometry of the same order, errors converge with the order of the element
  const double coarse = error(Element::quadratic, 1), fine = error(Element::quadratic, 2);
  EXPECT_LT(std::abs(fine), 1e-4);
  EXPECT_GT(std::abs(coarse) / std::abs(fine), 12.);
  // With polygons, errors converge with order 2
  const double polygon_coarse = error(Element::trilinear, 2), polygon_fine = error(Element::trilinear, 4);
  EXPECT_NEAR(std::log2(polygon_coarse / polygon_fine), 2., 0.15);
}

TEST(Assembly, CurvedElementsHaveTheVolumeOfTheAnnulus)
{
  const MaterialParameters materials = mounted({});
  for (const double unit : {1., 1e-6, 1e4}) // unit of length
    {
      auto mesh = extrude(polar_plan(0.15, 0.3, 2, 24, {{Plan::Side::top, 0, 1, 0, 1}}), layers(1, 1));
      for (auto &point : mesh.points)
        point *= unit;
      const Model       model(mesh, Element::quadratic, MPI_COMM_WORLD);
      const auto        system = assemble(model, materials);
      const MultiVector e      = displacements(model, 0, [](const Point3 &) { return Point3{{1., 0., 0.}}; });
      const double      volume = GeometryParameters().disc_thickness * M_PI * (0.3 * 0.3 - 0.15 * 0.15) * std::pow(unit, 3);
      // Polygons with 24 sides would have an error of 1.1 %
      EXPECT_NEAR(product(e, *system.mass, e) / (materials.disc.density * volume), 1., 1e-4) << unit;
    }
}

TEST_P(Elasticity, VolumesOfABodyHaveTermsOfTheirOwn)
{
  // A separate volume of a pin changes results only with a different material
  Mesh halves = mesh;
  halves.volume_names.push_back("pin_top_1_backplate");
  halves.body_of_volume.push_back(1);
  for (Mesh::Cell &cell : halves.cells)
    if (cell.volume == 1 && centre(halves, cell)[2] > 0.5 * (GeometryParameters().disc_thickness + GeometryParameters().pin_height))
      cell.volume = 3;
  const Model other(halves, GetParam(), MPI_COMM_WORLD);
  ASSERT_EQ(other.volumes_of(1), (std::vector<unsigned int>{1, 3}));
  const auto whole = assemble(model, materials), parts = assemble(other, materials);
  EXPECT_LT(max_norm(*add(1., *parts.stiffness, -1., *whole.stiffness)), 1e-14 * max_norm(*whole.stiffness));
  EXPECT_LT(max_norm(*add(1., *parts.mass, -1., *whole.mass)), 1e-14 * max_norm(*whole.mass));

  materials.volumes      = {{{210e9, 0.3, 7850.}, "pin_top_1_backplate"}};
  const BodyTerms bodies = body_terms(other, materials);
  EXPECT_EQ(bodies.values.at("Young's modulus, pin_top_1_backplate"), std::vector<double>{210e9});
  EXPECT_EQ(bodies.values.at("density, pin_top_1"), std::vector<double>{materials.pin.density});
}

TEST_P(Elasticity, MassesOnSurfacesMoveWithThem)
{
  const MultiVector e      = displacements(model, 1, [](const Point3 &) { return Point3{{0.6, 0., 0.8}}; });
  const auto        before = assemble(model, materials);
  materials.masses         = {{PhysicalNames::pin_contact, 50.}};
  double        area       = 0.;
  ElementValues values(model);
  for (const Face *face : model.faces_of(PhysicalNames::pin_contact))
    if (face->component == 1 && face->is_own)
      {
        values.reinit(*face);
        for (unsigned int q = 0; q < values.n_points(); ++q)
          area += values.JxW(q);
      }
  area             = dealii::Utilities::MPI::sum(area, MPI_COMM_WORLD);
  const auto after = assemble(model, materials);
  EXPECT_NEAR((product(e, *after.mass, e) - product(e, *before.mass, e)) / (50. * area), 1., 1e-9);
}
