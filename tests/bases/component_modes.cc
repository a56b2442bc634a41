#include "matrices.h"
#include "scenes.h"

#include <squeal/bases/component_modes.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/linear_algebra/weighted_gram.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <utility>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr auto A = ModeFamily::axial, R = ModeFamily::radial, C = ModeFamily::circumferential;
  constexpr auto F = ModeFamily::flexural, T = ModeFamily::torsional, L = ModeFamily::longitudinal;

  /// Of a pin.
  ModeLabel pin_mode(const ModeFamily family, const int rank)
  {
    return {family, 0, 0, rank};
  }

  std::vector<std::string> texts(const std::vector<ModeLabel> &labels)
  {
    std::vector<std::string> result;
    for (const ModeLabel &label : labels)
      result.push_back(to_string(label));
    return result;
  }

  const std::vector<PolarPin> two_pins = {{Plan::Side::top, -1, 2, 2, 2}, {Plan::Side::bottom, 7, 2, 1, 2}};

  Scene disc_scene(const MaterialParameters &materials = mounted())
  {
    return Scene(extrude(polar_plan(0.15, 0.31, 6, 36, two_pins), layers(1, 3)), materials, operating());
  }

  /// A round pin, its axis at (0.2, 0).
  Scene pin_scene()
  {
    return Scene(extrude(round_plan(0.2, 0.026, 2), layers(1, 4)), mounted({}), operating());
  }

  /// Displacement of the disc in the direction of a family, from radius and angle.
  MultiVector along(const Scene &s, const ModeFamily family, const std::function<double(double, double)> &value)
  {
    return displacements(s.model, 0, [&](const Point3 &p) {
      const double r = std::hypot(p[0], p[1]), u = value(r, std::atan2(p[1], p[0])), x = u * p[0] / r, y = u * p[1] / r;
      return family == A ? Point3{{0., 0., u}} : family == R ? Point3{{x, y, 0.}} : Point3{{-y, x, 0.}};
    });
  }
} // namespace

TEST(NodalMasses, AddUpToTheMass)
{
  const Scene s      = disc_scene();
  const auto  masses = nodal_masses(s.model, *s.system.mass);
  double      disc   = 0.;
  for (std::size_t i = 0; i < masses.size(); ++i)
    {
      disc += s.model.nodes()[i].component == 0 ? masses[i] : 0.;
      EXPECT_GE(masses[i], 0.);
    }
  disc = dealii::Utilities::MPI::sum(disc, MPI_COMM_WORLD);
  EXPECT_NEAR(disc / (MaterialParameters().disc.density * volume(s.mesh, 0)), 1., 1e-13);
}

TEST(DiscLabels, AnalyticFields)
{
  // Displacement along one direction, cos(π m s) over the radius (m sign changes), n waves around, pattern turned by an angle
  const Scene              s      = disc_scene();
  const auto               masses = nodal_masses(s.model, *s.system.mass);
  std::vector<MultiVector> fields;
  std::vector<std::string> expected;
  for (const ModeFamily family : {A, R, C})
    for (int m = 0; m <= 2; ++m)
      for (int n = 0; n <= 9; ++n)
        {
          fields.push_back(along(s, family, [=](const double r, const double theta) {
            return std::cos(M_PI * m * (r - 0.15) / 0.16) * std::cos(n * theta + 0.4 * n);
          }));
          expected.push_back(to_string(family) + std::to_string(m) + "-" + std::to_string(n));
        }
  EXPECT_EQ(texts(disc_labels(s.model, masses, join_all(fields))), expected);
}

