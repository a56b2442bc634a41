// SPDX-License-Identifier: GPL-3.0-or-later

#include "faces.h"
#include "matrices.h"

#include <squeal/base/conventions.h>
#include <squeal/bases/reduced_basis.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/eigen/dense_quadratic.h>
#include <squeal/linear_algebra/dense_eigenproblems.h>
#include <squeal/linear_algebra/dense_lu.h>
#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/reduction/reduced_model.h>

#include <algorithm>
#include <map>
#include <memory>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr double mu        = 0.6;
  const double     omega_max = circular_frequency(6000.);

  /// A basis with its sizes in the tables of the paper.
  struct Kind
  {
    std::string name;
    int         n_r0, n_r;
  };
  const std::vector<Kind> component_kinds = {
    {"free", 428, 200},          {"fixed", 596, 368},          {"mixed", 596, 368},         {"free with r.a.m.", 428, 200},
    {"free + t.a.m.", 656, 428}, {"fixed + t.a.m.", 824, 596}, {"mixed + t.a.m.", 824, 596}};
  const std::vector<Kind> real_kinds = {{"real", 66, 66},
                                        {"real + t.a.m.", 294, 294},
                                        {"real + 1st-ord.", 132, 132},
                                        {"real + 1st-ord. two-sided", 198, 198},
                                        {"real + 1st-ord. two-sided + damping", 264, 264}};

  std::vector<Kind> all_kinds()
  {
    std::vector<Kind> kinds = component_kinds;
    kinds.insert(kinds.end(), real_kinds.begin(), real_kinds.end());
    return kinds;
  }

  /// Disc and three pins, with fewer elements if they are quadratic.
  Mesh mesh_of(const Case &c)
  {
    const int n = c.element == Element::trilinear ? 2 : 1;
    return sloped(extrude(polar_plan(0.1505, 0.3155, 1 + n, 9 * n,
                                     {{Plan::Side::top, -1, n, 1, 1}, {Plan::Side::top, 3, n, 0, 1}, {Plan::Side::bottom, 0, n, 1, 1}}),
                          layers(1, 2)),
                  c.slope);
  }

  /// A model with all vectors required by the bases.
  struct Bodies
  {
    explicit Bodies(const Case &c)
      : s(mesh_of(c), mounted(c.mounts), operating(RadialDissipation::consistent), c.element)
      , shift(stabilizing_shift(s.model, s.coupled, omega_max))
      , response(static_response(s.model, s.system, omega_max, FactorizationLibrary::automatic))
      , static_modes(s.model, s.interface, s.contact, s.system, response, omega_max, FactorizationLibrary::automatic)
      , inverse(s.coupled, shift, FactorizationLibrary::automatic)
    {
      SymmetricModesOptions options;
      options.tolerance = 1e-11;
      options.shift     = shift * shift;
      for (const auto &[source, component, boundary] : {std::make_tuple(BasisSource::disc_free, Component::disc, ContactBoundary::free),
                                                        {BasisSource::disc_sliding, Component::disc, ContactBoundary::sliding},
                                                        {BasisSource::pins_free, Component::pins, ContactBoundary::free},
                                                        {BasisSource::pins_sliding, Component::pins, ContactBoundary::sliding}})
        components[source] =
          component_modes(s.model, s.interface, s.interface, s.system, component, boundary, 4. * omega_max * omega_max, options).vectors;
      real = symmetric_modes(*s.coupled.stiffness, *s.coupled.mass, omega_max * omega_max, options);
    }

    BasisIngredients ingredients() const
    {
      BasisIngredients in;
      for (const auto &[source, vectors] : components)
        in.sets[source] = vectors.get();
      in.static_modes            = &static_modes;
      in.sets[BasisSource::real] = real.vectors.get();
      in.uncoupled               = &s.system;
      in.contact                 = &s.contact;
      in.coupled                 = &s.coupled;
      in.inverse                 = &inverse;
      in.friction_coefficient    = mu;
      return in;
    }

    /// The basis of this kind, computed on first use.
    const ReducedBasis &basis(const std::string &kind) const
    {
      auto found = made.find(kind);
      if (found == made.end())
        found = made.emplace(kind, reduced_basis(*find_recipe(kind), ingredients())).first;
      return found->second;
    }

    Scene                                               s;
    double                                              shift;
    InertiaRelief                                       response;
    StaticModes                                         static_modes;
    UpdatedInverse                                      inverse;
    std::map<BasisSource, std::shared_ptr<MultiVector>> components;
    SymmetricModes                                      real;
    mutable std::map<std::string, ReducedBasis>         made;
  };

  /// Largest M-norm of the component of a column of Y outside the span of the M-orthonormal X, relative to the column.
  double outside(const SparseMatrix &M, const MultiVector &X, MultiVector Y)
  {
    const std::vector<double> norms = column_products(Y, M * Y);
    for (int pass = 0; pass < 2; ++pass)
      multiply_add(-1., X, gram(X, M * Y), 1., Y);
    return std::sqrt((as_column(column_products(Y, M * Y)).array().max(0.) / as_column(norms).array()).maxCoeff());
  }

  /// Models of the cases, built on first use.
  class BasesOfACase : public ::testing::Test
  {
  protected:
    static const Bodies &bodies(const Case &c = {"flat"})
    {
      std::unique_ptr<Bodies> &result = of_case[c.name];
      if (!result)
        result = std::make_unique<Bodies>(c);
      return *result;
    }
    /// Frees distributed objects before MPI is finalised.
    static void TearDownTestSuite()
    {
      of_case.clear();
    }

  private:
    static inline std::map<std::string, std::unique_ptr<Bodies>> of_case;
  };

  class ReducedBases : public BasesOfACase, public ::testing::WithParamInterface<Case>
  {
  protected:
    const Bodies &b = bodies(GetParam());
  };
  INSTANTIATE_TEST_SUITE_P(Held, ReducedBases, ::testing::ValuesIn(held_cases.begin(), held_cases.begin() + 3));
  INSTANTIATE_TEST_SUITE_P(Free, ReducedBases, ::testing::ValuesIn(free_cases.begin(), free_cases.begin() + 2));
} // namespace

