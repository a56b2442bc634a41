#include "scenes.h"

#include <squeal/base/exceptions.h>
#include <squeal/contact/travel.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/sliding/steady_sliding.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr double         band = 2. * M_PI * 5000.;
  const std::vector<Mount> held = {{"disc_bore", 1e9, 7.80e10, 1.88e10}};

  /// Two pins on each side of a disc, opposite each other; mirror images about y = 0.
  HexMesh four_pins()
  {
    return extrude(polar_plan(0.15, 0.3, 3, 12,
                              {{Plan::Side::top, 1, 2, 1, 1},
                               {Plan::Side::top, -3, 2, 1, 1},
                               {Plan::Side::bottom, 1, 2, 1, 1},
                               {Plan::Side::bottom, -3, 2, 1, 1}}),
                   layers(1, 2));
  }

  struct SlidingScene : Scene
  {
    explicit SlidingScene(const HexMesh            &mesh     = four_pins(),
                          const std::vector<Mount> &mounts   = held,
                          const Element             element  = Element::trilinear,
                          const Rotation            rotation = Rotation::positive)
      : Scene(mesh, mounted(mounts), operating(RadialDissipation::none, rotation), element)
      , sliding(model, interface, contact, system, band, FactorizationLibrary::automatic)
    {}

    SlidingState solve(const SlidingParameters &parameters = steady()) const
    {
      return steady_sliding(sliding, operation, parameters);
    }

    static SlidingParameters steady()
    {
      SlidingParameters sliding;
      sliding.state = ContactState::steady_sliding;
      return sliding;
    }

    std::vector<PinContact> pins(const SlidingState &state) const
    {
      return pin_contacts(model, interface, state, operation);
    }

    SlidingModel sliding;
  };

  /// Everything that must hold of any state.
  void check(const SlidingScene &s, const SlidingState &state)
  {
    EXPECT_LT(state.certificate.residual, 1e-10);
    EXPECT_LT(state.certificate.load, 1e-10);
    EXPECT_LE(state.certificate.tension, 0.);
    EXPECT_LT(state.certificate.overlap, 1e-12);
    EXPECT_LT(state.certificate.complementarity, 1e-12);
    EXPECT_LT(state.certificate.force_balance, 1e-9);
    EXPECT_LT(state.certificate.moment_balance, 1e-9);
    for (std::size_t c = 0; c < s.interface.size(); ++c)
      {
        EXPECT_LE(state.reactions[c], 0.);
        EXPECT_LE(state.gaps[c], 0.);
        EXPECT_EQ(state.reactions[c] * state.gaps[c], 0.);
        EXPECT_EQ(state.closed[c], state.reactions[c] < 0. || state.gaps[c] == 0.);
      }

    // K u = P_nᵀ r + μ P_tᵀ r from the definitions
    MultiVector r(s.contact.normal->rows(), 1);
    for (int i = 0; i < r.n_local_rows(); ++i)
      r(i, 0) = state.reactions[r.map().number(i)];
    MultiVector rest = *s.system.stiffness * *state.displacement;
    rest.local() +=
      -transpose_times(*s.contact.normal, r).local() - s.operation.friction_coefficient * transpose_times(*s.contact.tangential, r).local();
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
  for (const double mu : {0., 0.2, 0.4, 0.8})
    {
      SlidingScene s;
      s.operation.friction_coefficient = mu;
      const SlidingState state         = s.solve();
      check(s, state);
      EXPECT_NEAR(side_load(s, state, 1), 1000., 1e-7);
      EXPECT_NEAR(side_load(s, state, -1), 1000., 1e-7);
      EXPECT_TRUE(state.uniqueness.is_certified);
    }
}

TEST(SteadySliding, CompressionOfColumnsBetweenPlates)
{
  // Poisson's ratio zero, a pin of the same cross-section on both sides of a ring sector: far from bending the travel of a
  // backplate is that of a pin in compression, F h / (E A), plus the disc's share. A stiff disc on a stiff mount leaves the pin.
  auto materials                 = mounted({{"disc_bore", 1e18, 1e18, 1e18}});
  materials.pin.poisson_ratio    = 0.;
  materials.disc.young_modulus   = 1e18;
  auto operation                 = operating();
  operation.friction_coefficient = 0.;
  const Scene        s(four_pins(), materials, operation);
  const SlidingModel sliding(s.model, s.interface, s.contact, s.system, band, FactorizationLibrary::automatic);
  const SlidingState state = steady_sliding(sliding, operation, SlidingScene::steady());
  double             area  = 0.;
  for (const ContactNode &node : s.interface)
    area += node.normal[2] > 0. ? node.area : 0.;
  const double expected = 1000. * layers(1, 2).pin_height / (materials.pin.young_modulus * area);
  EXPECT_NEAR(state.approach[1], expected, 1e-6 * expected);
}

