#include "solutions.h"

#include <squeal/base/tasks.h>
#include <squeal/contact/updated_inverse.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/modes/krylov_modes.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /// Contact faces and element.
  struct Case
  {
    const char *name;
    double      slope; ///< of the contact faces
    Element     element;
  };
  void PrintTo(const Case &c, std::ostream *stream)
  {
    *stream << c.name;
  }

  /// Whether the materials have Rayleigh damping.
  enum class Bodies
  {
    undamped,
    damped
  };

  Scene scene(const Case &c, const RadialDissipation dissipation = RadialDissipation::consistent, const Bodies bodies = Bodies::undamped)
  {
    const MaterialParameters materials = mounted({{"disc_bore", 1e9, 7.80e10, 1.88e10}});
    // Fewer elements where they are quadratic
    const int                   n    = c.element == Element::trilinear ? 2 : 1;
    const std::vector<PolarPin> pins = {{Plan::Side::top, 0, n, 1, 1}, {Plan::Side::bottom, -1, n, 0, 1}};
    return Scene(mapped(extrude(polar_plan(0.15, 0.3, 1 + n, 4 + 4 * n, pins), layers(1, 2)),
                        [c](const Point3 &p) {
                          // A cone, and some tilt about y so that no face is like another
                          return Point3{{p[0], p[1], p[2] + c.slope * (std::hypot(p[0], p[1]) - 0.2) + 0.3 * c.slope * p[1]}};
                        }),
                 bodies == Bodies::damped ? damped(materials) : materials, operating(dissipation), c.element);
  }

  class Contact : public ::testing::TestWithParam<Case>
  {};
  INSTANTIATE_TEST_SUITE_P(Faces,
                           Contact,
                           ::testing::Values(Case{"flat, trilinear", 0., Element::trilinear},
                                             Case{"flat, quadratic", 0., Element::quadratic},
                                             Case{"cone, trilinear", 0.3, Element::trilinear},
                                             Case{"cone, quadratic", 0.3, Element::quadratic},
                                             Case{"steep cone, trilinear", 1.5, Element::trilinear}));

  double difference(const SparseMatrix &A, const SparseMatrix &B)
  {
    return max_norm(*add(1., A, -1., B)) / max_norm(B);
  }

  bool has_no_reaction_to_velocity(const CoupledSystem &system)
  {
    return std::none_of(system.terms.begin(), system.terms.end(),
                        [](const Term &term) { return term.power == 1 && term.kind == TermKind::friction; });
  }
} // namespace

TEST_P(Contact, OperatorsAreOrthogonal)
{
  const Scene s   = scene(GetParam());
  const auto &P_n = *s.contact.normal, &P_t = *s.contact.tangential, &P_b = *s.contact.radial;
  const auto  two = Testing::diagonal(P_n.rows(), [](int) { return 2.; });
  for (const SparseMatrix *P : {&P_n, &P_t, &P_b})
    EXPECT_LT(difference(*multiply(*P, *P, false, true), *two), 1e-15);
  const std::vector<std::pair<const SparseMatrix *, const SparseMatrix *>> pairs = {{&P_n, &P_t}, {&P_n, &P_b}, {&P_t, &P_b}};
  for (const auto &[P, Q] : pairs)
    EXPECT_LT(max_norm(*multiply(*P, *Q, false, true)), 1e-15);
}

