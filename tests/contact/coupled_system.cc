// SPDX-License-Identifier: GPL-3.0-or-later

#include "faces.h"
#include "solutions.h"

#include <squeal/base/tasks.h>
#include <squeal/contact/updated_inverse.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  using Matrix = std::shared_ptr<const SparseMatrix>;

  Scene scene(const Case &c, const bool is_damped = false, const RadialDissipation dissipation = RadialDissipation::consistent)
  {
    // Use fewer elements if they are quadratic
    const int                   n    = c.element == Element::trilinear ? 2 : 1;
    const std::vector<PolarPin> pins = {{Plan::Side::top, 0, n, 1, 1}, {Plan::Side::bottom, -1, n, 0, 1}};
    return Scene(sloped(extrude(polar_plan(0.15, 0.3, 1 + n, 4 + 4 * n, pins), layers(1, 2)), c.slope),
                 is_damped ? damped(mounted(held)) : mounted(held), operating(dissipation), c.element);
  }

  class Contact : public ::testing::TestWithParam<Case>
  {};
  INSTANTIATE_TEST_SUITE_P(Faces, Contact, ::testing::ValuesIn(held_cases));

  double difference(const SparseMatrix &A, const SparseMatrix &B)
  {
    return max_norm(*add(1., A, -1., B)) / max_norm(B);
  }

  /// Largest column norm of A − B, relative to the largest column norm of B.
  double difference(MultiVector A, const MultiVector &B)
  {
    A -= B;
    return max_norm(as_column(column_norms(A))) / max_norm(as_column(column_norms(B)));
  }

  std::shared_ptr<const SparseMatrix> identity(const RowMap &map)
  {
    return Testing::diagonal(map, [](int) { return 1.; });
  }

  /// Qᵀ A Q
  Matrix projected(const SparseMatrix &A, const SparseMatrix &Q)
  {
    return multiply(Q, *multiply(A, Q), true, false);
  }

  /// K + s C + s² M
  Matrix dynamic_stiffness(const SecondOrderSystem &matrices, const double s)
  {
    return add(1., *add(s * s, *matrices.mass, 1., *matrices.stiffness), s, *matrices.damping);
  }

  bool has_no_reaction_to_velocity(const CoupledSystem &system)
  {
    return std::none_of(system.terms.begin(), system.terms.end(),
                        [](const Term &term) { return term.power == 1 && term.kind == TermKind::friction; });
  }
} // namespace

TEST_P(Contact, OperatorsAreOrthogonal)
{
  const Scene                             s          = scene(GetParam());
  const std::vector<const SparseMatrix *> directions = {s.contact.normal.get(), s.contact.tangential.get(), s.contact.radial.get()};
  for (const SparseMatrix *P : directions)
    for (const SparseMatrix *Q : directions)
      EXPECT_LT(max_norm(*add(1., *multiply(*P, *Q, false, true), P == Q ? -2. : 0., *identity(P->rows()))), 2e-15);
}

