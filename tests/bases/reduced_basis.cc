#include "matrices.h"
#include "bases/cases.h"

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/bases/reduced_basis.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/eigen/dense_quadratic.h>
#include <squeal/linear_algebra/dense_eigenproblems.h>
#include <squeal/linear_algebra/dense_lu.h>
#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/reduction/reduced_model.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>

using namespace Squeal;
using namespace Squeal::Testing;
using Complex = std::complex<double>;

namespace
{
  constexpr double mu        = 0.6;
  const double     omega_max = circular_frequency(6000.);

  const Case flat = {"flat", 0., Element::trilinear, held};

  const std::vector<std::string> component_kinds = {"free",          "fixed",          "mixed",         "free with r.a.m.",
                                                    "free + t.a.m.", "fixed + t.a.m.", "mixed + t.a.m."};
  const std::vector<std::string> real_kinds      = {"real", "real + t.a.m.", "real + 1st-ord.", "real + 1st-ord. two-sided",
                                                    "real + 1st-ord. two-sided + damping"};

  std::vector<std::string> all_kinds()
  {
    std::vector<std::string> kinds = component_kinds;
    kinds.insert(kinds.end(), real_kinds.begin(), real_kinds.end());
    return kinds;
  }

  /// Disc and three pins; in quadratic elements half as many.
  HexMesh mesh_of(const Case &c)
  {
    const int n = c.element == Element::trilinear ? 2 : 1;
    return c.sloped(extrude(polar_plan(0.1505, 0.3155, 1 + n, 9 * n,
                                       {{Plan::Side::top, -1, n, 1, 1}, {Plan::Side::top, 3, n, 0, 1}, {Plan::Side::bottom, 0, n, 1, 1}}),
                            layers(1, 2)));
  }

  /// A scene with everything that bases are made from.
  struct Bodies
  {
    explicit Bodies(const Case &c, const double component_band = 2.)
      : s(mesh_of(c), mounted(c.mounts), operating(RadialDissipation::consistent), c.element)
      , shift(stabilizing_shift(s.model, s.coupled, omega_max))
      , response(static_response(s.model, s.system, omega_max, FactorizationLibrary::automatic))
      , static_modes(s.model, s.interface, s.contact, s.system, response, omega_max, FactorizationLibrary::automatic)
      , inverse(s.coupled, shift, FactorizationLibrary::automatic)
    {
      SymmetricModesOptions options;
      options.tolerance      = 1e-11;
      options.shift          = shift * shift;
      const double limit     = component_band * component_band * omega_max * omega_max;
      const auto   component = [&](const Component which, const ContactBoundary boundary) {
        return component_modes(s.model, s.interface, s.interface, s.system, which, boundary, limit, options).vectors;
      };
      disc_free    = component(Component::disc, ContactBoundary::free);
      disc_sliding = component(Component::disc, ContactBoundary::sliding);
      pins_free    = component(Component::pins, ContactBoundary::free);
      pins_sliding = component(Component::pins, ContactBoundary::sliding);
      real         = symmetric_modes(*s.coupled.stiffness, *s.coupled.mass, omega_max * omega_max, options);
    }

    BasisIngredients ingredients() const
    {
      BasisIngredients in;
      in.sets[BasisSource::disc_free]    = disc_free.get();
      in.sets[BasisSource::disc_sliding] = disc_sliding.get();
      in.sets[BasisSource::pins_free]    = pins_free.get();
      in.sets[BasisSource::pins_sliding] = pins_sliding.get();
      in.static_modes                    = &static_modes;
      in.sets[BasisSource::real]         = real.vectors.get();
      in.uncoupled                       = &s.system;
      in.contact                         = &s.contact;
      in.coupled                         = &s.coupled;
      in.inverse                         = &inverse;
      in.friction_coefficient            = mu;
      return in;
    }

