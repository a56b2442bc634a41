// SPDX-License-Identifier: GPL-3.0-or-later

#include "faces.h"

#include <squeal/bases/rigid_body.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/sliding/floating_disc.h>
#include <squeal/sliding/steady_sliding.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr double band = 2. * M_PI * 5000.;

  /// Two opposite pins on each side of a disc, mirror images about y = 0.
  Mesh four_pins()
  {
    return extrude(polar_plan(0.15, 0.3, 3, 12,
                              {{Plan::Side::top, 1, 2, 1, 1},
                               {Plan::Side::top, -3, 2, 1, 1},
                               {Plan::Side::bottom, 1, 2, 1, 1},
                               {Plan::Side::bottom, -3, 2, 1, 1}}),
                   layers(1, 2));
  }

  SlidingParameters steady(const BackplateControl control = BackplateControl::load_per_side, const double displacement = 0.)
  {
    SlidingParameters sliding;
    sliding.state        = ContactState::steady_sliding;
    sliding.control      = control;
    sliding.displacement = displacement;
    return sliding;
  }

  struct SlidingScene : Scene
  {
    explicit SlidingScene(const Mesh               &mesh      = four_pins(),
                          const MaterialParameters &materials = mounted(held),
                          const Element             element   = Element::trilinear,
                          const Rotation            rotation  = Rotation::positive)
      : Scene(mesh, materials, operating(RadialDissipation::none, rotation), element)
      , pin_names(model.component_names().begin() + 1, model.component_names().end())
      , sliding(model, interface, contact, system, band, FactorizationLibrary::automatic)
    {}

    SlidingState solve(const SlidingParameters &parameters = steady()) const
    {
      return steady_sliding(sliding, operation, parameters);
    }

    std::vector<PinContact> pins(const SlidingState &state) const
    {
      return pin_contacts(model, interface, state, operation);
    }

    std::vector<std::string> pin_names;
    SlidingModel             sliding;
  };

  int n_open(const SlidingState &state)
  {
    return std::count(state.closed.begin(), state.closed.end(), false);
  }

  void check(const SlidingScene &s, const SlidingState &state)
  {
    EXPECT_LT(state.checks.residual, 1e-10);
    EXPECT_LT(state.checks.load, 1e-10);
    EXPECT_LE(state.checks.tension, 0.);
    EXPECT_LT(state.checks.overlap, 1e-12);
    EXPECT_LT(state.checks.complementarity, 1e-12);
    EXPECT_LT(state.checks.force_balance, 1e-9);
    EXPECT_LT(state.checks.moment_balance, 1e-9);
    for (std::size_t c = 0; c < s.interface.size(); ++c)
      {
        EXPECT_LE(state.reactions[c], 0.);
        EXPECT_LE(state.gaps[c], 0.);
        EXPECT_EQ(state.reactions[c] * state.gaps[c], 0.);
        EXPECT_EQ(state.closed[c], state.reactions[c] < 0. || state.gaps[c] == 0.);
      }

    // Check the equilibrium K u = P_nᵀ r + μ P_tᵀ r
    const MultiVector r    = distribute(as_column(state.reactions), s.contact.normal->rows());
    const MultiVector rest = *s.system.stiffness * *state.displacement - transpose_times(*s.contact.normal, r) -
                             s.operation.friction_coefficient * transpose_times(*s.contact.tangential, r);
    EXPECT_LT(column_norms(rest)[0], 1e-10 * s.operation.load_per_side);
  }

  double side_load(const SlidingScene &s, const SlidingState &state, const int side)
  {
    double sum = 0.;
    for (std::size_t c = 0; c < s.interface.size(); ++c)
      if (s.interface[c].normal[2] * side > 0.)
        sum -= state.reactions[c];
    return sum;
  }
} // namespace

TEST(SteadySliding, ReactionsBalanceTheLoadOfBothSides)
{
  SlidingScene s;
  for (const double mu : {0., 0.2, 0.4, 0.8})
    {
      s.operation.friction_coefficient = mu;
      const SlidingState state         = s.solve();
      check(s, state);
      EXPECT_NEAR(side_load(s, state, 1), 1000., 1e-7);
      EXPECT_NEAR(side_load(s, state, -1), 1000., 1e-7);
      EXPECT_TRUE(state.uniqueness.meets_condition);
    }
  for (const auto &[element, slope] : {std::make_pair(Element::quadratic, 0.), {Element::trilinear, 0.3}, {Element::quadratic, 0.3}})
    {
      SCOPED_TRACE(slope);
      const SlidingScene other(sloped(four_pins(), slope), mounted(held), element);
      check(other, other.solve());
    }
}

