#include "bases/cases.h"

#include <squeal/base/exceptions.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/bases/static_modes.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr double band = 2. * M_PI * 5000.;

  Scene scene(const Case &c, const MaterialParameters &materials, const RadialDissipation dissipation = RadialDissipation::none)
  {
    const std::vector<PolarPin> pins = {{Plan::Side::top, 0, 2, 1, 1}, {Plan::Side::bottom, -1, 2, 0, 1}};
    return Scene(c.sloped(extrude(polar_plan(0.15, 0.3, 3, 12, pins), layers(1, 2))), materials, operating(dissipation), c.element);
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

  /// Pᵀ with the rows of the other component at zero.
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

  /// Largest ‖K u − f + M N Nᵀf‖ / ‖f‖ of the columns.
  double residual(const Modes &m, const MultiVector &u, MultiVector f)
  {
    const auto norms = column_norms(f);
    if (const MultiVector *N = m.modes.rigid_body_modes())
      multiply_add(-1., *m.s.system.mass * *N, gram(*N, f), 1., f);
    MultiVector rest = *m.s.system.stiffness * u;
    rest -= f;
    const auto sizes   = column_norms(rest);
    double     largest = 0.;
    for (std::size_t j = 0; j < sizes.size(); ++j)
      largest = std::max(largest, sizes[j] / norms[j]);
    return largest;
  }

  class StaticModesOf : public ::testing::TestWithParam<Case>
  {};
  INSTANTIATE_TEST_SUITE_P(
    Scenes,
    StaticModesOf,
    ::testing::Values(Case{"flat, trilinear", 0., Element::trilinear, held, 0, 1e-11},
                      Case{"flat, quadratic", 0., Element::quadratic, held},
                      Case{"cone, trilinear", 0.3, Element::trilinear, held},
                      Case{"cone, quadratic", 0.3, Element::quadratic, held},
                      Case{"steep cone, trilinear", 1.5, Element::trilinear, held},
                      Case{"free disc, flat", 0., Element::trilinear, {}, 6},
                      Case{"free disc, cone", 0.3, Element::trilinear, {}, 6},
                      Case{"held against turning only", 0., Element::trilinear, {{"disc_bore", 0., 7.80e10, 0.}}, 1}));
} // namespace

TEST_P(StaticModesOf, AttachmentModesAreStaticResponses)
{
  const Modes m(GetParam());
  const int   n_c = m.s.interface.size();
  ASSERT_EQ(m.modes.normal_attachment().n_columns(), n_c);
  const auto f = [&](const SparseMatrix &P) { return transpose_times(P, unit_vectors(P.rows())); };
  EXPECT_LT(residual(m, m.modes.normal_attachment(), f(*m.s.contact.normal)), GetParam().tolerance);
  EXPECT_LT(residual(m, m.modes.tangential_attachment(), f(*m.s.contact.tangential)), 1e-9);

  // Unit forces along n on each component; together they are the set of both
  const MultiVector disc = m.modes.normal_attachment(Component::disc), pins = m.modes.normal_attachment(Component::pins);
  MultiVector       f_disc = forces(m.s, *m.s.contact.normal, Component::disc), f_pins = forces(m.s, *m.s.contact.normal, Component::pins);
  f_pins *= -1.;
  EXPECT_LT(residual(m, disc, f_disc), 1e-9);
  EXPECT_LT(residual(m, pins, f_pins), 1e-9);
  MultiVector rest = disc;
  rest.local() += -pins.local() - m.modes.normal_attachment().local();
  EXPECT_EQ(max_norm(replicate(rest)), 0.);

  // A force and the friction it causes
  const double mu      = 0.37;
  MultiVector  rubbing = f(*m.s.contact.normal);
  rubbing.local() += mu * f(*m.s.contact.tangential).local();
  EXPECT_LT(residual(m, m.modes.rubbing_attachment(mu), rubbing), 1e-9);
}

TEST_P(StaticModesOf, AFreeDiscIsRelievedByInertia)
{
  const Modes        m(GetParam());
  const MultiVector *N = m.modes.rigid_body_modes();
  ASSERT_EQ(N != nullptr ? N->n_columns() : 0, GetParam().n_free);
  const MultiVector &u = m.modes.normal_attachment();
  // Flexibilities are symmetric
  const DenseMatrix F = replicate(*m.s.contact.normal * u);
  EXPECT_LT(max_norm(F - F.transpose()), 1e-9 * max_norm(F));
  if (N == nullptr)
    return;
  const auto        largest = [](const MultiVector &X) { return max_norm(as_column(column_norms(X))); };
  const MultiVector MN      = *m.s.system.mass * *N;
  EXPECT_LT(max_norm(gram(*N, MN) - DenseMatrix::Identity(N->n_columns(), N->n_columns())), 1e-12);
  EXPECT_LT(largest(*m.s.system.stiffness * *N) / (max_norm(*m.s.system.stiffness) * largest(*N)), 1e-12);
  EXPECT_LT(max_norm(gram(MN, u)), 1e-12 * max_norm(replicate(u)) * largest(MN));
}