TEST(ReactionOperators, GiveTheSameEigenvaluesWhateverTheirKind)
{
  const std::vector<PolarPin> pins = {{Plan::Side::top, 0, 1, 0, 1}, {Plan::Side::bottom, -1, 1, 0, 1}};
  const Scene                 s(mapped(extrude(polar_plan(0.15, 0.3, 2, 8, pins), layers(1, 1)),
                                       [](const Point3 &p) {
                         return Point3{{p[0], p[1], p[2] + 0.3 * (std::hypot(p[0], p[1]) - 0.2) + 0.1 * p[1]}};
                       }),
                                damped(mounted({{"disc_bore", 1e9, 7.80e10, 1.88e10}})), operating(RadialDissipation::consistent));
  const SparseMatrix         &P_n = *s.contact.normal;
  using Matrix                    = std::shared_ptr<const SparseMatrix>;
  const auto rows                 = [&](const auto &fill) { return std::make_shared<const SparseMatrix>(P_n.rows(), P_n.columns(), fill); };

  // The rows of one side of the contact
  const auto side = [&](const Node ContactNode::*node) {
    return rows([&, node](const int i, SparseMatrix::Row &row) {
      SparseMatrix::Row all;
      P_n.get_row(i, all);
      const auto &dofs = (s.interface[P_n.rows().number(i)].*node).dofs;
      for (const auto &entry : all)
        if (std::find(std::begin(dofs), std::end(dofs), entry.first) != std::end(dofs))
          row.push_back(entry);
    });
  };
  // The pseudo-inverse of all directions in a weighted norm
  const int   n_c = P_n.n_rows(), n = P_n.n_columns();
  DenseMatrix B(3 * n_c, n), W      = DenseMatrix::Zero(n, n);
  B << to_dense(P_n), to_dense(*s.contact.tangential), to_dense(*s.contact.radial);
  for (int i = 0; i < n; ++i)
    W(i, i) = 1. + 0.9 * std::sin(1. + i);
  const DenseMatrix S_all = (B * W * B.transpose()).lu().solve(B * W);
  const Matrix      pin = side(&ContactNode::pin_node), disc = side(&ContactNode::disc_node),
               pseudo  = rows([&](const int i, SparseMatrix::Row &row) {
                 for (int j = 0; j < n; ++j)
                   if (const double value = S_all(P_n.rows().number(i), j); value != 0.)
                     row.emplace_back(j, value);
               });
  const Matrix mixture = linear_combination({{0.3, pin.get()}, {1.2, pseudo.get()}, {-0.5, disc.get()}});

  const auto eigenvalues = [&](const Matrix &S, const double mu) {
    ContactOperators contact = s.contact;
    contact.reaction         = S;
    const auto unit          = Testing::diagonal(P_n.rows(), [](int) { return 1.; });
    EXPECT_LT(difference(*multiply(*S, P_n, false, true), *unit), 1e-13);
    for (const Matrix &P : {contact.tangential, contact.radial})
      EXPECT_LT(max_norm(*multiply(*S, *P, false, true)), 1e-13);
    const auto                matrices = with_friction(couple(s.system, contact, s.damping), mu);
    const DenseMatrix         damping  = to_dense(*matrices.damping);
    const DenseQuadraticModes modes    = dense_quadratic_modes(to_dense(*matrices.mass), &damping, to_dense(*matrices.stiffness), 1e9);
    return std::make_pair(modes.values, modes.real_values);
  };
  const auto [values, real_values] = eigenvalues(s.contact.reaction, 0.4);
  ASSERT_GT(values.size(), 100u);
  EXPECT_GT(largest(distances(eigenvalues(s.contact.reaction, 0.).first, values)), 1e-3); // friction matters
  for (const Matrix &S : {pin, disc, pseudo, mixture})
    {
      const auto [others, other_real_values] = eigenvalues(S, 0.4);
      ASSERT_EQ(others.size(), values.size());
      EXPECT_EQ(other_real_values.size(), real_values.size());
      EXPECT_LT(largest(distances(others, values)), 1e-9);
    }
}

