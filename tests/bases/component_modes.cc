// SPDX-License-Identifier: GPL-3.0-or-later

#include "faces.h"
#include "matrices.h"

#include <squeal/bases/component_modes.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <algorithm>
#include <memory>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr auto A = ModeFamily::axial, R = ModeFamily::radial, C = ModeFamily::circumferential;
  constexpr auto F = ModeFamily::flexural, T = ModeFamily::torsional, L = ModeFamily::longitudinal;

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

  Scene disc_scene(const std::vector<Mount> &mounts)
  {
    const std::vector<PolarPin> pins = {{Plan::Side::top, -1, 2, 2, 2}, {Plan::Side::bottom, 7, 2, 1, 2}};
    return Scene(extrude(polar_plan(0.15, 0.31, 6, 36, pins), layers(1, 3)), mounted(mounts), operating());
  }

  /// A round pin with its axis at (0.2, 0).
  Scene pin_scene()
  {
    return Scene(extrude(round_plan(0.2, 0.026, 2), layers(1, 4)), mounted({}), operating());
  }

  ComponentModes modes_below(const Scene                 &s,
                             const double                 frequency,
                             const Component              component,
                             const ContactBoundary        boundary,
                             const SymmetricModesOptions &options = {})
  {
    const double omega = 2. * M_PI * frequency;
    return component_modes(s.model, s.interface, s.interface, s.system, component, boundary, omega * omega, options);
  }

  /// A disc with its component modes up to 4 kHz, and modes of the pins up to 12 kHz.
  struct Disc
  {
    Scene               s      = disc_scene(mounted().mounts);
    std::vector<double> masses = nodal_masses(s.model, *s.system.mass);
    ComponentModes      disc   = modes_below(s, 4000., Component::disc, ContactBoundary::free);
    ComponentModes      pins   = modes_below(s, 12000., Component::pins, ContactBoundary::sliding);
  };

  class DiscModes : public ::testing::Test
  {
  protected:
    static void SetUpTestSuite()
    {
      made = std::make_unique<Disc>();
    }
    /// Frees distributed objects before MPI is finalised.
    static void TearDownTestSuite()
    {
      made.reset();
    }

    /// Displacement of the disc in the direction of a mode family, as a function of radius and angle.
    MultiVector along(const ModeFamily family, const std::function<double(double, double)> &value) const
    {
      return displacements(s.model, 0, [&](const Point3 &p) {
        const double r = std::hypot(p[0], p[1]), u = value(r, std::atan2(p[1], p[0])), x = u * p[0] / r, y = u * p[1] / r;
        return family == A ? Point3{{0., 0., u}} : family == R ? Point3{{x, y, 0.}} : Point3{{-y, x, 0.}};
      });
    }

    std::vector<ModeLabel> identities(const MultiVector &re, const MultiVector *im = nullptr) const
    {
      return identify(references, shape_shares(references, *s.system.mass, re, im));
    }

    static inline std::unique_ptr<Disc>       made;
    const Scene                              &s    = made->s;
    const ComponentModes                     &disc = made->disc, &pins = made->pins;
    const std::vector<const ComponentModes *> references = {&disc, &pins};

    // a and b: disc modes with the same label; c: a disc mode with a different label
    const int first = std::adjacent_find(disc.labels.begin(), disc.labels.end()) - disc.labels.begin();
    const int single =
      std::find_if(disc.labels.begin(), disc.labels.end(), [&](const ModeLabel &label) { return !(label == disc.labels.at(first)); }) -
      disc.labels.begin();
    const MultiVector a = view(*disc.vectors, first, 1), b = view(*disc.vectors, first + 1, 1), c = view(*disc.vectors, single, 1);
  };
} // namespace