TEST_P(StaticModesOf, ConstraintModesKeepTheirValues)
{
  const Modes m(GetParam());
  const int   n_c = m.s.interface.size();
  for (const Component component : {Component::disc, Component::pins})
    {
      const MultiVector &Psi  = m.modes.constraint(component);
      const double       sign = component == Component::disc ? 1. : -1.;
      EXPECT_LT(max_norm(replicate(*m.s.contact.normal * Psi) + -sign * DenseMatrix::Identity(n_c, n_c)), 1e-12);

      // Forces act along the normals of this component only: K Ψ = P_nᵀ r on its rows, zero on the others.
      const MultiVector F = *m.s.system.stiffness * Psi, f = forces(m.s, *m.s.contact.normal, component);
      MultiVector       rest = F;
      multiply_add(-1., f, gram(f, F), 1., rest);
      EXPECT_LT(max_norm(replicate(rest)), 1e-9 * max_norm(replicate(F)));

      // The condensed stiffness is symmetric
      const DenseMatrix S = gram(Psi, F);
      EXPECT_LT(max_norm(S - S.transpose()), 1e-10 * max_norm(S));
    }
}

TEST_P(StaticModesOf, FlexibilityAndCondensedStiffnessAreInverse)
{
  // Ψ_cn = Ψ_an F⁻¹ where nothing moves rigidly, F = n·Ψ_an at the contact nodes.
  const Modes m(GetParam());
  for (const Component component : {Component::disc, Component::pins})
    {
      if (component == Component::disc && m.modes.rigid_body_modes() != nullptr)
        continue;
      const MultiVector attachment  = m.modes.normal_attachment(component);
      const DenseMatrix flexibility = replicate(*m.s.contact.normal * attachment);
      const double      sign        = component == Component::pins ? -1. : 1.;
      MultiVector       rest        = attachment * DenseMatrix(sign * flexibility.inverse());
      rest -= m.modes.constraint(component);
      EXPECT_LT(max_norm(replicate(rest)), 1e-9 * max_norm(replicate(m.modes.constraint(component))));
    }
}

TEST_P(StaticModesOf, CoordinatesUndoTheKernels)
{
  const Scene s = scene(GetParam(), mounted(GetParam().mounts));
  for (const auto &T :
       {std::shared_ptr<const SparseMatrix>(s.contact.kernel),
        std::shared_ptr<const SparseMatrix>(component_kernel(s.model, s.interface, Component::disc, ContactBoundary::sliding)),
        std::shared_ptr<const SparseMatrix>(component_kernel(s.model, s.interface, Component::pins, ContactBoundary::free))})
    {
      const MultiVector q = random_vectors(T->columns(), 3);
      EXPECT_LT(max_norm(replicate(coordinates(*T, *T * q)) - replicate(q)), 1e-15);
    }
}

TEST(StaticModes, FacesAtFortyFiveDegreesAreNoTrap)
{
  // A slave row then holds a single one, like the row of the dof it follows.
  const Case       c         = {"45 degrees", 0., Element::trilinear, held};
  Scene            s         = scene(c, mounted(held));
  ContactInterface interface = s.interface;
  const double     h         = std::sqrt(0.5);
  for (ContactNode &node : interface)
    {
      node.normal  = {-h, 0., std::copysign(h, node.normal[2])};
      node.sliding = {0., 1., 0.};
    }
  for (const Component component : {Component::disc, Component::pins})
    {
      const auto        T = component_kernel(s.model, interface, component, ContactBoundary::sliding);
      const MultiVector q = random_vectors(T->columns(), 2);
      EXPECT_LT(max_norm(replicate(coordinates(*T, *T * q)) - replicate(q)), 1e-15);
    }
}

TEST(CoupledResponses, SolveWithTheirForces)
{
  const Scene          s = scene({"cone", 0.3, Element::trilinear, held}, damped(mounted(held)), RadialDissipation::consistent);
  const UpdatedInverse inverse(s.coupled, 0., FactorizationLibrary::automatic);
  const MultiVector    Phi = random_vectors(s.coupled.map(), 4);
  const double         mu  = 0.37;
  const auto          &K   = *s.coupled.stiffness;

  // Forces from the matrices with friction: K_c − μ A V_K at μ = 1 and its transpose
  const auto        with  = with_friction(s.coupled, 1.);
  const MultiVector K_Phi = K * Phi;
  const auto        check = [&](const MultiVector &response, MultiVector force) {
    const double size = max_norm(replicate(force));
    force -= K * response;
    EXPECT_LT(max_norm(replicate(force)), 1e-9 * size);
  };
  MultiVector right = K_Phi, left = K_Phi;
  right -= *with.stiffness * Phi;
  left -= transpose_times(*with.stiffness, Phi);
  check(friction_response(s.coupled, inverse, Phi, Side::right), right);
  check(friction_response(s.coupled, inverse, Phi, Side::left), left);
  check(damping_response(s.coupled, inverse, Phi), *with_friction(s.coupled, 0.).damping * Phi);
  check(damping_response(s.coupled, inverse, Phi, mu), *with_friction(s.coupled, mu).damping * Phi);

  const Scene          undamped = scene({"flat", 0., Element::trilinear, held}, mounted(held));
  const UpdatedInverse other(undamped.coupled, 0., FactorizationLibrary::automatic);
  EXPECT_THROW(damping_response(undamped.coupled, other, random_vectors(undamped.coupled.map(), 1)), SolverError);
}