TEST(SteadySliding, WithoutFrictionItIsThePunchOfLeastEnergy)
{
  // ½ rᵀ F_nn r − gᵀ r over Σ r = −load, r ≤ 0, by projected gradients: another algorithm altogether
  SlidingScene s;
  s.operation.friction_coefficient = 0.;
  SlidingParameters sliding        = SlidingScene::steady();
  sliding.control                  = BackplateControl::displacement;
  sliding.displacement             = 2e-6;
  sliding.gaps                     = {{s.model.component_names()[1], 5e-7, 1e-4, -1e-4}, {s.model.component_names()[3], 1.5e-6}};
  const SlidingState state         = s.solve(sliding);
  check(s, state);
  EXPECT_GT(std::count(state.closed.begin(), state.closed.end(), false), 0);

  const int         n = s.interface.size();
  const DenseMatrix F_nn =
    replicate(*s.contact.normal * s.sliding.response.solve(transpose_times(*s.contact.normal, unit_vectors(s.contact.normal->rows()))));
  std::vector<double> r(n, 0.), gap(n);
  for (int c = 0; c < n; ++c)
    {
      // What the state says of the gap, minus the elastic part
      gap[c] = state.gaps[c];
      for (int j = 0; j < n; ++j)
        gap[c] -= F_nn(c, j) * state.reactions[j];
    }
  // Gauss-Seidel with projection converges for a symmetric positive definite matrix
  for (int sweep = 0; sweep < 20000; ++sweep)
    for (int c = 0; c < n; ++c)
      {
        double g = gap[c];
        for (int j = 0; j < n; ++j)
          g += F_nn(c, j) * r[j];
        r[c] = std::min(0., r[c] - g / F_nn(c, c));
      }
  for (int c = 0; c < n; ++c)
    EXPECT_NEAR(r[c], state.reactions[c], 1e-6 * side_load(s, state, 1));

  // And friction comes in continuously
  s.operation.friction_coefficient = 1e-7;
  const SlidingState almost        = s.solve(sliding);
  for (int c = 0; c < n; ++c)
    EXPECT_NEAR(almost.reactions[c], state.reactions[c], 1e-5 * side_load(s, state, 1));
}

TEST(SteadySliding, EqualPinsCarryEqualLoadsOnlyWhereTheLayoutSaysSo)
{
  // Without friction the two pins of a side are mirror images; friction along e_theta breaks that symmetry, and the pins opposite
  // each other stay alike.
  SlidingScene s;
  s.operation.friction_coefficient = 0.;
  const auto without               = s.pins(s.solve());
  EXPECT_NEAR(without[0].load, without[1].load, 1e-8 * without[0].load);
  s.operation.friction_coefficient = 0.4;
  const auto with                  = s.pins(s.solve());
  EXPECT_GT(std::abs(with[0].load - with[1].load), 1e-6 * with[0].load);
  EXPECT_NEAR(with[0].load, with[2].load, 1e-8 * with[0].load);
  EXPECT_NEAR(with[1].load, with[3].load, 1e-8 * with[1].load);
  // Friction presses the leading edge, where disc material enters
  for (const PinContact &pin : with)
    EXPECT_LT(pin.sliding_offset, 0.);

  // The other sense of rotation is the mirror image
  const SlidingScene reversed(four_pins(), held, Element::trilinear, Rotation::negative);
  const auto         mirrored_pins = reversed.pins(reversed.solve());
  EXPECT_NEAR(mirrored_pins[1].load, with[0].load, 1e-8 * with[0].load);
  EXPECT_NEAR(mirrored_pins[0].load, with[1].load, 1e-8 * with[1].load);
}