TEST(BasisTables, SizesOfThePaper)
{
  // Component modes up to 10 kHz (table 3), 66 real modes, 228 contact nodes
  BasisCounts counts;
  counts.sets    = {{BasisSource::disc_free, 80},
                    {BasisSource::disc_sliding, 80},
                    {BasisSource::pins_free, 120},
                    {BasisSource::pins_sliding, 60},
                    {BasisSource::real, 66}};
  counts.contact = 228;
  for (const Kind &kind : all_kinds())
    {
      const BasisSize size = nominal_size(*find_recipe(kind.name), counts);
      EXPECT_EQ(size.n_r0, kind.n_r0) << kind.name;
      EXPECT_EQ(size.n_r, kind.n_r) << kind.name;
    }
}

TEST_P(ReducedBases, KeepTheContactClosedAndAreOrthonormal)
{
  const int   n_c = b.s.interface.size();
  BasisCounts counts; // numbers of this model in the formulas of the tables
  counts.contact = n_c;
  for (const auto &[source, set] : b.ingredients().sets)
    counts.sets[source] = set->n_columns();
  for (const auto &[kind, n_r0, n_r] : all_kinds())
    {
      SCOPED_TRACE(kind);
      const ReducedBasis &basis = b.basis(kind);
      EXPECT_EQ(basis.n_nominal, basis.size() + basis.n_dropped);
      EXPECT_EQ(basis.n_nominal, nominal_size(*find_recipe(kind), counts).n_r);
      EXPECT_LT(orthonormality_defect(*b.s.coupled.mass, *basis.vectors), 1e-12);
      const MultiVector u = *b.s.contact.kernel * *basis.vectors;
      EXPECT_LT(max_norm(replicate(*b.s.contact.normal * u)), 1e-12 * max_norm(replicate(u)));
      const bool is_connected = find_recipe(kind)->is_connected();
      EXPECT_EQ(basis.n_nominal, basis.n_r0 - (is_connected ? n_c : 0));
      if (is_connected)
        {
          EXPECT_EQ(basis.connection.rank, n_c);
          EXPECT_EQ(basis.n_dropped, 0); // vectors of component bases are linearly independent
          EXPECT_GT(basis.connection.smallest_kept, 1e-9);
          EXPECT_EQ(basis.connection.largest_dropped, 0.);
          EXPECT_LT(basis.connection.constraint_error, 1e-10);
        }
    }
}