    Scene                        s;
    double                       shift;
    InertiaRelief                response;
    StaticModes                  static_modes;
    UpdatedInverse               inverse;
    std::shared_ptr<MultiVector> disc_free, disc_sliding, pins_free, pins_sliding;
    SymmetricModes               real;
  };

  /// Largest M-norm that a column of Y, of unit M-norm, has outside of the span of the M-orthonormal X.
  double outside(const SparseMatrix &M, const MultiVector &X, MultiVector Y)
  {
    const std::vector<double> norms = column_products(Y, M * Y);
    for (int pass = 0; pass < 2; ++pass)
      multiply_add(-1., X, gram(X, M * Y), 1., Y);
    const std::vector<double> rest    = column_products(Y, M * Y);
    double                    largest = 0.;
    for (std::size_t j = 0; j < norms.size(); ++j)
      largest = std::max(largest, std::sqrt(std::max(0., rest[j]) / norms[j]));
    return largest;
  }

  /// ω² of K_c and M_c on a basis, ascending.
  std::vector<double> ritz_values(const CoupledSystem &system, const MultiVector &T)
  {
    return symmetric_eigenpairs(gram(T, *system.stiffness * T), gram(T, *system.mass * T)).values;
  }

  class ReducedBases : public ::testing::TestWithParam<Case>
  {
  protected:
    /// The bodies of the case, made when a test first asks for them.
    static const Bodies &bodies()
    {
      std::unique_ptr<Bodies> &result = of_case[GetParam().name];
      if (!result)
        result = std::make_unique<Bodies>(GetParam());
      return *result;
    }
    /// Nothing distributed may outlive MPI.
    static void TearDownTestSuite()
    {
      of_case.clear();
    }

  private:
    static inline std::map<std::string, std::unique_ptr<Bodies>> of_case;
  };
  INSTANTIATE_TEST_SUITE_P(Scenes,
                           ReducedBases,
                           ::testing::Values(flat,
                                             Case{"flat, quadratic", 0., Element::quadratic, held},
                                             Case{"cone", 0.3, Element::trilinear, held},
                                             Case{"free disc, flat", 0., Element::trilinear, {}},
                                             Case{"free disc, cone", 0.3, Element::trilinear, {}}));
} // namespace

TEST(BasisTables, SizesOfThePaper)
{
  // Component modes up to 10 kHz (table 3), 66 real modes, 228 contact nodes
  BasisCounts counts;
  counts.sets                                               = {{BasisSource::disc_free, 80},
                                                               {BasisSource::disc_sliding, 80},
                                                               {BasisSource::pins_free, 120},
                                                               {BasisSource::pins_sliding, 60},
                                                               {BasisSource::real, 66}};
  counts.contact                                            = 228;
  const std::map<std::string, std::pair<int, int>> expected = {{"free", {428, 200}},
                                                               {"fixed", {596, 368}},
                                                               {"mixed", {596, 368}},
                                                               {"free + t.a.m.", {656, 428}},
                                                               {"free with r.a.m.", {428, 200}},
                                                               {"fixed + t.a.m.", {824, 596}},
                                                               {"mixed + t.a.m.", {824, 596}},
                                                               {"real", {66, 66}},
                                                               {"real + t.a.m.", {294, 294}},
                                                               {"real + 1st-ord.", {132, 132}},
                                                               {"real + 1st-ord. two-sided", {198, 198}},
                                                               {"real + 1st-ord. two-sided + damping", {264, 264}}};
  std::size_t                                      n_found  = 0;
  std::set<std::string>                            names;
  for (const BasisRecipe &basis : basis_recipes())
    {
      if (const auto it = expected.find(basis.name); it != expected.end())
        {
          ++n_found;
          const BasisSize size = nominal_size(basis, counts);
          EXPECT_EQ(size.n_r0, it->second.first) << basis.name;
          EXPECT_EQ(size.n_r, it->second.second) << basis.name;
        }
      EXPECT_TRUE(names.insert(basis.name).second) << basis.name;
      EXPECT_EQ(find_recipe(basis.name), &basis) << basis.name;
      // Either all columns are of the uncoupled bodies or none
      for (const BasisPart *part : basis.parts)
        EXPECT_EQ(part->is_uncoupled, basis.is_connected()) << basis.name;
    }
  EXPECT_EQ(n_found, expected.size());
  EXPECT_EQ(find_recipe("free with r.a.m.")->columns(), "Phi_f^D Phi_f^P (Psi_amu^D - Psi_amu^P)");
  EXPECT_EQ(find_recipe("mixed + t.a.m.")->columns(), "Phi_f^D Phi_s^P Psi_an^D Psi_cn^P (Psi_at^D - Psi_at^P)");
  EXPECT_FALSE(find_recipe("mixed")->needs_friction);
  EXPECT_TRUE(find_recipe("real")->needs_friction);
  EXPECT_TRUE(find_recipe("real + 1st-ord. two-sided + damping")->needs_damping);
  EXPECT_TRUE(find_recipe("free with r.a.m.")->rests_on(BasisSource::tangential_attachment));
  EXPECT_FALSE(find_recipe("free")->rests_on(BasisSource::tangential_attachment));
}