TEST(ReactionOperators, GiveTheSameEigenvaluesWhateverTheirKind)
{
  const std::vector<PolarPin> pins = {{Plan::Side::top, 0, 1, 0, 1}, {Plan::Side::bottom, -1, 1, 0, 1}};
  const Scene                 s(sloped(extrude(polar_plan(0.15, 0.3, 2, 8, pins), layers(1, 1)), 0.3), damped(mounted(held)),
                                operating(RadialDissipation::consistent));
  const SparseMatrix         &P_n = *s.contact.normal;
  const DenseMatrix           N   = to_dense(P_n);
  const int                   n_c = N.rows(), n = N.cols();

  // Compute reactions from the pins, from the disc, and by a weighted pseudo-inverse of all directions
  DenseMatrix pin = DenseMatrix::Zero(n_c, n), B(3 * n_c, n), W = DenseMatrix::Zero(n, n);
  for (int c = 0; c < n_c; ++c)
    for (const int dof : s.interface[c].pin_node.dofs)
      pin(c, dof) = N(c, dof);
  B << N, to_dense(*s.contact.tangential), to_dense(*s.contact.radial);
  for (int i = 0; i < n; ++i)
    W(i, i) = 1. + 0.9 * std::sin(1. + i);
  const DenseMatrix pseudo = (B * W * B.transpose()).lu().solve(B * W).topRows(n_c);

  const auto eigenvalues = [&](const Matrix &S, const double mu) {
    ContactOperators contact = s.contact;
    contact.reaction         = S;
    EXPECT_LT(difference(*multiply(*S, P_n, false, true), *identity(P_n.rows())), 1e-13);
    for (const Matrix &P : {contact.tangential, contact.radial})
      EXPECT_LT(max_norm(*multiply(*S, *P, false, true)), 1e-13);
    const auto        matrices = with_friction(couple(s.system, contact, s.damping), mu);
    const DenseMatrix damping  = to_dense(*matrices.damping);
    return dense_quadratic_modes(to_dense(*matrices.mass), &damping, to_dense(*matrices.stiffness), 1e9);
  };
  const DenseQuadraticModes modes = eigenvalues(s.contact.reaction, 0.4);
  ASSERT_GT(modes.values.size(), 100u);
  EXPECT_GT(largest(distances(eigenvalues(s.contact.reaction, 0.).values, modes.values)), 1e-3); // friction changes the eigenvalues
  const DenseMatrix mixture = 0.3 * pin + 1.2 * pseudo - 0.5 * (N - pin);
  for (const DenseMatrix &S : {pin, mixture})
    {
      const DenseQuadraticModes others = eigenvalues(sparse(P_n.rows(), P_n.columns(), S), 0.4);
      EXPECT_EQ(others.real_values.size(), modes.real_values.size());
      EXPECT_LT(largest(distances(others.values, modes.values)), 1e-9);
    }
}

TEST_P(Contact, KernelSpansTheAdmissibleDisplacements)
{
  const Scene         s   = scene(GetParam());
  const SparseMatrix &T_c = *s.contact.kernel;
  EXPECT_EQ(T_c.n_rows(), s.model.free_map().n());
  EXPECT_EQ(T_c.n_columns(), T_c.n_rows() - static_cast<int>(s.interface.size()));
  EXPECT_LT(max_norm(*multiply(*s.contact.normal, T_c)), 1e-15);

  // T has full rank, 1 ≤ TᵀT ≤ 1 + 5: free dofs have the entry 1, and a slave depends on five other dofs with |ratio| ≤ 1
  const auto G    = multiply(T_c, T_c, true, false);
  const auto unit = identity(G->rows());
  EXPECT_EQ(count_negative_eigenvalues(*add(1., *G, -0.999, *unit), "TᵀT - 1"), 0);
  EXPECT_EQ(count_negative_eigenvalues(*add(-1., *G, 6.001, *unit), "6 - TᵀT"), 0);

  // T is a selection matrix, with a single entry of 1 per row, if n is a coordinate axis
  const DenseMatrix T            = to_dense(T_c);
  const bool        is_selection = ((T.array() == 0.) || (T.array() == 1.)).all() && (T.rowwise().sum().array() == 1.).all();
  EXPECT_EQ(is_selection, GetParam().slope == 0.);

  // The columns span every displacement with P_n u = 0: the residual of the projection vanishes
  MultiVector u = random_vectors(s.model.free_map(), 3);
  multiply_add(-0.5, transpose_times(*s.contact.normal, *s.contact.normal * u), DenseMatrix::Identity(3, 3), 1., u);
  EXPECT_LT(max_norm(replicate(*s.contact.normal * u)), 1e-14);
  MultiVector coefficients(T_c.columns(), 3);
  factorize_positive_definite(*G, FactorizationLibrary::automatic, "TᵀT")->apply(transpose_times(T_c, u), coefficients);
  EXPECT_LT(max_norm(replicate(T_c * coefficients) - replicate(u)), 1e-13);
}