TEST(SteadySliding, CompressionOfColumnsBetweenPlates)
{
  // With zero Poisson's ratio and a stiff disc on a stiff mount, the travel of a backplate is the compression F h / (E A) of the pins.
  auto materials               = mounted({{"disc_bore", 1e18, 1e18, 1e18}});
  materials.pin.poisson_ratio  = 0.;
  materials.disc.young_modulus = 1e18;
  SlidingScene s(four_pins(), materials);
  s.operation.friction_coefficient = 0.;
  double area                      = 0.;
  for (const ContactNode &node : s.interface)
    area += node.normal[2] > 0. ? node.area : 0.;
  const double expected = 1000. * layers(1, 2).pin_height / (materials.pin.young_modulus * area);
  EXPECT_NEAR(s.solve().approach[1], expected, 1e-6 * expected);
}

TEST(SteadySliding, WithoutFrictionItIsThePunchOfLeastEnergy)
{
  // Reactions minimise ½ rᵀ F_nn r + gᵀ r over r ≤ 0; projected Gauss-Seidel finds the minimum independently
  SlidingScene s;
  s.operation.friction_coefficient = 0.;
  SlidingParameters sliding        = steady(BackplateControl::displacement, 2e-6);
  sliding.gaps                     = {{s.pin_names[0], 5e-7, 1e-4, -1e-4}, {s.pin_names[2], 1.5e-6}};
  const SlidingState state         = s.solve(sliding);
  check(s, state);
  EXPECT_GT(n_open(state), 0);

  const int         n = s.interface.size();
  const DenseMatrix F_nn =
    replicate(*s.contact.normal * s.sliding.response.solve(transpose_times(*s.contact.normal, unit_vectors(s.contact.normal->rows()))));
  // Gaps without their elastic part
  const DenseMatrix reactions = as_column(state.reactions), gap = as_column(state.gaps) - F_nn * reactions;
  // The iteration converges, because F_nn is symmetric positive definite
  DenseMatrix r = DenseMatrix::Zero(n, 1);
  for (int sweep = 0; sweep < 20000; ++sweep)
    for (int c = 0; c < n; ++c)
      r(c, 0) = std::min(0., r(c, 0) - (gap(c, 0) + F_nn.row(c).dot(r.col(0))) / F_nn(c, c));
  EXPECT_LT(max_norm(r - reactions), 1e-6 * side_load(s, state, 1));

  // The state depends continuously on friction
  s.operation.friction_coefficient = 1e-7;
  EXPECT_LT(max_norm(as_column(s.solve(sliding).reactions) - reactions), 1e-5 * side_load(s, state, 1));
}

TEST(SteadySliding, EqualPinsCarryEqualLoadsOnlyWhereTheLayoutSaysSo)
{
  // Without friction, the two pins of a side are mirror images; friction breaks this symmetry, but opposite pins remain equal.
  SlidingScene s;
  s.operation.friction_coefficient = 0.;
  const auto without               = s.pins(s.solve());
  EXPECT_NEAR(without[0].load, without[1].load, 1e-8 * without[0].load);
  s.operation.friction_coefficient = 0.4;
  const auto with                  = s.pins(s.solve());
  EXPECT_GT(std::abs(with[0].load - with[1].load), 1e-6 * with[0].load);
  EXPECT_NEAR(with[0].load, with[2].load, 1e-8 * with[0].load);
  EXPECT_NEAR(with[1].load, with[3].load, 1e-8 * with[1].load);
  // Friction shifts the pressure to the leading edge
  for (const PinContact &pin : with)
    EXPECT_LT(pin.sliding_offset, 0.);

  // The opposite rotation gives the mirror image
  const SlidingScene reversed(four_pins(), mounted(held), Element::trilinear, Rotation::negative);
  const auto         mirrored_pins = reversed.pins(reversed.solve());
  EXPECT_NEAR(mirrored_pins[1].load, with[0].load, 1e-8 * with[0].load);
  EXPECT_NEAR(mirrored_pins[0].load, with[1].load, 1e-8 * with[1].load);
}