TEST_P(ReducedBases, KeepTheContactClosedAndAreOrthonormal)
{
  const Bodies &b   = bodies();
  const int     n_c = b.s.interface.size();
  BasisCounts   counts; // as they are, by the formulas of the tables
  counts.contact = n_c;
  for (const auto &[source, set] : b.ingredients().sets)
    counts.sets[source] = set->n_columns();
  for (const std::string &kind : all_kinds())
    {
      const ReducedBasis basis = reduced_basis(*find_recipe(kind), b.ingredients());
      SCOPED_TRACE(kind);
      const SparseMatrix &M = *b.s.coupled.mass;
      EXPECT_EQ(basis.n_nominal, basis.size() + basis.n_dropped);
      EXPECT_GE(basis.n_dropped, 0);
      EXPECT_EQ(basis.n_nominal, nominal_size(*find_recipe(kind), counts).n_r);
      EXPECT_LT(orthonormality_defect(M, *basis.vectors), 1e-12);
      EXPECT_LE(basis.orthonormality, 1e-12);
      EXPECT_GE(basis.condition, 1.);
      const MultiVector u = *b.s.contact.kernel * *basis.vectors;
      EXPECT_LT(max_norm(replicate(*b.s.contact.normal * u)), 1e-12 * max_norm(replicate(u)));
      if (find_recipe(kind)->is_connected())
        {
          EXPECT_EQ(basis.connection.rank, n_c);
          EXPECT_EQ(basis.n_nominal, basis.n_r0 - n_c);
          EXPECT_EQ(basis.n_dropped, 0); // component bases hold no vector twice
          EXPECT_GT(basis.connection.smallest_kept, 1e-9);
          EXPECT_EQ(basis.connection.largest_dropped, 0.);
          EXPECT_LT(basis.connection.constraint_error, 1e-10);
        }
      else
        EXPECT_EQ(basis.n_nominal, basis.n_r0);
    }
}