TEST(DiscLabels, TheLargerPartDecides)
{
  // In-plane modes have radial and circumferential parts of the same harmonic.
  const Scene s      = disc_scene();
  const auto  masses = nodal_masses(s.model, *s.system.mass);
  const auto  mixed  = [&](const double radial, const double around) {
    MultiVector u = along(s, R, [radial](double, const double theta) { return radial * std::cos(3. * theta); });
    u += along(s, C, [around](double, const double theta) { return around * std::sin(3. * theta); });
    u += along(s, A, [](double, const double theta) { return 0.1 * std::cos(5. * theta); });
    return u;
  };
  EXPECT_EQ(texts(disc_labels(s.model, masses, join_all({mixed(1., 0.9), mixed(0.9, 1.)}))), (std::vector<std::string>{"R0-3", "C0-3"}));
}

TEST(WaveShares, AnalyticFields)
{
  // f cos(nθ - ωt) + g cos(nθ + ωt) = Re(φ e^{iωt}), φ = (f + g) cos nθ + i (g - f) sin nθ: f travels along +e_θ
  const Scene              s      = disc_scene();
  const auto               masses = nodal_masses(s.model, *s.system.mass);
  std::vector<MultiVector> re, im;
  std::vector<ModeLabel>   labels;
  std::vector<double>      expected;
  for (const ModeFamily family : {A, R, C})
    for (int n = 1; n <= 9; ++n)
      for (const auto &[f, g] : {std::make_pair(1., 0.), std::make_pair(0., 1.), std::make_pair(0.8, 0.8), std::make_pair(-0.3, 0.4)})
        {
          const auto field = [&, f = f, g = g](const bool imaginary) {
            MultiVector u = along(s, family, [&](const double r, const double theta) {
              const double value = imaginary ? (g - f) * std::sin(n * theta) : (f + g) * std::cos(n * theta);
              return (1. + 5. * r) * value + 0.3 * std::cos((n + 1) * theta); // another harmonic does not count
            });
            u += along(s, family == A ? R : A, [](double, double) { return 0.2; }); // nor does another direction
            return u;
          };
          re.push_back(field(false));
          im.push_back(field(true));
          labels.push_back({family, 0, n});
          expected.push_back(f * f / (f * f + g * g));
        }
  const auto shares = wave_shares(s.model, masses, labels, join_all(re), join_all(im));
  ASSERT_EQ(shares.size(), expected.size());
  for (std::size_t j = 0; j < shares.size(); ++j)
    {
      ASSERT_TRUE(shares[j]) << to_string(labels[j]);
      EXPECT_NEAR(shares[j]->positive, expected[j], 1e-10) << to_string(labels[j]);
      EXPECT_NEAR(shares[j]->negative, 1. - expected[j], 1e-10) << to_string(labels[j]);
    }

  // A common phase changes nothing
  const MultiVector turned_re = 0.6 * join_all(re) - 0.8 * join_all(im), turned_im = 0.8 * join_all(re) + 0.6 * join_all(im);
  const auto        turned = wave_shares(s.model, masses, labels, turned_re, turned_im);
  for (std::size_t j = 0; j < shares.size(); ++j)
    EXPECT_NEAR(turned[j]->positive, expected[j], 1e-10);
}

TEST(WaveShares, OfDiscModesWithNodalDiametersOnly)
{
  const Scene       s     = disc_scene();
  const MultiVector field = displacements(s.model, 0, [](const Point3 &p) { return Point3{{0., 0., p[0]}}; });
  const auto        of    = [&](const ModeLabel &label) {
    return wave_shares(s.model, nodal_masses(s.model, *s.system.mass), {label}, field, MultiVector(field.map(), 1))[0];
  };
  ASSERT_TRUE(of({A, 0, 1}));
  EXPECT_NEAR(of({A, 0, 1})->positive, 0.5, 1e-12);
  for (const ModeLabel &label : {ModeLabel{A, 0, 0}, pin_mode(F, 1), ModeLabel(), ModeLabel{ModeFamily::rigid_body}, ModeLabel{R, 0, 1}})
    EXPECT_FALSE(of(label)) << to_string(label); // the last one has no radial motion
}