TEST_F(DiscModes, LabelsOfAnalyticFields)
{
  // Fields in one direction with m nodal circles, cos(π m s), and n rotated nodal diameters
  std::vector<MultiVector> fields;
  std::vector<std::string> expected;
  for (const ModeFamily family : {A, R, C})
    for (int m = 0; m <= 2; ++m)
      for (const int n : {0, 1, 2, 9})
        {
          fields.push_back(along(family, [=](const double r, const double theta) {
            return std::cos(M_PI * m * (r - 0.15) / 0.16) * std::cos(n * theta + 0.4 * n);
          }));
          expected.push_back(to_string(family) + std::to_string(m) + "-" + std::to_string(n));
        }
  // The larger of the radial and circumferential components of an in-plane mode determines its label
  for (const auto &[radial, around] : {std::make_pair(1., 0.9), {0.9, 1.}})
    {
      fields.push_back(along(R, [x = radial](double, const double theta) { return x * std::cos(3. * theta); }));
      fields.back() += along(C, [x = around](double, const double theta) { return x * std::sin(3. * theta); });
      fields.back() += along(A, [](double, const double theta) { return 0.1 * std::cos(5. * theta); });
      expected.push_back(radial > around ? "R0-3" : "C0-3");
    }
  EXPECT_EQ(texts(disc_labels(s.model, made->masses, join_all(fields))), expected);
}

TEST_F(DiscModes, WaveSharesOfAnalyticFields)
{
  // f cos(nθ - ωt) + g cos(nθ + ωt) = Re(φ e^{iωt}), φ = (f + g) cos nθ + i (g - f) sin nθ: f travels along +e_θ
  std::vector<MultiVector> re, im;
  std::vector<ModeLabel>   labels;
  std::vector<double>      expected;
  for (const ModeFamily family : {A, R, C})
    for (const int n : {1, 2, 9})
      for (const auto &[f, g] : {std::make_pair(1., 0.), {0., 1.}, {0.8, 0.8}, {-0.3, 0.4}})
        {
          for (const bool imaginary : {false, true})
            {
              MultiVector u = along(family, [&, f = f, g = g](const double r, const double theta) {
                const double value = imaginary ? (g - f) * std::sin(n * theta) : (f + g) * std::cos(n * theta);
                return (1. + 5. * r) * value + 0.3 * std::cos((n + 1) * theta); // other harmonics are ignored
              });
              u += along(family == A ? R : A, [](double, double) { return 0.2; }); // other directions are ignored
              (imaginary ? im : re).push_back(u);
            }
          labels.push_back({family, 0, n});
          expected.push_back(f * f / (f * f + g * g));
        }
  // Shares do not change if φ is multiplied by a complex factor of modulus 1
  const MultiVector X = join_all(re), Y = join_all(im);
  const auto        shares = wave_shares(s.model, made->masses, labels, 0.6 * X - 0.8 * Y, 0.8 * X + 0.6 * Y);
  ASSERT_EQ(shares.size(), expected.size());
  for (std::size_t j = 0; j < shares.size(); ++j)
    {
      ASSERT_TRUE(shares[j]) << to_string(labels[j]);
      EXPECT_NEAR(shares[j]->positive, expected[j], 1e-10) << to_string(labels[j]);
      EXPECT_NEAR(shares[j]->negative, 1. - expected[j], 1e-10) << to_string(labels[j]);
    }

  // Only disc modes with nodal diameters and motion in the direction of their label have wave shares
  const MultiVector axial = along(A, [](const double r, const double theta) { return r * std::cos(theta); });
  for (const ModeLabel &label : {ModeLabel{A, 0, 0}, pin_mode(F, 1), ModeLabel(), ModeLabel{ModeFamily::rigid_body}, ModeLabel{R, 0, 1}})
    EXPECT_FALSE(wave_shares(s.model, made->masses, {label}, axial, MultiVector(axial.map(), 1))[0]) << to_string(label);
}