TEST_P(Contact, ComponentKernels)
{
  const Scene s      = scene(GetParam());
  const auto  kernel = [&](const Component component, const ContactBoundary boundary) {
    return component_kernel(s.model, s.interface, component, boundary);
  };
  const auto disc = kernel(Component::disc, ContactBoundary::free), pins = kernel(Component::pins, ContactBoundary::free),
             sliding = kernel(Component::pins, ContactBoundary::sliding);
  EXPECT_EQ(disc->n_columns() + pins->n_columns(), s.model.free_map().n());
  EXPECT_EQ(max_norm(*multiply(*disc, *pins, true, false)), 0.);
  EXPECT_EQ(sliding->n_columns(), pins->n_columns() - static_cast<int>(s.interface.size()));
  EXPECT_EQ(max_norm(*multiply(*disc, *sliding, true, false)), 0.);
  EXPECT_LT(max_norm(*multiply(*s.contact.normal, *sliding)), 1e-15);
  EXPECT_GT(max_norm(*multiply(*s.contact.tangential, *sliding)), 0.1);
  EXPECT_GT(max_norm(*multiply(*s.contact.radial, *sliding)), 0.1);
}

TEST_P(Contact, MatricesAreThoseOfTheUnreducedEquation)
{
  // T_cᵀ (1 − μ/2 P_tᵀ P_n) multiplies K, M and C of the bodies, whose damping forces also cause friction, but not C_b
  for (const bool is_damped : {false, true})
    for (const RadialDissipation dissipation : {RadialDissipation::none, RadialDissipation::consistent})
      {
        const Scene s       = scene(GetParam(), is_damped, dissipation);
        const auto &T       = *s.contact.kernel;
        const auto  P_t_P_n = multiply(*s.contact.tangential, *s.contact.normal, true, false);
        EXPECT_EQ(with_friction(s.coupled, 0.).stiffness, s.coupled.stiffness);
        EXPECT_EQ(has_no_reaction_to_velocity(s.coupled), !is_damped);
        for (const double mu : {0., 0.37})
          {
            const auto friction = [&](const SparseMatrix &matrix) { return add(1., matrix, -0.5 * mu, *multiply(*P_t_P_n, matrix)); };
            const SecondOrderSystem found = with_friction(s.coupled, mu);
            Matrix                  C     = is_damped ? friction(*s.system.damping) : s.contact_damping;
            if (is_damped && s.contact_damping)
              C = add(1., *C, 1., *s.contact_damping);
            EXPECT_LT(difference(*found.stiffness, *projected(*friction(*s.system.stiffness), T)), 1e-14);
            EXPECT_LT(difference(*found.mass, *projected(*friction(*s.system.mass), T)), 1e-14);
            ASSERT_EQ(C != nullptr, found.damping != nullptr);
            EXPECT_LT(C ? difference(*found.damping, *projected(*C, T)) : 0., 1e-14);

            EXPECT_EQ(symmetry_defect(*found.stiffness) > 1e-3, mu > 0.);
            EXPECT_EQ(C && symmetry_defect(*found.damping) > 1e-3, is_damped && mu > 0.);
            for (const Matrix &matrix : {found.mass, found.damping, found.stiffness})
              EXPECT_LT(matrix && mu == 0. ? symmetry_defect(*matrix) : 0., 1e-14);
          }
      }
}