TEST_P(ReducedBases, FrictionlessRitzValuesComeDownToTheExactOnes)
{
  const Bodies &b      = bodies(), more(GetParam(), 3.);
  const auto   &exact  = b.real.eigenvalues;
  const auto    values = [&](const Bodies &bodies, const std::string &kind) {
    return ritz_values(b.s.coupled, *reduced_basis(*find_recipe(kind), bodies.ingredients()).vectors);
  };
  const double rounding  = 1e-9 * omega_max * omega_max;
  const auto   no_higher = [&](const std::vector<double> &larger, const std::vector<double> &smaller, const char *what) {
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
  for (const std::string &kind : all_kinds())
    {
      found[kind] = values(b, kind);
      no_higher(exact, found[kind], kind.c_str());
    }
  no_higher(found["free + t.a.m."], found["free"], "free + t.a.m.");
  no_higher(found["free + t.a.m."], found["free with r.a.m."], "free + t.a.m. contains r.a.m.");
  no_higher(found["fixed + t.a.m."], found["fixed"], "fixed + t.a.m.");
  no_higher(found["mixed + t.a.m."], found["mixed"], "mixed + t.a.m.");
  // Responses of a free disc are next to rigid, and orthonormalising them costs a digit.
  const double exactness = b.real.n_rigid_body > 0 ? 1e-7 : 1e-8;
  for (const std::string &kind : real_kinds)
    EXPECT_LT(error(found[kind]), exactness) << kind;
  for (const std::string kind : {"free", "fixed", "mixed"})
    {
      const auto enriched = values(more, kind);
      no_higher(enriched, found[kind], "more component modes");
      EXPECT_LT(error(found[kind]), 0.1) << kind;
      EXPECT_LT(error(enriched), 0.03) << kind;
    }
}

TEST_P(ReducedBases, StaticallyCompleteBasesGiveStaticResponsesExactly)
{
  if (GetParam().mounts.empty())
    return; // responses of a free disc are next to rigid, if there are any
  const Bodies       &b = bodies();
  const SparseMatrix &M = *b.s.coupled.mass;

  // Tangential loads on the contact: K_c u = A
  for (const std::string kind : {"free + t.a.m.", "fixed + t.a.m.", "mixed + t.a.m.", "real + t.a.m."})
    EXPECT_LT(outside(M, *reduced_basis(*find_recipe(kind), b.ingredients()).vectors, b.inverse.attachment_modes()), 1e-7) << kind;
  // They are needed for that.
  for (const std::string kind : {"free", "fixed", "mixed", "free with r.a.m.", "real"})
    EXPECT_GT(outside(M, *reduced_basis(*find_recipe(kind), b.ingredients()).vectors, b.inverse.attachment_modes()), 1e-2) << kind;

  // Loads f that the bodies' own modes respond to, and the contact forces they bring about:
  // (K_c − μ A V_K) u = T_cᵀf − μ/2 A P_n f
  const MultiVector f = *b.s.system.stiffness * view(*b.disc_free, 0, 4);
  for (const auto &[kind, friction] :
       {std::make_pair(std::string("free"), 0.), {"mixed", 0.}, {"free + t.a.m.", mu}, {"mixed + t.a.m.", mu}, {"free with r.a.m.", mu}})
    {
      MultiVector load = transpose_times(*b.s.contact.kernel, f);
      load.local() -= 0.5 * friction * (*b.s.coupled.friction_forces * replicate(*b.s.contact.normal * f)).local();
      const auto  matrix = with_friction(b.s.coupled, friction).stiffness;
      MultiVector u(load.map(), load.n_columns());
      factorize_general(*matrix, FactorizationLibrary::automatic, "stiffness with friction")->apply(load, u);

      const MultiVector T          = *reduced_basis(*find_recipe(kind), b.ingredients()).vectors;
      MultiVector       difference = T * regular_lu(gram(T, *matrix * T), "reduced stiffness").solve(gram(T, load));
      difference.local() -= u.local();
      for (int j = 0; j < f.n_columns(); ++j)
        EXPECT_LT(column_norms(difference)[j], 1e-7 * column_norms(u)[j]) << kind;
    }
}

TEST_P(ReducedBases, SpanWhatTheyAreMadeOf)
{
  const Bodies       &b     = bodies();
  const SparseMatrix &M     = *b.s.coupled.mass;
  const MultiVector   right = friction_response(b.s.coupled, b.inverse, *b.real.vectors, Side::right),
                    left    = friction_response(b.s.coupled, b.inverse, *b.real.vectors, Side::left),
                    damping = damping_response(b.s.coupled, b.inverse, *b.real.vectors, mu);
  for (const std::string &kind : real_kinds)
    {
      const MultiVector T = *reduced_basis(*find_recipe(kind), b.ingredients()).vectors;
      EXPECT_LT(outside(M, T, *b.real.vectors), 1e-9);
      const auto all = [&](const std::string &from) {
        return std::find(real_kinds.begin(), real_kinds.end(), kind) >= std::find(real_kinds.begin(), real_kinds.end(), from);
      };
      EXPECT_EQ(outside(M, T, right) < 1e-6, kind == "real + t.a.m." || all("real + 1st-ord.")) << kind;
      EXPECT_EQ(outside(M, T, left) < 1e-6, all("real + 1st-ord. two-sided")) << kind;
      EXPECT_EQ(outside(M, T, damping) < 1e-6, all("real + 1st-ord. two-sided + damping")) << kind;
    }

  // A connected basis lies in the span of its components.
  for (const std::string &kind : component_kinds)
    {
      const MultiVector u     = *b.s.contact.kernel * *reduced_basis(*find_recipe(kind), b.ingredients()).vectors;
      const bool        fixed = kind == "fixed" || kind == "fixed + t.a.m.";
      const MultiVector parts =
        join_all({fixed ? *b.disc_sliding : *b.disc_free, *b.pins_free, *b.pins_sliding, b.static_modes.normal_attachment(Component::disc),
                  b.static_modes.normal_attachment(Component::pins), b.static_modes.constraint(Component::disc),
                  b.static_modes.constraint(Component::pins), b.static_modes.tangential_attachment()});
      EXPECT_LT(outside(*b.s.system.mass, orthonormalize(*b.s.system.mass, nullptr, parts, 1e-12), u), 1e-6) << kind;
    }
}

TEST_P(ReducedBases, CompleteComponentsGiveTheFullModel)
{
  // All vectors of the sliding components and the constraint modes span everything that keeps the contact closed.
  const Scene         s(GetParam().sloped(extrude(
                          polar_plan(0.1505, 0.3155, 1, 7, {{Plan::Side::top, 0, 1, 0, 1}, {Plan::Side::bottom, 2, 1, 0, 1}}), layers(1, 2))),
                        mounted(held), operating(RadialDissipation::consistent));
  const InertiaRelief response = static_response(s.model, s.system, omega_max, FactorizationLibrary::automatic);
  const StaticModes   static_modes(s.model, s.interface, s.contact, s.system, response, omega_max, FactorizationLibrary::automatic);
  const auto          complete = [&](const Component component) {
    const auto T = component_kernel(s.model, s.interface, component, ContactBoundary::sliding);
    return *T * unit_vectors(T->columns());
  };
  const MultiVector disc = complete(Component::disc), pins = complete(Component::pins);
  BasisIngredients  in;
  in.sets[BasisSource::disc_sliding] = &disc;
  in.sets[BasisSource::pins_sliding] = &pins;
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
      ASSERT_EQ(reduced.values.size(), full.values.size());
      for (std::size_t j = 0; j < full.values.size(); ++j)
        {
          double nearest = std::numeric_limits<double>::infinity();
          for (const Complex &l : reduced.values)
            nearest = std::min(nearest, std::abs(l - full.values[j]) / std::abs(l));
          EXPECT_LT(nearest, 1e-10) << "mode " << j;
        }
    }

  // One vector more is one too many.
  const MultiVector first = view(disc, 0, 1), more = join({&disc, &first});
  in.sets[BasisSource::disc_sliding] = &more;
  EXPECT_THROW(reduced_basis(*find_recipe("fixed"), in), SolverError);
}