TEST(PinLabels, ModesOfRoundPinsInOrder)
{
  // The lowest modes of a slender pin are flexural; each family is numbered in ascending order of frequency
  const Scene         s = pin_scene();
  std::vector<double> torsion;
  for (const ContactBoundary boundary : {ContactBoundary::free, ContactBoundary::sliding})
    {
      const auto  modes  = modes_below(s, 9000., Component::pins, boundary);
      const auto &labels = modes.labels;
      ASSERT_GE(labels.size(), 3u);
      EXPECT_EQ(texts({labels.begin(), labels.begin() + 2}), (std::vector<std::string>{"F1", "F1"}));
      EXPECT_NEAR(modes.eigenvalues[0] / modes.eigenvalues[1], 1., 1e-9); // threefold symmetry of the O-grid
      ASSERT_EQ(std::count(labels.begin(), labels.end(), pin_mode(T, 1)), 1);
      torsion.push_back(modes.eigenvalues[std::find(labels.begin(), labels.end(), pin_mode(T, 1)) - labels.begin()]);
      // With both ends held, the first longitudinal mode lies at c / (2 L) = 12 kHz, above the limit
      EXPECT_EQ(std::count(labels.begin(), labels.end(), pin_mode(L, 1)), boundary == ContactBoundary::free);

      // Vectors are M-orthonormal, vanish on the disc and do not move sliding faces in the normal direction
      EXPECT_LT(orthonormality_defect(*s.system.mass, *modes.vectors), 1e-12);
      const DenseMatrix u = replicate(*modes.vectors);
      for (const Node &node : s.model.nodes())
        for (const int dof : node.dofs)
          EXPECT_TRUE(node.component != 0 || dof < 0 || u.row(dof).isZero(0.));
      const double normal_motion = max_norm(replicate(*s.contact.normal * *modes.vectors)) / max_norm(u);
      EXPECT_EQ(normal_motion < 1e-14, boundary == ContactBoundary::sliding) << normal_motion;
    }
  // Contact affects torsion only by the warping of the polygonal face
  EXPECT_NEAR(torsion.at(0) / torsion.at(1), 1., 2e-3);

  // Labels of a pin with a single closed contact node refer to the same axis
  const ContactInterface closed(s.interface.begin(), s.interface.begin() + 1);
  const double           limit = 2. * M_PI * 9000.;
  const auto             touching =
    component_modes(s.model, s.interface, closed, s.system, Component::pins, ContactBoundary::sliding, limit * limit, {});
  ASSERT_GE(touching.labels.size(), 3u);
  EXPECT_EQ(texts({touching.labels.begin(), touching.labels.begin() + 3}), (std::vector<std::string>{"F1", "F1", "T1"}));
}

TEST(MarkDoublets, PairsOnly)
{
  std::vector<ModeLabel> labels = {{A, 0, 2}, pin_mode(F, 1), {A, 0, 2}, {A, 0, 0}, pin_mode(F, 1), pin_mode(F, 1), {}, {}};
  mark_doublets(labels);
  EXPECT_EQ(texts(labels), (std::vector<std::string>{"A0-2 -", "F1", "A0-2 +", "A0-0", "F1", "F1", "unnamed", "unnamed"}));

  // With growth rates, the mode that grows faster becomes plus
  labels = {{A, 0, 4}, {A, 0, 4}, {A, 0, 5}, {A, 0, 5}, {R, 0, 1}, {R, 0, 1}, pin_mode(T, 1), pin_mode(T, 1)};
  mark_doublets(labels, {100., 0., 0., 50., 0., 0., 3., 2.});
  EXPECT_EQ(texts(labels), (std::vector<std::string>{"A0-4 +", "A0-4 -", "A0-5 -", "A0-5 +", "R0-1 -", "R0-1 +", "T1 +", "T1 -"}));
}

TEST_F(DiscModes, ComponentModesAreIdentifiedAsThemselves)
{
  ASSERT_GE(disc.labels.size(), 5u);
  ASSERT_GE(pins.labels.size(), 2u);
  std::vector<ModeLabel> labels = disc.labels;
  labels.insert(labels.end(), pins.labels.begin(), pins.labels.end());
  const auto found = identities(join({disc.vectors.get(), pins.vectors.get()}));
  EXPECT_EQ(found, labels);
  for (const ModeLabel &label : found)
    EXPECT_NEAR(label.participation, 1., 1e-10);

  // Random vectors have almost no share in the lowest modes
  const auto none = identities(random_vectors(s.model.free_map(), 2));
  EXPECT_EQ(none, std::vector<ModeLabel>(2));
  for (const ModeLabel &label : none)
    EXPECT_LT(label.participation, 0.1);
}