TEST_P(ReducedBases, FrictionlessRitzValuesComeDownToTheExactOnes)
{
  const auto &exact  = b.real.eigenvalues;
  const auto  values = [&](const ReducedBasis &basis) {
    const MultiVector &T = *basis.vectors;
    return symmetric_eigenpairs(gram(T, *b.s.coupled.stiffness * T), gram(T, *b.s.coupled.mass * T)).values;
  };
  const double rounding  = 1e-9 * omega_max * omega_max;
  const auto   no_higher = [&](const std::vector<double> &larger, const std::vector<double> &smaller, const std::string &what) {
    for (std::size_t j = 0; j < exact.size(); ++j)
      EXPECT_LE(larger[j], smaller[j] + rounding) << what << ", mode " << j;
  };
  const auto error = [&](const std::vector<double> &found) {
    double largest = 0.;
    for (std::size_t j = b.real.n_rigid_body; j < exact.size(); ++j)
      largest = std::max(largest, found[j] / exact[j] - 1.);
    return largest;
  };

  std::map<std::string, std::vector<double>> found;
  for (const auto &[kind, n_r0, n_r] : all_kinds())
    {
      found[kind] = values(b.basis(kind));
      no_higher(exact, found[kind], kind);
    }
  no_higher(found["free + t.a.m."], found["free with r.a.m."], "free + t.a.m. contains r.a.m.");
  // Responses of a free disc are almost rigid, and orthonormalisation loses a digit
  const double exactness = b.real.n_rigid_body > 0 ? 1e-7 : 1e-8;
  for (const auto &[kind, n_r0, n_r] : real_kinds)
    EXPECT_LT(error(found[kind]), exactness) << kind;
  for (const std::string kind : {"free", "fixed", "mixed"})
    {
      no_higher(found[kind + " + t.a.m."], found[kind], kind);
      EXPECT_LT(error(found[kind]), 0.03) << kind;
    }
}

TEST_P(ReducedBases, StaticallyCompleteBasesGiveStaticResponsesExactly)
{
  if (GetParam().mounts.empty())
    return; // static responses of a free disc are almost rigid or do not exist
  const auto missing = [&](const std::string &kind) {
    return outside(*b.s.coupled.mass, *b.basis(kind).vectors, b.inverse.attachment_modes());
  };
  // Tangential loads on the contact: K_c u = A
  for (const std::string kind : {"free + t.a.m.", "fixed + t.a.m.", "mixed + t.a.m.", "real + t.a.m."})
    EXPECT_LT(missing(kind), 1e-7) << kind;
  // Bases without tangential attachment modes do not contain these responses
  for (const std::string kind : {"free", "fixed", "mixed", "free with r.a.m.", "real"})
    EXPECT_GT(missing(kind), 1e-2) << kind;

  // Loads f whose static response without contact is a mode; with contact, (K_c − μ A V_K) u = T_cᵀf − μ/2 A P_n f
  const MultiVector f = *b.s.system.stiffness * view(*b.components.at(BasisSource::disc_free), 0, 4);
  for (const auto &[kind, friction] :
       {std::make_pair(std::string("free"), 0.), {"mixed", 0.}, {"free + t.a.m.", mu}, {"mixed + t.a.m.", mu}, {"free with r.a.m.", mu}})
    {
      MultiVector load = transpose_times(*b.s.contact.kernel, f);
      load.local() -= 0.5 * friction * (*b.s.coupled.friction_forces * replicate(*b.s.contact.normal * f)).local();
      const auto  matrix = with_friction(b.s.coupled, friction).stiffness;
      MultiVector u(load.map(), load.n_columns());
      factorize_general(*matrix, "stiffness with friction")->apply(load, u);

      const MultiVector &T          = *b.basis(kind).vectors;
      MultiVector        difference = T * regular_lu(gram(T, *matrix * T), "reduced stiffness").solve(gram(T, load));
      difference.local() -= u.local();
      EXPECT_LT((as_column(column_norms(difference)).array() / as_column(column_norms(u)).array()).maxCoeff(), 1e-7) << kind;
    }
}

