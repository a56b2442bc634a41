// SPDX-License-Identifier: GPL-3.0-or-later

#include "faces.h"

#include <squeal/bases/rigid_body.h>
#include <squeal/bases/static_modes.h>
#include <squeal/linear_algebra/multivector.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr double band = 2. * M_PI * 5000.;

  Scene scene(const Case &c, const MaterialParameters &materials, const RadialDissipation dissipation = RadialDissipation::none)
  {
    const std::vector<PolarPin> pins = {{Plan::Side::top, 0, 2, 1, 1}, {Plan::Side::bottom, -1, 2, 0, 1}};
    return Scene(sloped(extrude(polar_plan(0.15, 0.3, 3, 12, pins), layers(1, 2)), c.slope), materials, operating(dissipation), c.element);
  }

  struct Modes
  {
    explicit Modes(const Case &c)
      : s(scene(c, mounted(c.mounts)))
      , response(static_response(s.model, s.system, band, FactorizationLibrary::automatic))
      , modes(s.model, s.interface, s.contact, s.system, response, band, FactorizationLibrary::automatic)
    {}

    Scene         s;
    InertiaRelief response;
    StaticModes   modes;
  };

  /// Pᵀ with zero rows for the other component.
  MultiVector forces(const Scene &s, const SparseMatrix &P, const Component component)
  {
    MultiVector f = transpose_times(P, unit_vectors(P.rows()));
    for (const Node &node : s.model.nodes())
      if ((node.component == 0) != (component == Component::disc))
        for (const int dof : node.dofs)
          if (const int i = f.map().place(dof); i >= 0)
            for (int j = 0; j < f.n_columns(); ++j)
              f(i, j) = 0.;
    return f;
  }

  /// Largest ‖K u − f + M N Nᵀf‖ / ‖f‖ over the columns.
  double residual(const Modes &m, const MultiVector &u, MultiVector f)
  {
    const auto norms = column_norms(f);
    if (const MultiVector *N = m.modes.response.rigid_body_modes())
      multiply_add(-1., *m.s.system.mass * *N, gram(*N, f), 1., f);
    MultiVector rest = *m.s.system.stiffness * u;
    rest -= f;
    return (as_column(column_norms(rest)).array() / as_column(norms).array()).maxCoeff();
  }

  double largest_norm(const MultiVector &X)
  {
    return max_norm(as_column(column_norms(X)));
  }

  class StaticModesOf : public ::testing::TestWithParam<Case>
  {
  protected:
    const Modes             m   = Modes(GetParam());
    const ContactOperators &P   = m.s.contact;
    const int               n_c = m.s.interface.size();
  };
  INSTANTIATE_TEST_SUITE_P(Held, StaticModesOf, ::testing::ValuesIn(held_cases));
  INSTANTIATE_TEST_SUITE_P(Free, StaticModesOf, ::testing::ValuesIn(free_cases));
} // namespace

TEST_P(StaticModesOf, AttachmentModesAreStaticResponses)
{
  ASSERT_EQ(m.modes.normal_attachment().n_columns(), n_c);
  const auto f = [](const SparseMatrix &P) { return transpose_times(P, unit_vectors(P.rows())); };
  // Errors of a held flat disc with trilinear elements are at rounding level
  const bool is_simple = GetParam().slope == 0. && GetParam().element == Element::trilinear && GetParam().n_free == 0;
  EXPECT_LT(residual(m, m.modes.normal_attachment(), f(*P.normal)), is_simple ? 1e-11 : 1e-9);
  EXPECT_LT(residual(m, m.modes.tangential_attachment(), f(*P.tangential)), 1e-9);

  // Responses to forces on the two components add up
  MultiVector rest = m.modes.normal_attachment(), f_pins = forces(m.s, *P.normal, Component::pins);
  f_pins *= -1.;
  EXPECT_LT(residual(m, m.modes.normal_attachment(Component::disc), forces(m.s, *P.normal, Component::disc)), 1e-9);
  EXPECT_LT(residual(m, m.modes.normal_attachment(Component::pins), f_pins), 1e-9);
  rest.local() -= m.modes.normal_attachment(Component::disc).local() - m.modes.normal_attachment(Component::pins).local();
  EXPECT_EQ(max_norm(replicate(rest)), 0.);

  // Rubbing modes are responses to a normal force and its friction force
  const double mu      = 0.37;
  MultiVector  rubbing = f(*P.normal);
  rubbing.local() += mu * f(*P.tangential).local();
  EXPECT_LT(residual(m, m.modes.rubbing_attachment(mu), rubbing), 1e-9);

  // Inertia relief removes the rigid-body motions of a free disc
  const MultiVector *N = m.modes.response.rigid_body_modes(), &u = m.modes.normal_attachment();
  ASSERT_EQ(N != nullptr ? N->n_columns() : 0, GetParam().n_free);
  if (N == nullptr)
    return;
  const MultiVector MN = *m.s.system.mass * *N;
  EXPECT_LT(max_norm(gram(*N, MN) - DenseMatrix::Identity(N->n_columns(), N->n_columns())), 1e-12);
  EXPECT_LT(largest_norm(*m.s.system.stiffness * *N) / (max_norm(*m.s.system.stiffness) * largest_norm(*N)), 1e-12);
  EXPECT_LT(max_norm(gram(MN, u)), 1e-12 * max_norm(replicate(u)) * largest_norm(MN));
}