TEST(SteadySliding, AShortPinOpens)
{
  const SlidingScene s;
  SlidingParameters  sliding = SlidingScene::steady();
  sliding.gaps               = {{s.model.component_names()[1], 1e-3}};
  const SlidingState state   = s.solve(sliding);
  check(s, state);
  const auto pins = s.pins(state);
  EXPECT_EQ(pins[0].n_open, pins[0].n_nodes);
  EXPECT_EQ(pins[0].load, 0.);
  EXPECT_NEAR(pins[1].load, 1000., 1e-6);
  EXPECT_EQ(std::count(state.closed.begin(), state.closed.end(), false), pins[0].n_nodes);
}

TEST(SteadySliding, LoadsOfSinglePinsAndDisplacements)
{
  const SlidingScene s;
  const auto        &names   = s.model.component_names();
  SlidingParameters  sliding = SlidingScene::steady();
  sliding.control            = BackplateControl::load_per_pin;
  sliding.pin_loads          = {{names[1], 300.}, {names[4], 50.}};
  sliding.gaps               = {{names[2], 2e-6}}; // an actuator follows
  const SlidingState by_load = s.solve(sliding);
  check(s, by_load);
  const auto pins = s.pins(by_load);
  for (const auto &[pin, load] : {std::make_pair(0, 300.), std::make_pair(1, 500.), std::make_pair(2, 500.), std::make_pair(3, 50.)})
    EXPECT_NEAR(pins[pin].load, load, 1e-8 * load);

  // Moved as far as the load moved it, a side carries that load.
  const SlidingState loaded = s.solve();
  SlidingParameters  guided = SlidingScene::steady();
  guided.control            = BackplateControl::displacement;
  guided.displacement       = loaded.approach[1];
  ASSERT_NEAR(loaded.approach[1], loaded.approach[3], 1e-12 * loaded.approach[1]); // both sides alike
  const SlidingState moved = s.solve(guided);
  check(s, moved);
  EXPECT_NEAR(side_load(s, moved, 1), 1000., 1e-6);
}

TEST(SteadySliding, ScalesWithTheLoad)
{
  // Load and gaps doubled: everything doubles. Without gaps, load and speed together leave c_b alone.
  SlidingScene      s;
  SlidingParameters sliding = SlidingScene::steady();
  sliding.gaps              = {{s.model.component_names()[2], 4e-7}};
  const auto once           = s.solve(sliding);
  s.operation.load_per_side *= 2.;
  sliding.gaps[0].gap *= 2.;
  const auto twice = s.solve(sliding);
  for (std::size_t c = 0; c < s.interface.size(); ++c)
    EXPECT_NEAR(twice.reactions[c], 2. * once.reactions[c], 1e-9 * 1000.);

  s.operation       = operating(RadialDissipation::consistent);
  const auto before = radial_dissipation(s.interface, s.solve().reactions, s.operation);
  s.operation.load_per_side *= 7.;
  s.operation.rotation_speed *= 7.;
  const auto after = radial_dissipation(s.interface, s.solve().reactions, s.operation);
  for (std::size_t c = 0; c < s.interface.size(); ++c)
    EXPECT_NEAR(after[c], before[c], 1e-10 * before[c]);
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
      SlidingParameters sliding = SlidingScene::steady();
      for (std::size_t pin = 1; pin < s.model.component_names().size(); ++pin)
        sliding.gaps.push_back({s.model.component_names()[pin], gap(generator), taper(generator), taper(generator)});
      s.operation.friction_coefficient = mu(generator);
      try
        {
          const SlidingState state = s.solve(sliding);
          check(s, state);
          ++n_solved;
          n_with_open_nodes += std::count(state.closed.begin(), state.closed.end(), false) > 0;
        }
      catch (const SolverError &error)
        {
          EXPECT_NE(std::string(error.what()).find("no state of steady sliding"), std::string::npos);
        }
    }
  EXPECT_GT(n_solved, 10);
  EXPECT_GT(n_with_open_nodes, 5);
}

TEST(SteadySliding, ConesAndQuadraticElements)
{
  const auto cone = [](const double slope) {
    return mapped(four_pins(), [slope](const Point3 &p) {
      return Point3{{p[0], p[1], p[2] + slope * (std::hypot(p[0], p[1]) - 0.2) + 0.3 * slope * p[1]}};
    });
  };
  for (const Element element : {Element::trilinear, Element::quadratic})
    for (const double slope : {0., 0.3})
      {
        SCOPED_TRACE(slope);
        const SlidingScene s(cone(slope), {{"disc_bore", 1e9, 7.80e10, 1.88e10}}, element);
        check(s, s.solve());
      }
}