TEST(SteadySliding, LoadsOfSinglePinsGapsAndDisplacements)
{
  const SlidingScene s;
  SlidingParameters  sliding = steady(BackplateControl::load_per_pin);
  sliding.pin_loads          = {{s.pin_names[0], 300.}, {s.pin_names[3], 50.}};
  sliding.gaps               = {{s.pin_names[1], 2e-6}}; // the travel of the actuator closes this gap
  const SlidingState by_load = s.solve(sliding);
  check(s, by_load);
  const auto   pins    = s.pins(by_load);
  const double loads[] = {300., 500., 500., 50.};
  for (int pin = 0; pin < 4; ++pin)
    EXPECT_NEAR(pins[pin].load, loads[pin], 1e-8 * loads[pin]);

  // A pin that is too short has no contact
  sliding                      = steady();
  sliding.gaps                 = {{s.pin_names[0], 1e-3}};
  const SlidingState short_pin = s.solve(sliding);
  check(s, short_pin);
  const auto others = s.pins(short_pin);
  EXPECT_EQ(others[0].n_open, others[0].n_nodes);
  EXPECT_EQ(others[0].load, 0.);
  EXPECT_NEAR(others[1].load, 1000., 1e-6);
  EXPECT_EQ(n_open(short_pin), others[0].n_nodes);

  // Prescribing the travel computed for a load reproduces the load.
  const SlidingState loaded = s.solve();
  ASSERT_NEAR(loaded.approach[1], loaded.approach[3], 1e-12 * loaded.approach[1]); // both sides have the same travel
  const SlidingState moved = s.solve(steady(BackplateControl::displacement, loaded.approach[1]));
  check(s, moved);
  EXPECT_NEAR(side_load(s, moved, 1), 1000., 1e-6);
}

TEST(SteadySliding, ScalesWithTheLoad)
{
  // Doubling load and gaps doubles the state, because the equations are homogeneous
  SlidingScene      s;
  SlidingParameters sliding = steady();
  sliding.gaps              = {{s.pin_names[1], 4e-7}};
  const auto once           = s.solve(sliding);
  s.operation.load_per_side *= 2.;
  sliding.gaps[0].gap *= 2.;
  EXPECT_LT(max_norm(as_column(s.solve(sliding).reactions) - 2. * as_column(once.reactions)), 1e-9 * 1000.);
}

TEST(SteadySliding, RandomGapsAreSolvedOrRefused)
{
  std::mt19937                           generator(1);
  std::uniform_real_distribution<double> gap(-2e-6, 2e-6), taper(-4e-5, 4e-5), mu(0., 1.5);
  int                                    n_solved = 0, n_with_open_nodes = 0;
  SlidingScene                           s;
  for (int pattern = 0; pattern < 20; ++pattern)
    {
      SCOPED_TRACE(pattern);
      SlidingParameters sliding = steady();
      for (const std::string &name : s.pin_names)
        sliding.gaps.push_back({name, gap(generator), taper(generator), taper(generator)});
      s.operation.friction_coefficient = mu(generator);
      try
        {
          const SlidingState state = s.solve(sliding);
          check(s, state);
          ++n_solved;
          n_with_open_nodes += n_open(state) > 0;
        }
      catch (const SolverError &error)
        {
          EXPECT_NE(std::string(error.what()).find("no steady sliding state"), std::string::npos);
        }
    }
  EXPECT_GT(n_solved, 10);
  EXPECT_GT(n_with_open_nodes, 5);
}