TEST_P(Contact, KernelSpansTheAdmissibleDisplacements)
{
  const Scene         s   = scene(GetParam());
  const SparseMatrix &T_c = *s.contact.kernel;
  EXPECT_EQ(T_c.n_rows(), s.model.free_map().n());
  EXPECT_EQ(T_c.n_columns(), T_c.n_rows() - static_cast<int>(s.interface.size()));
  EXPECT_LT(max_norm(*multiply(*s.contact.normal, T_c)), 1e-15);

  // Full rank, well conditioned: free dofs appear with 1, and a slave follows five others with |ratio| ≤ 1, 1 ≤ TᵀT ≤ 1 + 5.
  const auto G    = multiply(T_c, T_c, true, false);
  const auto unit = Testing::diagonal(G->rows(), [](int) { return 1.; });
  EXPECT_EQ(count_negative_eigenvalues(*add(1., *G, -0.999, *unit), "TᵀT - 1"), 0);
  EXPECT_EQ(count_negative_eigenvalues(*add(-1., *G, 6.001, *unit), "6 - TᵀT"), 0);

  // A selection where n is a coordinate axis: one entry, a one, in every row
  bool              selection = true;
  SparseMatrix::Row row;
  for (int i = 0; i < T_c.rows().n_local(); ++i)
    {
      T_c.get_row(i, row);
      selection = selection && row.size() == 1 && row[0].second == 1.;
    }
  EXPECT_EQ(dealii::Utilities::MPI::min(static_cast<int>(selection), T_c.communicator()), GetParam().slope == 0.);

  // Every displacement with P_n u = 0 is reached: u minus its projection on the columns vanishes.
  MultiVector u = random_vectors(s.model.free_map(), 3);
  multiply_add(-0.5, transpose_times(*s.contact.normal, *s.contact.normal * u), DenseMatrix::Identity(3, 3), 1., u);
  EXPECT_LT(max_norm(replicate(*s.contact.normal * u)), 1e-14);
  MultiVector coefficients(T_c.columns(), 3);
  factorize_positive_definite(*G, FactorizationLibrary::automatic, "TᵀT")->apply(transpose_times(T_c, u), coefficients);
  MultiVector rest = T_c * coefficients;
  rest             = u - rest;
  EXPECT_LT(max_norm(replicate(rest)), 1e-13);
}

TEST_P(Contact, ComponentKernels)
{
  const Scene s = scene(GetParam());
  const int   n = s.model.free_map().n(), n_c = s.interface.size();
  const auto  disc = Component::disc, pins = Component::pins;

  const auto disc_free = component_kernel(s.model, s.interface, disc, ContactBoundary::free);
  const auto pins_free = component_kernel(s.model, s.interface, pins, ContactBoundary::free);
  EXPECT_EQ(disc_free->n_columns() + pins_free->n_columns(), n);
  EXPECT_EQ(max_norm(*multiply(*disc_free, *pins_free, true, false)), 0.);

  const auto pins_sliding = component_kernel(s.model, s.interface, pins, ContactBoundary::sliding);
  EXPECT_EQ(pins_sliding->n_columns(), pins_free->n_columns() - n_c);
  EXPECT_LT(max_norm(*multiply(*s.contact.normal, *pins_sliding)), 1e-15);
  EXPECT_EQ(max_norm(*multiply(*disc_free, *pins_sliding, true, false)), 0.);
  // The pins can slide in both directions.
  EXPECT_GT(max_norm(*multiply(*s.contact.tangential, *pins_sliding)), 0.1);
  EXPECT_GT(max_norm(*multiply(*s.contact.radial, *pins_sliding)), 0.1);
}

TEST_P(Contact, CoupledMatricesAreSymmetric)
{
  const Scene s = scene(GetParam());
  EXPECT_LT(symmetry_defect(*s.coupled.mass), 1e-14);
  EXPECT_LT(symmetry_defect(*s.coupled.stiffness), 1e-14);
  EXPECT_LT(symmetry_defect(*with_friction(s.coupled, 0.).damping), 1e-14);
  EXPECT_TRUE(has_no_reaction_to_velocity(s.coupled));
  EXPECT_LT(symmetry_defect(*with_friction(scene(GetParam(), RadialDissipation::consistent, Bodies::damped).coupled, 0.).damping), 1e-14);
  // The couplings are not empty words: friction is not symmetric.
  EXPECT_GT(symmetry_defect(*with_friction(s.coupled, 0.4).stiffness), 1e-3);
}

