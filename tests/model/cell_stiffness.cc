// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/model/cell_stiffness.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

using namespace Squeal;
using namespace dealii;

namespace
{
  using Field = std::function<Tensor<1, 3>(const Point<3> &)>;

  constexpr double a = 0.7, b = 0.3, h = 0.05; ///< sides of the box

  struct Energy
  {
    double value;    ///< ½ uᵀ K u
    double rounding; ///< error bound: machine epsilon times the number of terms and the sum of their moduli
  };

  /// Energy of a box about the origin with nodal displacements @p field.
  Energy energy(const Element element, const double poisson_ratio, const Field &field)
  {
    Mesh mesh;
    for (const Point<3> &p : reference_nodes(Shape::hexahedron, 1))
      mesh.points.emplace_back(a * (p[0] - 0.5), b * (p[1] - 0.5), h * (p[2] - 0.5));
    mesh.cells        = {{Shape::hexahedron, {0, 1, 2, 3, 4, 5, 6, 7}, 0}};
    mesh.volume_names = {"disc"};
    find_bodies(mesh);
    const Model   model(mesh, element, MPI_COMM_SELF);
    ElementValues values(model);
    values.reinit(model.cells().front());
    FullMatrix<double> K(3 * values.n_nodes());
    add_stiffness(values, element, ElasticLaw(Material{1., poisson_ratio, 1.}), K);

    std::vector<double> u;
    for (unsigned int i = 0; i < values.n_nodes(); ++i)
      for (unsigned int c = 0; c < 3; ++c)
        u.push_back(field(values.node(i))[c]);
    Energy result{0., 0.};
    for (unsigned int i = 0; i < u.size(); ++i)
      for (unsigned int j = 0; j < u.size(); ++j)
        {
          result.value += 0.5 * u[i] * K(i, j) * u[j];
          result.rounding += 0.5 * std::abs(u[i] * K(i, j) * u[j]);
        }
    result.rounding *= u.size() * std::numeric_limits<double>::epsilon();
    return result;
  }

  /// Displacement of pure bending with unit curvature about y and anticlastic curvature: σ_x = E z, all other stresses are zero.
  Field bending(const double nu)
  {
    return [nu](const Point<3> &p) {
      const double x = p[0], y = p[1], z = p[2];
      return Tensor<1, 3>({x * z, -nu * y * z, -0.5 * (x * x + nu * (z * z - y * y))});
    };
  }
} // namespace

TEST(CellStiffness, OneCellBendsAsABeamDoes)
{
  // The exact energy is ½ E I a with E = 1
  const double exact = 0.5 * a * b * h * h * h / 12.;
  for (const double nu : {0., 0.25, 0.3, 0.49})
    {
      const Energy trilinear = energy(Element::trilinear, nu, bending(nu)), bent = energy(Element::incompatible_modes, nu, bending(nu)),
                   quadratic = energy(Element::quadratic, nu, bending(nu));
      // Condensation subtracts from the trilinear energy, whose rounding error remains
      EXPECT_NEAR(bent.value, exact, trilinear.rounding) << nu;
      EXPECT_NEAR(quadratic.value, exact, quadratic.rounding) << nu;
      EXPECT_LT(std::max(trilinear.rounding, quadratic.rounding), 1e-7 * exact) << nu;

      // Trilinear elements have ε_z = 0 and the parasitic shears γ_xz = x, γ_yz = −ν y
      const double G = 1. / (2. * (1. + nu)), lame = 2. * G * nu / (1. - 2. * nu), trace = 1. - nu;
      const double I     = b * h * h * h / 12. * a;
      const double shear = 0.5 * G * (a * a * a * b * h + nu * nu * b * b * b * a * h) / 12.;
      EXPECT_NEAR(trilinear.value / (I * (G * (1. + nu * nu) + 0.5 * lame * trace * trace) + shear), 1., 1e-12);
      EXPECT_GT(trilinear.value, 50. * exact);
    }
}