TEST_P(ReducedBases, OfRealModesSpanWhatTheyAreMadeOf)
{
  const SparseMatrix &M     = *b.s.coupled.mass;
  const MultiVector   right = friction_response(b.s.coupled, b.inverse, *b.real.vectors, Side::right),
                    left    = friction_response(b.s.coupled, b.inverse, *b.real.vectors, Side::left),
                    damping = damping_response(b.s.coupled, b.inverse, *b.real.vectors, mu);
  for (const auto &[kind, n_r0, n_r] : real_kinds)
    {
      const MultiVector &T = *b.basis(kind).vectors;
      EXPECT_LT(outside(M, T, *b.real.vectors), 1e-9);
      const bool is_of_first_order = kind.find("1st-ord.") != std::string::npos, is_two_sided = kind.find("two-sided") != std::string::npos;
      EXPECT_EQ(outside(M, T, right) < 1e-6, kind == "real + t.a.m." || is_of_first_order) << kind;
      EXPECT_EQ(outside(M, T, left) < 1e-6, is_two_sided) << kind;
      EXPECT_EQ(outside(M, T, damping) < 1e-6, kind.find("damping") != std::string::npos) << kind;
    }
}

TEST(CompleteBasis, GivesTheFullModel)
{
  // All sliding component modes and the constraint modes span all displacements that keep the contact closed
  const std::vector<PolarPin> pins = {{Plan::Side::top, 0, 1, 0, 1}, {Plan::Side::bottom, 2, 1, 0, 1}};
  const Scene                 s(sloped(extrude(polar_plan(0.1505, 0.3155, 1, 7, pins), layers(1, 2)), 0.3), mounted(held),
                                operating(RadialDissipation::consistent));
  const InertiaRelief         response = static_response(s.model, s.system, omega_max, FactorizationLibrary::automatic);
  const StaticModes           static_modes(s.model, s.interface, s.contact, s.system, response, omega_max, FactorizationLibrary::automatic);
  const auto                  complete = [&](const Component component) {
    const auto T = component_kernel(s.model, s.interface, component, ContactBoundary::sliding);
    return *T * unit_vectors(T->columns());
  };
  const MultiVector disc = complete(Component::disc), of_pins = complete(Component::pins);
  BasisIngredients  in;
  in.sets[BasisSource::disc_sliding] = &disc;
  in.sets[BasisSource::pins_sliding] = &of_pins;
  in.static_modes                    = &static_modes;
  in.uncoupled                       = &s.system;
  in.contact                         = &s.contact;
  in.coupled                         = &s.coupled;
  const ReducedBasis basis           = reduced_basis(*find_recipe("fixed"), in);
  ASSERT_EQ(basis.size(), s.coupled.map().n());

  ReducedModel model(s.coupled);
  model.extend(*basis.vectors);
  for (const double friction : {0., mu})
    {
      const double            limit    = circular_frequency(20000.);
      const SecondOrderSystem matrices = with_friction(s.coupled, friction);
      const DenseMatrix       C        = to_dense(*matrices.damping);
      const auto              full     = dense_quadratic_modes(to_dense(*matrices.mass), &C, to_dense(*matrices.stiffness), limit);
      const ReducedPencil     pencil   = model.at(s.coupled.at(friction));
      const auto              reduced  = dense_quadratic_modes(pencil.mass, &pencil.damping, pencil.stiffness, limit);
      ASSERT_GT(full.values.size(), 20u);
      EXPECT_LT(largest(distances(full.values, reduced.values)), 1e-10);
    }

  // With an additional vector, the basis is larger than the coupled system
  const MultiVector first = view(disc, 0, 1), more = join({&disc, &first});
  in.sets[BasisSource::disc_sliding] = &more;
  EXPECT_THROW(reduced_basis(*find_recipe("fixed"), in), SolverError);
}