TEST_P(Contact, DampingActsAlongTheSlidingAndTheRadialDirection)
{
  const Scene         s = scene(GetParam());
  std::vector<double> c_b, c_t;
  for (std::size_t c = 0; c < s.interface.size(); ++c)
    {
      c_b.push_back(1. + c);
      c_t.push_back(-3. + c % 5); // c_t of either sign; negative if friction decreases with speed
    }
  const auto along = [&](const Matrix &P, const std::vector<double> &values) {
    return projected(*Testing::diagonal(P->rows(), [&](const int c) { return values[c]; }), *P);
  };
  const Matrix b = along(s.contact.radial, c_b), t = along(s.contact.tangential, c_t);
  EXPECT_LT(difference(*contact_damping(s.contact, {c_b, {}}), *b), 1e-14);
  EXPECT_LT(difference(*contact_damping(s.contact, {{}, c_t}), *t), 1e-14);
  EXPECT_LT(difference(*contact_damping(s.contact, {c_b, c_t}), *add(1., *b, 1., *t)), 1e-14);
  const std::vector<double> zeros(c_b.size(), 0.);
  EXPECT_EQ(contact_damping(s.contact, {zeros, {}}), nullptr);
  EXPECT_EQ(contact_damping(s.contact, {zeros, zeros}), nullptr);

  // Forces of contact damping cause no friction
  const CoupledSystem coupled = couple(s.system, s.contact, {c_b, c_t});
  EXPECT_TRUE(has_no_reaction_to_velocity(coupled));
  EXPECT_EQ(difference(*with_friction(coupled, 0.4).damping, *with_friction(coupled, 0.).damping), 0.);
}

TEST_P(Contact, UpdatedInverseEqualsSparseFactors)
{
  for (const auto &[is_damped, shift] : {std::make_pair(false, 0.), {false, 5000.}, {true, 5000.}})
    {
      const Scene       s = scene(GetParam(), is_damped);
      UpdatedInverse    inverse(s.coupled, shift, FactorizationLibrary::automatic);
      UpdatedInverse    frugal(s.coupled, shift, FactorizationLibrary::automatic, AttachmentModes::not_kept);
      const MultiVector B = random_vectors(s.coupled.map(), 4);
      for (const double mu : {0., 0.4, 1.3, 0.2})
        {
          MultiVector X(B), Y(B);
          factorize_general(*dynamic_stiffness(with_friction(s.coupled, mu), shift), "test")->apply(B, Y);
          for (UpdatedInverse *each : {&inverse, &frugal})
            {
              each->set_friction_coefficient(mu);
              each->apply(B, X);
              EXPECT_LT(difference(X, Y), 1e-10) << "shift " << shift << ", mu " << mu;
            }
        }
      // The frictionless inverse is independent of μ, and the attachment modes X solve S X = A
      const Matrix S = dynamic_stiffness(with_friction(s.coupled, 0.), shift);
      EXPECT_LT(difference(*S * inverse.solve_frictionless(B), B), 1e-10);
      const DenseMatrix forces = replicate(s.coupled.friction_forces->columns(0, s.coupled.n_contact()));
      EXPECT_LT(max_norm(replicate(*S * inverse.attachment_modes()) - forces), 1e-10);

      // Attachment modes computed on demand are the same
      const UpdatedInverse waiting(s.coupled, shift, FactorizationLibrary::automatic, AttachmentModes::when_needed);
      const DenseMatrix    Y = agreed_random_matrix(s.coupled.n_contact(), 3);
      EXPECT_LT(difference(waiting.attachment_modes_times(Y), inverse.attachment_modes_times(Y)), 1e-12);
      EXPECT_LT(difference(waiting.attachment_modes(), inverse.attachment_modes()), 1e-12);
    }
}

