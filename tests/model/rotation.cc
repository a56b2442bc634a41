// SPDX-License-Identifier: GPL-3.0-or-later

#include "matrices.h"
#include "scenes.h"

#include <squeal/model/elasticity.h>
#include <squeal/contact/contact_operators.h>
#include <squeal/eigen/dense_quadratic.h>
#include <squeal/eigen/symmetric_modes.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  const std::vector<PolarPin> pins = {{Plan::Side::top, 1, 2, 1, 1}, {Plan::Side::bottom, 5, 2, 0, 1}};

  BodyTerms rotating(const Model &model, const MaterialParameters &materials, const double angular_velocity)
  {
    BodyTerms bodies = body_terms(model, materials);
    add_rotation(bodies, model, angular_velocity);
    return bodies;
  }

  const Term &term_named(const BodyTerms &bodies, const std::string &name)
  {
    return *std::find_if(bodies.terms.begin(), bodies.terms.end(), [&name](const Term &term) { return term.name == name; });
  }

  using Matrix3 = std::array<std::array<double, 3>, 3>;

  Matrix3 times(const Matrix3 &A, const Matrix3 &B)
  {
    Matrix3 result{};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k)
          result[i][j] += A[i][k] * B[k][j];
    return result;
  }

  /// A free ring of hexahedra and its lowest modes; the pins are not used.
  struct Ring
  {
    Ring(const double inner, const double outer, const double thickness, const int n_around, const double band)
      : model(extrude(polar_plan(inner, outer, 1, n_around, {{Plan::Side::top, 0, 1, 0, 1}, {Plan::Side::bottom, 2, 1, 0, 1}}),
                      of_thickness(thickness)),
              Element::quadratic,
              MPI_COMM_WORLD)
      , still(body_terms(model, mounted({})))
      , kernel(component_kernel(model, {}, Component::disc, ContactBoundary::free))
    {
      const SecondOrderSystem all = sparse_matrices(still.terms, still.values);
      SymmetricModesOptions   options;
      options.shift = 0.01 * band * band;
      modes         = symmetric_modes(*congruence(*all.stiffness, *kernel), *congruence(*all.mass, *kernel), band * band, options);
    }

    static GeometryParameters of_thickness(const double thickness)
    {
      GeometryParameters geometry = layers(1, 1);
      geometry.disc_thickness     = thickness;
      return geometry;
    }

    /// Share of axial displacements in the squared norm of a mode.
    double axial_share(const int mode) const
    {
      const MultiVector u       = *kernel * view(*modes.vectors, mode, 1);
      double            sums[2] = {0., 0.};
      for (const Node &node : model.nodes())
        for (int d = 0; d < 3; ++d)
          if (const int i = u.map().place(node.dofs[d]); i >= 0)
            sums[d == 2] += u(i, 0) * u(i, 0);
      sum_over_processes(u.communicator(), sums, 2);
      return sums[1] / (sums[0] + sums[1]);
    }

    /// λ with Im λ > 0 at an angular velocity, of the disc reduced to its modes.
    std::vector<std::complex<double>> lambda(const double angular_velocity) const
    {
      const BodyTerms         bodies = rotating(model, mounted({}), angular_velocity);
      const SecondOrderSystem all    = sparse_matrices(bodies.terms, bodies.values);
      const MultiVector       Phi    = *kernel * *modes.vectors;
      const DenseMatrix       G = gram(Phi, *all.damping * Phi), K = gram(Phi, *all.stiffness * Phi), M = gram(Phi, *all.mass * Phi);
      return dense_quadratic_modes(M, &G, K).values;
    }

    Model                                       model;
    BodyTerms                                   still;
    std::shared_ptr<const Squeal::SparseMatrix> kernel;
    SymmetricModes                              modes;
  };
} // namespace