TEST(PinLabels, AnalyticFields)
{
  // Round pin, its axis at (0.2, 0); fields vanish at the clamp
  const Scene              s      = pin_scene();
  const auto               masses = nodal_masses(s.model, *s.system.mass);
  const GeometryParameters geometry;
  const auto               depth   = [&](const Point3 &p) { return geometry.disc_thickness / 2. + geometry.pin_height - p[2]; };
  const auto               bending = [&](const double x, const double y) {
    return displacements(s.model, 1, [=](const Point3 &p) {
      return Point3{{x * depth(p) * depth(p), y * depth(p) * depth(p), -2. * depth(p) * (x * (p[0] - 0.2) + y * p[1])}};
    });
  };
  const auto torsion = [&](const double factor) {
    return displacements(s.model, 1, [=](const Point3 &p) {
      return Point3{{-factor * p[1] * depth(p), factor * (p[0] - 0.2) * depth(p), 0.}};
    });
  };
  const auto stretching = [&](const double contraction) {
    return displacements(s.model, 1, [=](const Point3 &p) { return Point3{{-contraction * (p[0] - 0.2), -contraction * p[1], depth(p)}}; });
  };
  // Two flexural modes share a number.
  EXPECT_EQ(texts(pin_labels(
              s.model, s.interface, masses,
              join_all({bending(1., 0.), bending(-0.3, 1.), torsion(1.), bending(1., 1.), stretching(0.3), torsion(-2.), stretching(0.)}))),
            (std::vector<std::string>{"F1", "F1", "T1", "F2", "L1", "T2", "L2"}));
}

TEST(PinLabels, APinThatHardlyTouchesBendsAboutItsOwnAxis)
{
  const Scene            s = pin_scene();
  const ContactInterface closed(s.interface.begin(), s.interface.begin() + 1);
  const double           limit = 2. * M_PI * 9000.;
  const auto modes = component_modes(s.model, s.interface, closed, s.system, Component::pins, ContactBoundary::sliding, limit * limit, {});
  ASSERT_GE(modes.labels.size(), 3u);
  EXPECT_EQ(texts({modes.labels.begin(), modes.labels.begin() + 3}), (std::vector<std::string>{"F1", "F1", "T1"}));
}

TEST(PinLabels, ModesOfRoundPinsInOrder)
{
  // Slender beams have flexural modes first; the numbers of every family ascend with frequency and count all pins.
  const Scene         s = pin_scene();
  std::vector<double> torsion;
  for (const ContactBoundary boundary : {ContactBoundary::free, ContactBoundary::sliding})
    {
      const double limit = 2. * M_PI * 9000.;
      const auto   modes = component_modes(s.model, s.interface, s.interface, s.system, Component::pins, boundary, limit * limit, {});
      ASSERT_GE(modes.labels.size(), 3u);
      EXPECT_EQ(texts({modes.labels.begin(), modes.labels.begin() + 2}), (std::vector<std::string>{"F1", "F1"}));
      EXPECT_NEAR(modes.eigenvalues[0] / modes.eigenvalues[1], 1., 1e-9); // the O-grid has a threefold axis
      ASSERT_EQ(std::count(modes.labels.begin(), modes.labels.end(), pin_mode(T, 1)), 1);
      torsion.push_back(modes.eigenvalues[std::find(modes.labels.begin(), modes.labels.end(), pin_mode(T, 1)) - modes.labels.begin()]);
      // Held at both ends a bar stretches at half a wave: twice the frequency, c / (2 L) = 12 kHz.
      const auto longitudinal = std::count(modes.labels.begin(), modes.labels.end(), pin_mode(L, 1));
      EXPECT_EQ(longitudinal, boundary == ContactBoundary::free ? 1 : 0);

      // Orthonormal in M, at rest on the disc, on the rigid face if sliding
      EXPECT_LT(orthonormality_defect(*s.system.mass, *modes.vectors), 1e-12);
      const DenseMatrix u       = replicate(*modes.vectors);
      double            at_rest = 0.;
      for (const Node &node : s.model.nodes())
        for (const int dof : node.dofs)
          for (int j = 0; j < u.cols() && node.component == 0; ++j)
            at_rest = std::max(at_rest, std::abs(u(dof, j)));
      EXPECT_EQ(at_rest, 0.);
      const double normal_motion = max_norm(replicate(*s.contact.normal * *modes.vectors)) / max_norm(u);
      EXPECT_EQ(normal_motion < 1e-14, boundary == ContactBoundary::sliding) << normal_motion;
    }
  // Torsion has no motion along the axis, so that the contact does not see it (but for the warping of a polygon).
  EXPECT_NEAR(torsion.at(0) / torsion.at(1), 1., 2e-3);
}