TEST(SteadySliding, ShoesOutsideAndInsideOfARing)
{
  const SlidingScene s(turned_to_rims(four_pins()));
  const auto        &names = s.model.component_names();
  const auto         e     = travels(s.model, s.interface);
  const auto         force = [&](const SlidingState &state, const unsigned int pin) {
    double sum = 0.;
    for (std::size_t c = 0; c < s.interface.size(); ++c)
      if (s.interface[c].pin == pin)
        sum += state.reactions[c] * e[pin].force(s.interface[c], s.operation.friction_coefficient);
    return sum;
  };

  SlidingParameters sliding = SlidingScene::steady();
  for (const double gap : {0., 1e-6})
    {
      // A gap is taken up by the travel
      sliding.gaps             = {{names[2], gap}};
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
      EXPECT_NEAR(pin.sliding_speed / s.operation.rotation_speed, pin.pin < names[3] ? 0.25 - 0.01 : 0.25 + 0.01, 0.05);
    }

  sliding.gaps               = {};
  sliding.control            = BackplateControl::load_per_pin;
  sliding.pin_loads          = {{names[1], 300.}};
  const SlidingState by_load = s.solve(sliding);
  check(s, by_load);
  for (const unsigned int pin : {1, 2, 3, 4})
    EXPECT_NEAR(force(by_load, pin), pin == 1 ? 300. : 1000., 1e-7);

  sliding              = SlidingScene::steady();
  sliding.control      = BackplateControl::displacement;
  sliding.displacement = 3e-6;
  check(s, s.solve(sliding));
}

TEST(SteadySliding, AFreeRingBetweenShoes)
{
  // The drive takes the moment about the axis although turning changes gaps at the ends of shoes on a polygon; nothing holds the ring
  // along its axis, where no force acts.
  for (const Mount &mount : {Mount{"disc_bore", 1e10, 0., 1e10}, Mount{"disc_bore", 1e10, 1e10, 0.}})
    {
      const SlidingScene s(turned_to_rims(four_pins()), {mount});
      const SlidingState state = s.solve();
      EXPECT_LT(state.certificate.residual, 1e-9);
      EXPECT_LT(state.certificate.load, 1e-10);
      EXPECT_LE(state.certificate.tension, 0.);
      EXPECT_LT(state.certificate.overlap, 1e-10);
      EXPECT_LT(state.certificate.force_balance, 1e-9);
    }
}

TEST(SteadySliding, FloatingDisc)
{
  // Free along its axis, the disc floats between the pins: equal loads hold it. Turning freely, a drive takes the moment.
  for (const Mount &mount : {Mount{"disc_bore", 0., 7.80e10, 0.}, Mount{"disc_bore", 1e10, 0., 1e10}})
    {
      const SlidingScene s(four_pins(), {mount});
      ASSERT_NE(s.sliding.response.rigid_body_modes(), nullptr);
      EXPECT_EQ(s.sliding.response.rigid_body_modes()->n_columns(), 1);
      const SlidingState state = s.solve();
      EXPECT_LT(state.certificate.residual, 1e-9);
      EXPECT_LT(state.certificate.load, 1e-10);
      EXPECT_LT(state.certificate.overlap, 1e-10);
      EXPECT_LT(state.certificate.complementarity, 1e-11);
    }

  // Without friction the floating disc is as far from both backplates
  SlidingScene floating(four_pins(), {{"disc_bore", 0., 7.80e10, 0.}});
  floating.operation.friction_coefficient = 0.;
  const SlidingState state                = floating.solve();
  EXPECT_NEAR(state.approach[1] / state.approach[3], 1., 1e-6);
}