TEST_F(DiscModes, SharesOfMixturesAndPhases)
{
  // Any complex combination of a doublet has its label with share 1; a 3:4 mixture has shares 0.36 and 0.64 at any scale
  const MultiVector re = join_all({0.6 * a - 0.8 * b, 3. * a}), im = join_all({2. * a + 1. * b, 4. * c});
  const auto        found = identities(re, &im);
  EXPECT_EQ(found, (std::vector<ModeLabel>{disc.labels[first], disc.labels[single]}));
  EXPECT_NEAR(found[0].participation, 1., 1e-10);
  EXPECT_NEAR(found[1].participation, 0.64, 1e-10);

  // All three vectors are most similar to the doublet, but only two may have its label
  EXPECT_EQ(identities(join_all({1. * a + 0.1 * c, 1. * a + (0.2 * b + 0.4 * c), 1. * a + (0.4 * b + 0.1 * c)})),
            (std::vector<ModeLabel>{disc.labels[first], disc.labels[single], disc.labels[first]}));
}

TEST_F(DiscModes, CoordinatesInABasisGiveTheSameShares)
{
  const MultiVector random = random_vectors(s.model.free_map(), 3);
  const MultiVector basis  = join({disc.vectors.get(), pins.vectors.get(), &random}); // neither orthonormal nor in the span of the modes
  const DenseMatrix Y      = agreed_random_matrix(basis.n_columns(), 8);
  const MultiVector re = basis * DenseMatrix(Y.leftCols(4)), im = basis * DenseMatrix(Y.rightCols(4));
  const auto        expected = shape_shares(references, *s.system.mass, re, &im);
  const auto found = shape_shares(references, products_with(references, *s.system.mass, basis), weighted_gram(basis, *s.system.mass), Y);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t j = 0; j < expected.size(); ++j)
    for (const auto &[shape, share] : expected[j])
      EXPECT_NEAR(found[j].at(shape), share, 1e-12);
}

TEST(RigidBody, AFreeDiscHasSixMotionsAloneAndThreeCoupled)
{
  const Scene           s     = disc_scene({});
  const double          omega = 2. * M_PI * 3000.;
  const double          shift = stabilizing_shift(s.model, s.coupled, omega);
  SymmetricModesOptions options;
  EXPECT_GT(shift, 0.);
  EXPECT_LT(shift, omega);
  options.shift = shift * shift;
  // Sliding faces cannot move along the axis, and only in-plane motions remain
  for (const auto &[boundary, n] : {std::make_pair(ContactBoundary::free, 6), {ContactBoundary::sliding, 3}})
    {
      const auto modes = modes_below(s, 3000., Component::disc, boundary, options);
      EXPECT_EQ(std::count(modes.labels.begin(), modes.labels.end(), ModeLabel{ModeFamily::rigid_body}), n);
      EXPECT_EQ(modes.eigenvalues.at(n - 1), 0.);
      EXPECT_GT(modes.eigenvalues.at(n), 0.);
    }
  EXPECT_EQ(symmetric_modes(*s.coupled.stiffness, *s.coupled.mass, omega * omega, options).n_rigid_body, 3);

  // The pins resist only axial motion and tilting of the disc
  const MultiVector X = rigid_disc_motions(s.model, s.coupled), KX = *s.coupled.stiffness * X;
  const auto        size = column_norms(X), force = column_norms(KX);
  const double      K = max_norm(*s.coupled.stiffness);
  for (const int j : {0, 1, 5})
    EXPECT_LT(force[j], 1e-13 * K * size[j]) << j;
  for (const int j : {2, 3, 4})
    EXPECT_GT(force[j], 1e-9 * K * size[j]) << j;
}

TEST(RigidBody, ADiscThatIsHeldInItsPlaneNeedsNoShift)
{
  // A shift is required only without tangential springs
  for (const auto &[tangential, axial] : {std::make_pair(7.8e10, 1.88e10), {7.8e10, 0.}, {0., 1.88e10}})
    {
      const Scene s = disc_scene({{"disc_bore", 0., tangential, axial}});
      EXPECT_EQ(stabilizing_shift(s.model, s.coupled, 2. * M_PI * 3000.) > 0., tangential == 0.);
    }
}