TEST(ModeLabels, OnePrinter)
{
  const ModeLabel disc = {A, 0, 4, 0, DoubletSign::minus}, pin = {T, 0, 0, 1, DoubletSign::plus};
  EXPECT_EQ(to_string(disc), "A0-4 -");
  EXPECT_EQ(file_text(disc), "A0-4_minus");
  EXPECT_EQ(shape_text(disc), "A0-4");
  EXPECT_EQ(to_string(pin), "T1 +");
  EXPECT_EQ(file_text(pin), "T1_plus");
  EXPECT_EQ(to_string(ModeLabel()), "unnamed");
  EXPECT_EQ(to_string(ModeLabel{ModeFamily::rigid_body}), "RB");
  EXPECT_FALSE(disc.is_of_pins());
  EXPECT_TRUE(pin.is_of_pins());
}

TEST(MarkDoublets, PairsOnly)
{
  std::vector<ModeLabel> labels = {{A, 0, 2}, pin_mode(F, 1), {A, 0, 2}, {A, 0, 0}, pin_mode(F, 1), pin_mode(F, 1)};
  mark_doublets(labels);
  EXPECT_EQ(texts(labels), (std::vector<std::string>{"A0-2 -", "F1", "A0-2 +", "A0-0", "F1", "F1"}));

  // With rates, the one that grows more is plus
  labels = {{A, 0, 4}, {A, 0, 4}, {A, 0, 5}, {A, 0, 5}, {R, 0, 1}, {R, 0, 1}, pin_mode(T, 1), pin_mode(T, 1)};
  mark_doublets(labels, {100., 0., 0., 50., 0., 0., 3., 2.});
  EXPECT_EQ(texts(labels), (std::vector<std::string>{"A0-4 +", "A0-4 -", "A0-5 -", "A0-5 +", "R0-1 -", "R0-1 +", "T1 +", "T1 -"}));
}

namespace
{
  /// Component modes of the disc up to some kHz and of the pins, for identification.
  struct References
  {
    Scene          s = disc_scene();
    ComponentModes disc, pins;

    References()
    {
      const double limit = 2. * M_PI * 4000.;
      disc = component_modes(s.model, s.interface, s.interface, s.system, Component::disc, ContactBoundary::free, limit * limit, {});
      pins =
        component_modes(s.model, s.interface, s.interface, s.system, Component::pins, ContactBoundary::sliding, 9. * limit * limit, {});
    }

    /// Numbers of the first of two disc modes with one label and of a mode with another.
    std::pair<int, int> doublet_and_other() const
    {
      const auto &labels = disc.labels;
      const auto  pair   = std::adjacent_find(labels.begin(), labels.end());
      if (pair == labels.end())
        throw std::runtime_error("no doublet among the modes of the disc");
      const auto other = std::find_if(labels.begin(), labels.end(), [&](const ModeLabel &label) { return !(label == *pair); });
      if (other == labels.end())
        throw std::runtime_error("only one label among the modes of the disc");
      return {static_cast<int>(pair - labels.begin()), static_cast<int>(other - labels.begin())};
    }