TEST(SteadySliding, ShoesOutsideAndInsideOfARing)
{
  const SlidingScene s(turned_to_rims(four_pins()));
  const auto         e     = travels(s.model, s.interface);
  const auto         force = [&](const SlidingState &state, const unsigned int pin) {
    double sum = 0.;
    for (std::size_t c = 0; c < s.interface.size(); ++c)
      if (s.interface[c].pin == pin)
        sum += state.reactions[c] * e[pin].force(s.interface[c], s.operation.friction_coefficient);
    return sum;
  };

  SlidingParameters sliding = steady();
  for (const double gap : {0., 1e-6})
    {
      // The travel increases by the gap
      sliding.gaps             = {{s.pin_names[1], gap}};
      const SlidingState state = s.solve(sliding), touching = s.solve();
      check(s, state);
      for (const unsigned int pin : {1, 2, 3, 4})
        {
          EXPECT_NEAR(force(state, pin), 1000., 1e-7);
          EXPECT_NEAR(state.approach[pin] - touching.approach[pin], pin == 2 ? gap : 0., 1e-15);
        }
    }
  const SlidingState loaded = s.solve();
  for (const PinContact &pin : s.pins(loaded))
    {
      EXPECT_EQ(pin.side, 0);
      EXPECT_NEAR(pin.sliding_speed / s.operation.rotation_speed, pin.pin < s.pin_names[2] ? 0.25 - 0.01 : 0.25 + 0.01, 0.05);
    }

  sliding                    = steady(BackplateControl::load_per_pin);
  sliding.pin_loads          = {{s.pin_names[0], 300.}};
  const SlidingState by_load = s.solve(sliding);
  check(s, by_load);
  for (const unsigned int pin : {1, 2, 3, 4})
    EXPECT_NEAR(force(by_load, pin), pin == 1 ? 300. : 1000., 1e-7);

  check(s, s.solve(steady(BackplateControl::displacement, 3e-6)));
}

TEST(SteadySliding, ADiscThatMovesFreely)
{
  // A disc without axial mount floats between equally loaded pins, and no force acts along the axis of a ring. The drive balances the moment
  // of a freely rotating disc, even if rotation changes the gaps of shoes on a polygon.
  const Mount turns = {"disc_bore", 1e10, 0., 1e10};
  for (const auto &[mesh, mount] : {std::make_pair(four_pins(), Mount{"disc_bore", 0., 7.80e10, 0.}),
                                    {four_pins(), turns},
                                    {turned_to_rims(four_pins()), turns},
                                    {turned_to_rims(four_pins()), {"disc_bore", 1e10, 1e10, 0.}}})
    {
      SlidingScene s(mesh, mounted({mount}));
      ASSERT_NE(s.sliding.response.rigid_body_modes(), nullptr);
      // A ring without axial mount can also tilt about its bore
      EXPECT_EQ(s.sliding.response.rigid_body_modes()->n_columns(), mount.axial == 0. && mount.radial > 0. ? 3 : 1);
      const SlidingChecks found = s.solve().checks;
      EXPECT_LT(found.residual, 1e-9);
      EXPECT_LT(found.load, 1e-10);
      EXPECT_LE(found.tension, 0.);
      EXPECT_LT(found.overlap, 1e-10);
      EXPECT_LT(found.complementarity, 1e-11);
      EXPECT_LT(found.force_balance, 1e-9);
      if (mount.radial == 0.)
        {
          // Without friction, the floating disc is centred between the backplates
          s.operation.friction_coefficient = 0.;
          const SlidingState state         = s.solve();
          EXPECT_NEAR(state.approach[1] / state.approach[3], 1., 1e-6);
        }
    }
}