TEST_P(Contact, ComplexModesSatisfyTheUnreducedEquation)
{
  // Check M ü + C u̇ + K u = P_nᵀ r_n + μ P_tᵀ r_n and P_n u = 0, where t is the sliding direction of the disc relative to the pin
  for (const bool is_damped : {false, true})
    {
      const Scene      s  = scene(GetParam(), is_damped, is_damped ? RadialDissipation::consistent : RadialDissipation::none);
      const double     mu = 0.6;
      SolverParameters solvers;
      solvers.complex_tolerance = 1e-10;
      UpdatedInverse    inverse(s.coupled, 0., FactorizationLibrary::automatic);
      Progress          progress;
      const auto        modes = krylov_modes(s.coupled, inverse, 0., mu, 2. * M_PI * 4000., 12, solvers, progress);
      const int         k     = modes.lambda.size();
      const MultiVector u_re = *s.contact.kernel * *modes.real_part, u_im = *s.contact.kernel * *modes.imaginary_part;
      ASSERT_GT(k, 3);
      EXPECT_LT(max_norm(replicate(*s.contact.normal * u_re)), 1e-14 * max_norm(replicate(u_re)));

      const auto times = [&](const SparseMatrix &A) -> ComplexDenseMatrix {
        return replicate(A * u_re) + Complex(0., 1.) * replicate(A * u_im);
      };
      const auto         r    = normal_reactions(s.coupled, modes.lambda, *modes.real_part, *modes.imaginary_part);
      const DenseMatrix  P    = to_dense(*s.contact.normal) + mu * to_dense(*s.contact.tangential);
      ComplexDenseMatrix rest = times(*s.system.stiffness), forces = P.transpose() * r;
      const auto         size   = rest.colwise().norm().eval();
      const auto         lambda = Eigen::Map<const Eigen::VectorXcd>(modes.lambda.data(), k);
      rest -= forces;
      rest += times(*s.system.mass) * lambda.cwiseProduct(lambda).asDiagonal();
      for (const auto &C : {s.contact_damping, s.system.damping})
        if (C)
          rest += times(*C) * lambda.asDiagonal();
      int n_touching = 0;
      for (int j = 0; j < k; ++j)
        {
          EXPECT_LT(rest.col(j).norm(), 1e-9 * size[j]) << "mode " << j;
          n_touching += forces.col(j).norm() > 1e-2 * size[j];
        }
      // Reactions contribute to the balance of most modes, except in-plane modes of the disc
      EXPECT_GT(n_touching, k / 2);
    }
}

TEST_P(Contact, SpringsYieldByTheReactions)
{
  constexpr double mu          = 0.4;
  const Scene      s           = scene(GetParam());
  const auto       system_with = [&](const double k) {
    ContactInterface interface = s.interface;
    for (ContactNode &node : interface)
      node.stiffness = k;
    return couple(s.system, contact_operators(s.model, interface), s.damping);
  };

  // Compare with K + P_nᵀ k D P_n + μ P_tᵀ k D P_n
  constexpr double    k      = 3e11;
  const CoupledSystem spring = system_with(k);
  const DenseMatrix   P_n = to_dense(*s.contact.normal), P_t = to_dense(*s.contact.tangential);
  Eigen::VectorXd     D(s.interface.size());
  for (std::size_t c = 0; c < s.interface.size(); ++c)
    D[c] = k * s.interface[c].area;
  const DenseMatrix expected = to_dense(*s.system.stiffness) + (P_n + mu * P_t).transpose() * D.asDiagonal() * P_n;
  EXPECT_LT(max_norm(to_dense(*with_friction(spring, mu).stiffness) - expected), 1e-14 * max_norm(expected));

  // The rigid constraint is the limit, with errors proportional to 1 / k
  const auto lowest = [&](const CoupledSystem &system) {
    const auto matrices = with_friction(undamped(system), mu);
    return dense_quadratic_modes(to_dense(*matrices.mass), nullptr, to_dense(*matrices.stiffness), 6e4).values;
  };
  const auto rigid = lowest(s.coupled);
  const auto error = [&](const double stiffness) {
    const auto yielding = lowest(system_with(stiffness));
    double     result   = 0.;
    for (std::size_t j = 0; j < std::min<std::size_t>(4, rigid.size()); ++j)
      result = std::max(result, std::abs(yielding[j] - rigid[j]) / std::abs(rigid[j]));
    return result;
  };
  const double soft = error(1e14), stiff = error(1e15);
  EXPECT_LT(stiff, 1e-3);
  EXPECT_NEAR(soft / stiff, 10., 0.5);
}