TEST_P(Contact, FrictionIsThatOfTheUnreducedEquation)
{
  const Scene  s        = scene(GetParam());
  const double mu       = 0.37;
  const auto  &T        = *s.contact.kernel;
  const auto   P_t_P_n  = multiply(*s.contact.tangential, *s.contact.normal, true, false);
  const auto   expected = [&](const SparseMatrix &matrix) {
    const auto with = add(1., matrix, -0.5 * mu, *multiply(*P_t_P_n, matrix));
    return multiply(T, *multiply(*with, T), true, false);
  };
  const SecondOrderSystem found = with_friction(s.coupled, mu);
  EXPECT_LT(difference(*found.stiffness, *expected(*s.system.stiffness)), 1e-14);
  EXPECT_LT(difference(*found.mass, *expected(*s.system.mass)), 1e-14);

  // C_b acts along b only, and dissipates.
  const auto C_c = multiply(T, *multiply(*s.contact_damping, T), true, false);
  EXPECT_LT(difference(*with_friction(s.coupled, 0.).damping, *C_c), 1e-14);
  EXPECT_LT(max_norm(*multiply(*s.contact.tangential, *s.contact_damping)), 1e-14 * max_norm(*s.contact_damping));
  EXPECT_LT(max_norm(*multiply(*s.contact.normal, *s.contact_damping)), 1e-14 * max_norm(*s.contact_damping));

  // Without friction nothing is added, and without damping of the bodies friction leaves C_b alone.
  EXPECT_EQ(with_friction(s.coupled, 0.).stiffness, s.coupled.stiffness);
  EXPECT_EQ(difference(*found.damping, *with_friction(s.coupled, 0.).damping), 0.);
}

TEST_P(Contact, FrictionTakesItsPartOfTheDampingOfTheBodies)
{
  // C̃ = T_cᵀ (C − μ/2 P_tᵀ P_n C + C_b) T_c
  const double mu = 0.37;
  for (const RadialDissipation dissipation : {RadialDissipation::none, RadialDissipation::consistent})
    {
      const Scene s       = scene(GetParam(), dissipation, Bodies::damped);
      const auto &T       = *s.contact.kernel;
      const auto  P_t_P_n = multiply(*s.contact.tangential, *s.contact.normal, true, false);
      auto        C       = add(1., *s.system.damping, -0.5 * mu, *multiply(*P_t_P_n, *s.system.damping));
      if (s.contact_damping)
        C = add(1., *C, 1., *s.contact_damping);
      const auto expected = multiply(T, *multiply(*C, T), true, false);
      EXPECT_LT(difference(*with_friction(s.coupled, mu).damping, *expected), 1e-14);
      EXPECT_GT(symmetry_defect(*expected), 1e-3);
      EXPECT_LT(symmetry_defect(*with_friction(s.coupled, 0.).damping), 1e-14);
    }
}

TEST_P(Contact, DampingTracesTheCoefficients)
{
  // trace C_b = Σ c_b ‖P_bᵀ row‖² = 2 Σ c_b
  const Scene s   = scene(GetParam());
  const auto  c_b = radial_dissipation(s.interface, equal_load_shares(s.model, s.interface, s.operation), s.operation);
  double      sum = 0.;
  for (const double c : c_b)
    sum += 2. * c;
  double            trace = 0.;
  SparseMatrix::Row row;
  for (int i = 0; i < s.contact_damping->rows().n_local(); ++i)
    {
      s.contact_damping->get_row(i, row);
      for (const auto &[column, value] : row)
        if (column == s.contact_damping->rows().number(i))
          trace += value;
    }
  EXPECT_NEAR(dealii::Utilities::MPI::sum(trace, s.contact_damping->communicator()) / sum, 1., 1e-13);
  const std::vector<double> zeros(c_b.size(), 0.);
  EXPECT_EQ(contact_damping(s.contact, {zeros, {}}), nullptr);
  EXPECT_EQ(contact_damping(s.contact, {zeros, zeros}), nullptr);
}