    std::vector<ModeLabel> identities(const MultiVector &re, const MultiVector *im = nullptr) const
    {
      return identify({&disc, &pins}, shape_shares({&disc, &pins}, *s.system.mass, re, im));
    }
  };

  class Identify : public ::testing::Test
  {
  protected:
    static void SetUpTestSuite()
    {
      references = std::make_unique<References>();
    }
    /// Nothing distributed may outlive MPI.
    static void TearDownTestSuite()
    {
      references.reset();
    }

    static inline std::unique_ptr<References> references;
    const References                         &r = *references;
  };
} // namespace

TEST_F(Identify, ComponentModesAreThemselves)
{
  ASSERT_GE(r.disc.labels.size(), 5u);
  ASSERT_GE(r.pins.labels.size(), 2u);
  std::vector<ModeLabel> labels = r.disc.labels;
  labels.insert(labels.end(), r.pins.labels.begin(), r.pins.labels.end());
  const auto found = r.identities(join({r.disc.vectors.get(), r.pins.vectors.get()}));
  ASSERT_EQ(found.size(), labels.size());
  for (std::size_t j = 0; j < labels.size(); ++j)
    {
      EXPECT_EQ(found[j], labels[j]);
      EXPECT_NEAR(found[j].participation, 1., 1e-10);
    }
}

TEST_F(Identify, SharesOfMixturesAndPhases)
{
  const auto &labels        = r.disc.labels;
  const auto [pair, single] = r.doublet_and_other();
  const MultiVector a = view(*r.disc.vectors, pair, 1), b = view(*r.disc.vectors, pair + 1, 1), c = view(*r.disc.vectors, single, 1);

  // A turned doublet is wholly of its label, also with a complex factor; 3:4 gives shares 0.36 and 0.64 of any size.
  MultiVector re(a.map(), 2), im(a.map(), 2);
  re.col(0)        = 0.6 * a.col(0) - 0.8 * b.col(0);
  im.col(0)        = 2. * a.col(0) + b.col(0);
  re.col(1)        = 3. * a.col(0) + 0. * c.col(0);
  im.col(1)        = 0. * a.col(0) + 4. * c.col(0);
  const auto found = r.identities(re, &im);
  EXPECT_EQ(found[0], labels[pair]);
  EXPECT_NEAR(found[0].participation, 1., 1e-10);
  EXPECT_EQ(found[1], labels[single]);
  EXPECT_NEAR(found[1].participation, 0.64, 1e-10);
}

TEST_F(Identify, CoordinatesInABasisGiveTheSameShares)
{
  const std::vector<const ComponentModes *> references = {&r.disc, &r.pins};
  const MultiVector                         X = join({r.disc.vectors.get(), r.pins.vectors.get()}), random = random_vectors(X.map(), 3);
  const MultiVector                         basis = join({&X, &random}); // neither orthonormal nor in the span of the references
  DenseMatrix                               Y(basis.n_columns(), 8);
  for (Eigen::Index i = 0; i < Y.size(); ++i)
    Y.data()[i] = std::sin(1. + 0.7 * i);
  const MultiVector re = basis * DenseMatrix(Y.leftCols(4)), im = basis * DenseMatrix(Y.rightCols(4));
  const auto        expected = shape_shares(references, *r.s.system.mass, re, &im);
  const auto        found =
    shape_shares(references, products_with(references, *r.s.system.mass, basis), weighted_gram(basis, *r.s.system.mass), Y);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t j = 0; j < expected.size(); ++j)
    for (const auto &[shape, share] : expected[j])
      EXPECT_NEAR(found[j].at(shape), share, 1e-12);
}

TEST_F(Identify, ModesUnlikeAllAreUnnamed)
{
  // Noise has next to nothing of the lowest modes; two such modes are no doublet.
  auto found = r.identities(random_vectors(r.s.model.free_map(), 2));
  for (const ModeLabel &label : found)
    EXPECT_LT(label.participation, 0.1);
  EXPECT_EQ(found, std::vector<ModeLabel>(2));
  mark_doublets(found);
  EXPECT_EQ(texts(found), std::vector<std::string>(2, "unnamed"));
}