TEST(SteadySliding, RatesOfReactionsAgreeWithDifferences)
{
  // A stiffer disc, a narrower ring, a steeper gap, with open nodes: of a disc that is held, that floats, that turns freely
  struct Change
  {
    double young_modulus, bore, taper;
  };
  struct ChangedScene
  {
    ChangedScene(const Mount &mount, const Change &change)
      : s(mapped(four_pins(),
                 [&](const Point3 &p) {
                   const double r = std::hypot(p[0], p[1]), factor = 1. + change.bore * std::max(0., 0.2 - r) / r; // pins stand outside
                   return Point3{{factor * p[0], factor * p[1], p[2]}};
                 }),
          materials(mount, change),
          operating())
      , sliding(s.model, s.interface, s.contact, s.system, band, FactorizationLibrary::automatic)
      , parameters(SlidingScene::steady())
    {
      parameters.gaps = {{s.model.component_names()[1], 0., 1e-4 * (1. + change.taper), -6e-5},
                         {s.model.component_names()[4], 0., -3e-5, 1e-4}};
    }

    static MaterialParameters materials(const Mount &mount, const Change &change)
    {
      MaterialParameters result = mounted({mount});
      result.disc.young_modulus *= 1. + change.young_modulus;
      return result;
    }

    SlidingState solve() const
    {
      return steady_sliding(sliding, s.operation, parameters);
    }

    Scene             s;
    SlidingModel      sliding;
    SlidingParameters parameters;
  };

  // Central differences over one step and over two, extrapolated: what they leave falls with the fourth power of the step, and what
  // rounding adds with its inverse
  const double step = 2e-4;
  for (const Mount &mount : {held.front(), Mount{"disc_bore", 1e9, 7.80e10, 0.}, Mount{"disc_bore", 1e10, 0., 1e10}})
    {
      const ChangedScene here(mount, {0., 0., 0.});
      const SlidingState state = here.solve();
      EXPECT_GT(std::count(state.closed.begin(), state.closed.end(), false), 0);
      for (const Change &change : {Change{1., 0., 0.}, Change{0., 1., 0.}, Change{0., 0., 1.}})
        {
          MultiVector     f(here.s.model.free_map(), 1);
          DenseMatrix     gaps     = DenseMatrix::Zero(here.s.interface.size(), 1);
          Eigen::VectorXd quotient = Eigen::VectorXd::Zero(here.s.interface.size());
          for (const auto &[distance, weight] : {std::make_pair(step, 4. / 3.), std::make_pair(2. * step, -1. / 3.)})
            for (const double sign : {1., -1.})
              {
                const double       x = sign * distance, w = weight / (2. * x);
                const ChangedScene there(mount, {x * change.young_modulus, x * change.bore, x * change.taper});
                const SlidingState found = there.solve();
                EXPECT_EQ(found.closed, state.closed);
                f -= w * (*there.s.system.stiffness * *state.displacement);
                gaps += w * initial_gaps(there.s.model, there.s.interface, there.parameters);
                quotient += w * as_column(found.reactions);
              }
          const DenseMatrix rates = reaction_rates(here.sliding, here.s.operation, here.parameters, state, f, gaps);
          EXPECT_GT(max_norm(quotient), 1e-3);
          // Attachment modes of a floating disc are those of a nearly singular matrix: rates are known to 3e-8 of the load of 1000 N
          EXPECT_LT(max_norm(rates - quotient), 1e-7 * max_norm(quotient) + (mount.axial > 0. ? 0. : 3e-5));
        }
    }
}

TEST(SteadySliding, Refusals)
{
  const SlidingScene s;
  const auto         message = [&](const SlidingParameters &sliding, const SlidingScene &scene) {
    try
      {
        scene.solve(sliding);
      }
    catch (const Error &error)
      {
        return std::string(error.what());
      }
    return std::string("nothing was refused");
  };
  const auto contains = [](const std::string &text, const std::string &part) {
    return text.find(part) != std::string::npos ? ::testing::AssertionSuccess() : ::testing::AssertionFailure() << text;
  };

  SlidingParameters sliding = SlidingScene::steady();
  sliding.gaps              = {{"pin_upper", 1e-6}};
  EXPECT_TRUE(contains(message(sliding, s), "there is no pin `pin_upper`"));
  EXPECT_TRUE(contains(message(sliding, s), s.model.component_names()[1]));

  sliding.gaps = {{s.model.component_names()[1], 10.}};
  EXPECT_TRUE(contains(message(sliding, s), "is larger than the height of the pin"));

  sliding              = SlidingScene::steady();
  sliding.control      = BackplateControl::displacement;
  sliding.displacement = 1e-6;
  sliding.gaps         = {{s.model.component_names()[1], 2e-6}, {s.model.component_names()[2], 1e-6}};
  EXPECT_TRUE(contains(message(sliding, s), "closes no gap on one side"));

  const SlidingScene free(four_pins(), {});
  EXPECT_TRUE(contains(message(SlidingScene::steady(), free), "nothing holds the disc in its plane"));
}