TEST_P(Contact, DampingOfSpeedDependentFrictionActsAlongT)
{
  const Scene         s   = scene(GetParam());
  const auto         &P_t = *s.contact.tangential, &P_b = *s.contact.radial;
  std::vector<double> c_b, c_t;
  for (std::size_t c = 0; c < s.interface.size(); ++c)
    {
      c_b.push_back(1. + c);
      c_t.push_back(-3. + c % 5); // of either sign
    }
  const auto diagonal = [&](const std::vector<double> &values) {
    return Testing::diagonal(P_t.rows(), [&](const int c) { return values[c]; });
  };
  const auto both    = contact_damping(s.contact, {c_b, c_t});
  const auto along_t = contact_damping(s.contact, {{}, c_t});
  EXPECT_LT(difference(*both, *add(1., *contact_damping(s.contact, {c_b, {}}), 1., *along_t)), 1e-15);

  // P_t C = 2 diag(c_t) P_t, P_b C = 2 diag(c_b) P_b; friction takes no part: P_n C = 0
  EXPECT_LT(difference(*multiply(P_t, *both), *add(2., *multiply(*diagonal(c_t), P_t), 0., P_t)), 1e-14);
  EXPECT_LT(difference(*multiply(P_b, *both), *add(2., *multiply(*diagonal(c_b), P_b), 0., P_b)), 1e-14);
  EXPECT_LT(max_norm(*multiply(*s.contact.normal, *both)), 1e-14 * max_norm(*both));
  const CoupledSystem coupled = couple(s.system, s.contact, {c_b, c_t});
  EXPECT_TRUE(has_no_reaction_to_velocity(coupled));
  const auto without_friction = with_friction(coupled, 0.).damping;
  EXPECT_LT(symmetry_defect(*without_friction), 1e-14);
  EXPECT_EQ(difference(*with_friction(coupled, 0.4).damping, *without_friction), 0.);
}

TEST_P(Contact, UpdatedInverseEqualsSparseFactors)
{
  for (const auto &[bodies, shift] : {std::make_pair(Bodies::undamped, 0.), {Bodies::undamped, 5000.}, {Bodies::damped, 5000.}})
    {
      const Scene       s = scene(GetParam(), RadialDissipation::consistent, bodies);
      UpdatedInverse    inverse(s.coupled, shift, FactorizationLibrary::automatic);
      const MultiVector B = random_vectors(s.coupled.map(), 4);
      for (const double mu : {0., 0.4, 1.3, 0.2})
        {
          const SecondOrderSystem matrices = with_friction(s.coupled, mu);
          auto                    Q        = add(shift * shift, *matrices.mass, 1., *matrices.stiffness);
          Q                                = add(1., *Q, shift, *matrices.damping);
          inverse.set_friction_coefficient(mu);
          MultiVector X(B), Y(B);
          inverse.apply(B, X);
          factorize_general(*Q, FactorizationLibrary::automatic, "test matrix")->apply(B, Y);
          MultiVector difference(X);
          difference -= Y;
          for (int j = 0; j < 4; ++j)
            EXPECT_LT(column_norms(difference)[j], 1e-10 * column_norms(Y)[j]) << "shift " << shift << ", mu " << mu;

          // The frictionless inverse does not change.
          Y             = inverse.solve_frictionless(B);
          auto S        = add(shift * shift, *s.coupled.mass, 1., *s.coupled.stiffness);
          S             = add(1., *S, shift, *with_friction(s.coupled, 0.).damping);
          MultiVector R = *S * Y;
          R -= B;
          EXPECT_LT(column_norms(R)[0], 1e-10 * column_norms(B)[0]);
        }
      // Attachment modes that are solved for when they are needed, or not at all
      const UpdatedInverse waiting(s.coupled, shift, FactorizationLibrary::automatic, AttachmentModes::when_needed);
      const DenseMatrix    Y    = agreed_random_matrix(s.coupled.n_contact(), 3);
      MultiVector          U    = inverse.attachment_modes_times(Y);
      const double         size = column_norms(U)[0];
      U -= waiting.attachment_modes_times(Y);
      EXPECT_LT(column_norms(U)[0], 1e-12 * size);
      MultiVector late(waiting.attachment_modes());
      late -= inverse.attachment_modes();
      EXPECT_LT(column_norms(late)[0], 1e-12 * column_norms(inverse.attachment_modes())[0]);

      // ... or are not kept
      UpdatedInverse frugal(s.coupled, shift, FactorizationLibrary::automatic, AttachmentModes::not_kept);
      MultiVector    kept(B), solved(B);
      inverse.set_friction_coefficient(0.7);
      inverse.apply(B, kept);
      frugal.set_friction_coefficient(0.7);
      frugal.apply(B, solved);
      solved -= kept;
      EXPECT_LT(column_norms(solved)[0], 1e-10 * column_norms(kept)[0]);

      // Attachment modes: S X = A
      auto S = add(shift * shift, *s.coupled.mass, 1., *s.coupled.stiffness);
      S      = add(1., *S, shift, *with_friction(s.coupled, 0.).damping);
      EXPECT_LT(
        max_norm(replicate(*S * inverse.attachment_modes()) - replicate(s.coupled.friction_forces->columns(0, s.coupled.n_contact()))),
        1e-10);
    }
}