TEST_F(Identify, ALabelIsGivenNoMoreOftenThanItsModesAre)
{
  // Three vectors that all resemble a doublet most: the third gets its second label.
  const auto &labels        = r.disc.labels;
  const auto [pair, single] = r.doublet_and_other();
  MultiVector re(r.disc.vectors->map(), 3);
  for (int j = 0; j < 3; ++j)
    {
      re.col(j) = r.disc.vectors->col(pair) + 0.2 * j * r.disc.vectors->col(pair + 1);
      re.col(j) += (0.1 + 0.3 * (j == 1)) * r.disc.vectors->col(single);
    }
  const auto found = r.identities(re);
  EXPECT_EQ(found[0], labels[pair]);
  EXPECT_EQ(found[1], labels[single]);
  EXPECT_EQ(found[2], labels[pair]);
}

TEST(RigidBody, AFreeDiscHasSixMotionsAloneAndThreeCoupled)
{
  const Scene           s     = disc_scene(mounted({}));
  const double          omega = 2. * M_PI * 3000.;
  const double          shift = stabilizing_shift(s.model, s.coupled, omega);
  SymmetricModesOptions options;
  EXPECT_GT(shift, 0.);
  EXPECT_LT(shift, omega);
  options.shift = shift * shift;
  const auto disc =
    component_modes(s.model, s.interface, s.interface, s.system, Component::disc, ContactBoundary::free, omega * omega, options);
  EXPECT_EQ(std::count(disc.labels.begin(), disc.labels.end(), ModeLabel{ModeFamily::rigid_body}), 6);
  for (int j = 0; j < 6; ++j)
    EXPECT_EQ(disc.eigenvalues[j], 0.);
  EXPECT_GT(disc.eigenvalues.at(6), 0.);

  // Its sliding modes: the faces keep the height, so only the motions in the plane are left.
  const auto sliding =
    component_modes(s.model, s.interface, s.interface, s.system, Component::disc, ContactBoundary::sliding, omega * omega, options);
  EXPECT_EQ(std::count(sliding.labels.begin(), sliding.labels.end(), ModeLabel{ModeFamily::rigid_body}), 3);

  const auto coupled = symmetric_modes(*s.coupled.stiffness, *s.coupled.mass, omega * omega, options);
  EXPECT_EQ(coupled.n_rigid_body, 3);

  // Motions: x, y and about z meet no resistance, the others that of the pins.
  const MultiVector X = rigid_disc_motions(s.model, s.coupled), KX = *s.coupled.stiffness * X;
  const auto        size = column_norms(X), force = column_norms(KX);
  const double      K = max_norm(*s.coupled.stiffness);
  for (const int j : {0, 1, 5})
    EXPECT_LT(force[j], 1e-13 * K * size[j]) << j;
  for (const int j : {2, 3, 4})
    EXPECT_GT(force[j], 1e-9 * K * size[j]) << j;
}

TEST(RigidBody, AMountedDiscNeedsNoShift)
{
  EXPECT_EQ(stabilizing_shift(disc_scene().model, disc_scene().coupled, 2. * M_PI * 3000.), 0.);
  // Held against turning only
  const Scene turning = disc_scene(mounted({{"disc_bore", 0., 7.8e10, 0.}}));
  EXPECT_EQ(stabilizing_shift(turning.model, turning.coupled, 2. * M_PI * 3000.), 0.);
  // Only axially: free to slide in its plane
  const Scene axial = disc_scene(mounted({{"disc_bore", 0., 0., 1.88e10}}));
  EXPECT_GT(stabilizing_shift(axial.model, axial.coupled, 2. * M_PI * 3000.), 0.);
}