TEST(ReducedBasis, DependentVectorsAreDropped)
{
  const Bodies      b(flat);
  BasisIngredients  in    = b.ingredients();
  const MultiVector twice = view(*b.pins_free, 0, 3), doubled = join({b.pins_free.get(), &twice});
  const auto        once          = reduced_basis(*find_recipe("free"), in);
  in.sets[BasisSource::pins_free] = &doubled;
  const auto again                = reduced_basis(*find_recipe("free"), in);
  EXPECT_EQ(again.n_r0, once.n_r0 + 3);
  EXPECT_EQ(again.n_nominal, once.n_nominal + 3);
  EXPECT_EQ(again.n_dropped, once.n_dropped + 3);
  EXPECT_GT(again.condition, 1e12);
  EXPECT_LT(outside(*b.s.coupled.mass, *once.vectors, *again.vectors), 1e-7);
}

TEST(ReducedBasis, RigidBodyMotionsAreAddedWhereTheyAreMissing)
{
  const Bodies b({"free disc", 0., Element::trilinear, {}});
  const int    n_free = b.static_modes.rigid_body_modes()->n_columns();
  ASSERT_EQ(n_free, 6);
  const MultiVector elastic       = view(*b.disc_free, n_free, b.disc_free->n_columns() - n_free);
  BasisIngredients  in            = b.ingredients();
  const auto        with          = reduced_basis(*find_recipe("free"), in);
  in.sets[BasisSource::disc_free] = &elastic;
  const auto without              = reduced_basis(*find_recipe("free"), in);
  EXPECT_EQ(with.n_r0, without.n_r0);
  EXPECT_EQ(with.n_nominal, without.n_nominal);
  EXPECT_LT(outside(*b.s.coupled.mass, *with.vectors, *without.vectors), 1e-6);
}