TEST_F(BasesOfACase, DependentVectorsAreDropped)
{
  const Bodies      &b     = bodies();
  const MultiVector &pins  = *b.components.at(BasisSource::pins_free);
  BasisIngredients   in    = b.ingredients();
  const MultiVector  twice = view(pins, 0, 3), doubled = join({&pins, &twice});
  const auto         once         = b.basis("free");
  in.sets[BasisSource::pins_free] = &doubled;
  const auto again                = reduced_basis(*find_recipe("free"), in);
  EXPECT_EQ(again.n_r0, once.n_r0 + 3);
  EXPECT_EQ(again.n_nominal, once.n_nominal + 3);
  EXPECT_EQ(again.n_dropped, once.n_dropped + 3);
  EXPECT_GT(again.condition, 1e12);
  EXPECT_LT(outside(*b.s.coupled.mass, *once.vectors, *again.vectors), 1e-7);
}

TEST_F(BasesOfACase, RigidBodyMotionsAreAddedWhereTheyAreMissing)
{
  const Bodies &b      = bodies({"free disc, flat", 0., Element::trilinear, {}});
  const int     n_free = b.static_modes.response.rigid_body_modes()->n_columns();
  ASSERT_EQ(n_free, 6);
  const MultiVector &modes        = *b.components.at(BasisSource::disc_free);
  const MultiVector  elastic      = view(modes, n_free, modes.n_columns() - n_free);
  BasisIngredients   in           = b.ingredients();
  const auto         with         = b.basis("free");
  in.sets[BasisSource::disc_free] = &elastic;
  const auto without              = reduced_basis(*find_recipe("free"), in);
  EXPECT_EQ(with.n_r0, without.n_r0);
  EXPECT_EQ(with.n_nominal, without.n_nominal);
  EXPECT_LT(outside(*b.s.coupled.mass, *with.vectors, *without.vectors), 1e-6);
}

TEST_F(BasesOfACase, PrincipalAxesOfSnapshots)
{
  // Six snapshots of rank three
  const Bodies     &b     = bodies();
  const MultiVector first = view(*b.real.vectors, 0, 3), snapshots = join({&first, &first});
  BasisIngredients  in;
  in.coupled                      = &b.s.coupled;
  in.sets[BasisSource::snapshots] = &snapshots;
  BasisOptions options;
  for (const int size : {3, 2})
    {
      const auto basis = reduced_basis(*find_recipe("POD"), in, options);
      EXPECT_EQ(basis.n_r0, 6);
      EXPECT_EQ(basis.size(), size);
      EXPECT_EQ(basis.n_dropped, 6 - size);
      EXPECT_EQ(basis.tolerance, options.pod_tolerance);
      EXPECT_EQ(outside(*b.s.coupled.mass, *basis.vectors, first) < 1e-12, size == 3);
      options.pod_size = 2;
    }
}