TEST(SteadySliding, RatesOfReactionsAgreeWithDifferences)
{
  // Change disc stiffness, ring width and gap slope, with open nodes, for a disc that is held, floats or rotates freely
  struct Change
  {
    double young_modulus, bore, taper;
  };
  const auto changed = [](const Mount &mount, const Change &change) {
    MaterialParameters materials = mounted({mount});
    materials.disc.young_modulus *= 1. + change.young_modulus;
    return SlidingScene(mapped(four_pins(),
                               [&](const Point3 &p) {
                                 const double r      = std::hypot(p[0], p[1]),
                                              factor = 1. + change.bore * std::max(0., 0.2 - r) / r; // pins do not move
                                 return Point3{{factor * p[0], factor * p[1], p[2]}};
                               }),
                        materials);
  };
  const auto tapered = [](const SlidingScene &s, const double taper) {
    SlidingParameters result = steady();
    result.gaps              = {{s.pin_names[0], 0., 1e-4 * (1. + taper), -6e-5}, {s.pin_names[3], 0., -3e-5, 1e-4}};
    return result;
  };

  // Extrapolated central differences over one and two steps: truncation error ~ step⁴, rounding error ~ 1 / step
  const double step = 2e-4;
  for (const Mount &mount : {held.front(), Mount{"disc_bore", 1e9, 7.80e10, 0.}, Mount{"disc_bore", 1e10, 0., 1e10}})
    {
      const SlidingScene      here       = changed(mount, {0., 0., 0.});
      const SlidingParameters parameters = tapered(here, 0.);
      const SlidingState      state      = here.solve(parameters);
      EXPECT_GT(n_open(state), 0);
      for (const Change &change : {Change{1., 0., 0.}, Change{0., 1., 0.}, Change{0., 0., 1.}})
        {
          MultiVector     f(here.model.free_map(), 1);
          DenseMatrix     gaps     = DenseMatrix::Zero(here.interface.size(), 1);
          Eigen::VectorXd quotient = Eigen::VectorXd::Zero(here.interface.size());
          for (const auto &[distance, weight] : {std::make_pair(step, 4. / 3.), std::make_pair(2. * step, -1. / 3.)})
            for (const double sign : {1., -1.})
              {
                const double            x = sign * distance, w = weight / (2. * x);
                const SlidingScene      there = changed(mount, {x * change.young_modulus, x * change.bore, 0.});
                const SlidingParameters moved = tapered(there, x * change.taper);
                const SlidingState      found = there.solve(moved);
                EXPECT_EQ(found.closed, state.closed);
                f -= w * (*there.system.stiffness * *state.displacement);
                gaps += w * initial_gaps(there.model, there.interface, moved);
                quotient += w * as_column(found.reactions);
              }
          const DenseMatrix rates = reaction_rates(here.sliding, here.operation, parameters, state, f, gaps);
          EXPECT_GT(max_norm(quotient), 1e-3);
          // Attachment modes of a floating disc are computed with a nearly singular matrix: rates have an accuracy of 3e-8 of the 1000 N
          // load
          EXPECT_LT(max_norm(rates - quotient), 1e-7 * max_norm(quotient) + (mount.axial > 0. ? 0. : 3e-5));
        }
    }
}

TEST(SteadySliding, Refusals)
{
  const SlidingScene s, free(four_pins(), mounted({}));
  const std::string &first = s.pin_names[0], &second = s.pin_names[1];
  const auto         expect = [](const SlidingScene &scene, SlidingParameters sliding, const std::vector<PinGap> &gaps,
                         const std::vector<std::string> &parts) {
    sliding.gaps = gaps;
    expect_refusal([&] { scene.solve(sliding); }, parts);
  };
  expect(s, steady(), {{"pin_upper", 1e-6}}, {"there is no pin `pin_upper`", first});
  expect(s, steady(), {{first, 10.}}, {"is not smaller in magnitude than the height of the pin"});
  expect(s, steady(BackplateControl::displacement, 1e-6), {{first, 2e-6}, {second, 1e-6}}, {"does not close the smallest gap"});
  expect(free, steady(), {}, {"nothing holds the disc against the friction forces"});
}

TEST(ContactMotions, OfALevelDisc)
{
  // In any basis, three rigid-body motions press the disc against the pins and three are tangential
  const Scene s(four_pins(), mounted({}), operating());
  const auto  N = free_motions(s.model, s.system, 0);
  ASSERT_TRUE(N);
  ASSERT_EQ(N->n_columns(), 6);
  std::mt19937                           generator(1);
  std::uniform_real_distribution<double> uniform(-1., 1.);
  for (int turn = 0; turn < 20; ++turn)
    {
      const DenseMatrix S            = DenseMatrix::NullaryExpr(6, 6, [&](int, int) { return uniform(generator); });
      const DenseMatrix orthogonal   = symmetric_eigenpairs(S + S.transpose()).vectors;
      const auto [pressing, sliding] = contact_motions(*s.contact.normal, *N * orthogonal);
      ASSERT_TRUE(pressing && sliding);
      EXPECT_EQ(pressing->n_columns(), 3);
      EXPECT_EQ(sliding->n_columns(), 3);
      EXPECT_LT(max_norm(replicate(*s.contact.normal * *sliding)), 1e-13);
      EXPECT_LT(max_norm(gram(*sliding, *s.system.mass * *sliding) - DenseMatrix::Identity(3, 3)), 1e-12);
    }

  // The normal components of a pure rotation are rounding errors
  const auto turning = free_motions(s.model, assemble(s.model, mounted({{"disc_bore", 1e10, 0., 1e10}})), 0);
  ASSERT_TRUE(turning);
  ASSERT_EQ(turning->n_columns(), 1);
  const auto motions = contact_motions(*s.contact.normal, *turning);
  EXPECT_FALSE(motions.pressing);
  EXPECT_TRUE(motions.sliding);
}