TEST(ReducedBasis, PrincipalAxesOfSnapshots)
{
  // Six vectors of which three are combinations of the others
  const Bodies      b(flat);
  const MultiVector first = view(*b.real.vectors, 0, 3), snapshots = join({&first, &first});
  BasisIngredients  in;
  in.coupled                      = &b.s.coupled;
  in.sets[BasisSource::snapshots] = &snapshots;
  BasisOptions options;
  const auto   basis = reduced_basis(*find_recipe("POD"), in, options);
  EXPECT_EQ(basis.n_r0, 6);
  EXPECT_EQ(basis.size(), 3);
  EXPECT_EQ(basis.n_dropped, 3);
  EXPECT_EQ(basis.tolerance, options.pod_tolerance);
  EXPECT_LT(outside(*b.s.coupled.mass, *basis.vectors, first), 1e-12);
  options.pod_size = 2;
  EXPECT_EQ(reduced_basis(*find_recipe("POD"), in, options).size(), 2);
}

TEST(ReducedBasis, SaysWhatIsMissing)
{
  const Bodies b(flat);
  const auto   message = [&](const std::string &kind, const std::function<void(BasisIngredients &)> &remove) {
    BasisIngredients in = b.ingredients();
    remove(in);
    try
      {
        reduced_basis(*find_recipe(kind), in);
      }
    catch (const SolverError &error)
      {
        return std::string(error.what());
      }
    return std::string();
  };
  const auto names   = [&](const std::string &text, const std::string &what) { EXPECT_NE(text.find(what), std::string::npos) << text; };
  const auto without = [&](const std::string &kind, const BasisSource source) {
    return message(kind, [source](BasisIngredients &in) { in.sets[source] = nullptr; });
  };
  names(without("free", BasisSource::disc_free), "Phi_f^D");
  names(without("mixed", BasisSource::pins_sliding), "Phi_s^P");
  names(without("mixed", BasisSource::pins_sliding), "`mixed`");
  names(without("real", BasisSource::real), "Phi_R");
  names(message("real + t.a.m.", [](auto &in) { in.inverse = nullptr; }), "UpdatedInverse");
  names(message("free", [](auto &in) { in.static_modes = nullptr; }), "StaticModes");
  names(message("POD", [](auto &) {}), "complex modes");
  names(message("residual-grown", [](auto &) {}), "residuals");
  EXPECT_EQ(without("free", BasisSource::real), "");
}