TEST_P(Contact, ComplexModesSatisfyTheUnreducedEquation)
{
  // M ü + C u̇ + K u = P_nᵀ r_n + μ P_tᵀ r_n, P_n u = 0, with t the disc's direction relative to the pin
  for (const auto &[dissipation, bodies] : {std::make_pair(RadialDissipation::none, Bodies::undamped),
                                            {RadialDissipation::consistent, Bodies::undamped},
                                            {RadialDissipation::none, Bodies::damped},
                                            {RadialDissipation::consistent, Bodies::damped}})
    {
      const Scene      s  = scene(GetParam(), dissipation, bodies);
      const double     mu = 0.6;
      SolverParameters solvers;
      solvers.complex_tolerance = 1e-10;
      UpdatedInverse inverse(s.coupled, 0., FactorizationLibrary::automatic);
      Progress       progress;
      const auto     modes = krylov_modes(s.coupled, inverse, 0., mu, 2. * M_PI * 4000., 12, solvers, progress);
      const int      k     = modes.lambda.size();
      ASSERT_GT(k, 3);

      const auto r      = normal_reactions(s.coupled, modes.lambda, *modes.real_part, *modes.imaginary_part);
      const auto forces = [&](const DenseMatrix &r) {
        const MultiVector distributed = distribute(r, s.contact.normal->rows());
        MultiVector       F           = transpose_times(*s.contact.normal, distributed);
        F.local() += mu * transpose_times(*s.contact.tangential, distributed).local();
        return F;
      };
      const MultiVector u_re = *s.contact.kernel * *modes.real_part, u_im = *s.contact.kernel * *modes.imaginary_part;
      EXPECT_LT(max_norm(replicate(*s.contact.normal * u_re)), 1e-14 * max_norm(replicate(u_re)));

      const MultiVector K_re = *s.system.stiffness * u_re, K_im = *s.system.stiffness * u_im;
      const MultiVector M_re = *s.system.mass * u_re, M_im = *s.system.mass * u_im;
      const MultiVector f_re = forces(r.real()), f_im = forces(r.imag());
      MultiVector       R_re(K_re), R_im(K_im);
      R_re -= f_re;
      R_im -= f_im;
      MultiVector C_re(u_re), C_im(u_im);
      C_re.local().setZero();
      C_im.local().setZero();
      for (const auto &C : {s.contact_damping, s.system.damping})
        if (C)
          {
            C_re += *C * u_re;
            C_im += *C * u_im;
          }
      for (int j = 0; j < k; ++j)
        {
          const std::complex<double> l = modes.lambda[j], l2 = l * l;
          R_re.col(j) += l2.real() * M_re.col(j) - l2.imag() * M_im.col(j);
          R_im.col(j) += l2.real() * M_im.col(j) + l2.imag() * M_re.col(j);
          R_re.col(j) += l.real() * C_re.col(j) - l.imag() * C_im.col(j);
          R_im.col(j) += l.real() * C_im.col(j) + l.imag() * C_re.col(j);
        }
      const auto residual_re = column_norms(R_re), residual_im = column_norms(R_im);
      const auto size_re = column_norms(K_re), size_im = column_norms(K_im), force_re = column_norms(f_re), force_im = column_norms(f_im);
      int        n_touching = 0;
      for (int j = 0; j < k; ++j)
        {
          const double size = std::hypot(size_re[j], size_im[j]);
          EXPECT_LT(std::hypot(residual_re[j], residual_im[j]), 1e-9 * size) << "mode " << j;
          n_touching += std::hypot(force_re[j], force_im[j]) > 1e-2 * size;
        }
      // The reactions matter in the balance, but for modes of the disc in its plane.
      EXPECT_GT(n_touching, k / 2);
    }
}