TEST_P(StaticModesOf, ConstraintModesKeepTheirValues)
{
  for (const Component component : {Component::disc, Component::pins})
    {
      const MultiVector &Psi  = m.modes.constraint(component);
      const double       sign = component == Component::disc ? 1. : -1.;
      EXPECT_LT(max_norm(replicate(*P.normal * Psi) - sign * DenseMatrix::Identity(n_c, n_c)), 1e-12);

      // Forces act only along the normals of this component: K Ψ = P_nᵀ r on its rows, zero on all other rows
      const MultiVector F = *m.s.system.stiffness * Psi, f = forces(m.s, *P.normal, component);
      MultiVector       rest = F;
      multiply_add(-1., f, gram(f, F), 1., rest);
      EXPECT_LT(max_norm(replicate(rest)), 1e-9 * max_norm(replicate(F)));

      // Without rigid-body motions, Ψ_cn = Ψ_an F⁻¹ with F = n·Ψ_an at the contact nodes
      if (component == Component::disc && GetParam().n_free > 0)
        continue;
      const MultiVector attachment = m.modes.normal_attachment(component);
      rest                         = attachment * DenseMatrix(sign * replicate(*P.normal * attachment).inverse());
      rest -= Psi;
      EXPECT_LT(max_norm(replicate(rest)), 1e-9 * max_norm(replicate(Psi)));
    }
}

TEST(Kernels, AreUndoneByCoordinates)
{
  const Scene s             = scene({"cone", 0.3}, mounted(held));
  const auto  expect_undone = [](const SparseMatrix &T) {
    const MultiVector q = random_vectors(T.columns(), 3);
    EXPECT_LT(max_norm(replicate(coordinates(T, T * q)) - replicate(q)), 1e-15);
  };
  expect_undone(*s.contact.kernel);
  expect_undone(*component_kernel(s.model, s.interface, Component::pins, ContactBoundary::free));

  // On faces inclined by 45 degrees, the row of a slave dof has a single entry of 1, as does the row of its master dof
  ContactInterface inclined = s.interface;
  const double     h        = std::sqrt(0.5);
  for (ContactNode &node : inclined)
    {
      node.normal  = {-h, 0., std::copysign(h, node.normal[2])};
      node.sliding = {0., 1., 0.};
    }
  for (const ContactInterface &interface : {s.interface, inclined})
    for (const Component component : {Component::disc, Component::pins})
      expect_undone(*component_kernel(s.model, interface, component, ContactBoundary::sliding));
}

TEST(CoupledResponses, SolveWithTheirForces)
{
  const Scene          s = scene({"cone", 0.3}, damped(mounted(held)), RadialDissipation::consistent);
  const UpdatedInverse inverse(s.coupled, 0., FactorizationLibrary::automatic);
  const MultiVector    Phi = random_vectors(s.coupled.map(), 4);
  const double         mu  = 0.37;
  const auto          &K   = *s.coupled.stiffness;

  // Compute forces from K_c − μ A V_K at μ = 1 and its transpose
  const auto with  = with_friction(s.coupled, 1.);
  const auto check = [&](const MultiVector &response, MultiVector force) {
    const double size = max_norm(replicate(force));
    force -= K * response;
    EXPECT_LT(max_norm(replicate(force)), 1e-9 * size);
  };
  MultiVector right = K * Phi, left = right;
  right -= *with.stiffness * Phi;
  left -= transpose_times(*with.stiffness, Phi);
  check(friction_response(s.coupled, inverse, Phi, Side::right), right);
  check(friction_response(s.coupled, inverse, Phi, Side::left), left);
  check(damping_response(s.coupled, inverse, Phi), *with_friction(s.coupled, 0.).damping * Phi);
  check(damping_response(s.coupled, inverse, Phi, mu), *with_friction(s.coupled, mu).damping * Phi);
}