TEST(Rotation, IsThatOfLinearFields)
{
  // Expect vᵀ G u = ∫ (F x)·(H J x) − (F J x)·(H x) for u = H x, v = F x, J x = e_z × x, computed from ∫ x xᵀ; N accordingly
  const Mesh mesh = mapped(extrude(polar_plan(0.15, 0.3, 3, 12, pins, "inner", "outer"), layers(2, 2)), [](const Point3 &p) {
    return Point3{{p[0] + 0.01 * std::sin(40. * p[1]), p[1] + 0.01 * std::sin(35. * p[0]), p[2] + 0.004 * std::sin(45. * p[0])}};
  });
  for (const Element element : {Element::trilinear, Element::quadratic})
    {
      const Model     model(mesh, element, MPI_COMM_WORLD);
      const BodyTerms bodies = rotating(model, mounted({}), 3.);
      const auto     &M = *term_named(bodies, "mass, disc").matrix, &G = *term_named(bodies, "gyroscopic forces, disc").matrix,
                 &N = *term_named(bodies, "convective stiffness, disc").matrix;

      const auto linear = [&model](const Matrix3 &H) {
        return displacements(model, 0, [&H](const Point3 &p) {
          Point3 u{};
          for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
              u[i] += H[i][j] * p[j];
          return u;
        });
      };
      const Matrix3 F     = {{{{0.3, -1.2, 0.4}}, {{0.8, 0.1, -0.6}}, {{-0.2, 0.9, 0.5}}}},
                    H     = {{{{1.1, 0.3, -0.4}}, {{-0.2, 0.7, 0.9}}, {{0.5, -0.8, -1.3}}}},
                    J     = {{{{0., -1., 0.}}, {{1., 0., 0.}}, {{0., 0., 0.}}}};
      const MultiVector v = linear(F), u = linear(H), turned_v = linear(times(F, J)), turned_u = linear(times(H, J));
      const double      expected = product(v, M, turned_u) - product(turned_v, M, u);
      EXPECT_NEAR(product(v, G, u) / expected, 1., 1e-12);
      EXPECT_NEAR(product(u, G, v) / expected, -1., 1e-12);
      EXPECT_NEAR(product(v, N, u) / product(turned_v, M, turned_u), 1., 1e-12);

      // G is skew-symmetric, N is symmetric
      const DenseMatrix dense = to_dense(G);
      EXPECT_LT(max_norm(dense + dense.transpose()), 1e-14 * max_norm(dense));
      EXPECT_LT(symmetry_defect(N), 1e-14);
      const MultiVector pin = displacements(model, 1, [](const Point3 &p) { return p; });
      EXPECT_EQ(product(pin, N, pin), 0.);
    }
}

TEST(Rotation, SplitsDoubletsByTheDopplerShift)
{
  // Out-of-plane bending waves e^{i(nθ ± ωt)} rotate with the material and have ω ± nΩ in the fixed frame. In-plane waves of a thin
  // ring lag behind the material because of Coriolis forces and have ω ± nΩ (n² − 1) / (n² + 1) (G. H. Bryan, 1890).
  const double        band = 2. * M_PI * 700., speed = 5.;
  const Ring          ring(0.29, 0.31, 0.02, 32, band);
  std::vector<double> omega, found;
  for (const double eigenvalue : ring.modes.eigenvalues)
    omega.push_back(std::sqrt(std::max(eigenvalue, 0.)));
  const int n_rigid = ring.modes.n_rigid_body;
  for (const auto &l : ring.lambda(speed))
    if (l.imag() > 0.5 * omega[n_rigid])
      {
        // Without friction, no mode grows
        EXPECT_LT(std::abs(l.real()), 1e-9 * band);
        found.push_back(l.imag());
      }
  // The two lowest doublets have n = 2; one is in-plane, the other out-of-plane
  constexpr int n         = 2;
  int           n_checked = 0, n_in_plane = 0;
  for (std::size_t j = n_rigid; j + 1 < omega.size() && n_checked < 4; ++j)
    if (omega[j + 1] < (1. + 1e-4) * omega[j])
      {
        const bool axial = ring.axial_share(j) > 0.5;
        n_in_plane += !axial;
        const double mean = 0.5 * (omega[j] + omega[j + 1]), shift = n * speed * (axial ? 1. : (n * n - 1.) / (n * n + 1.));
        for (const double sign : {-1., 1.})
          {
            const double nearest = *std::min_element(found.begin(), found.end(), [&](const double x, const double y) {
              return std::abs(x - mean - sign * shift) < std::abs(y - mean - sign * shift);
            });
            EXPECT_NEAR((nearest - mean) / shift, sign, 0.02) << (axial ? "axial" : "in-plane");
            ++n_checked;
          }
      }
  EXPECT_EQ(n_checked, 4);
  EXPECT_EQ(n_in_plane, 1);
}
