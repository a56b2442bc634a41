// SPDX-License-Identifier: GPL-3.0-or-later

#include "boxes.h"
#include "faces.h"

#include <squeal/linear_algebra/multivector.h>
#include <squeal/sliding/steady_sliding.h>

#include <algorithm>
#include <cmath>

using namespace Squeal;
using namespace Squeal::Testing;

// A pad guided by springs in the plane of its back. Only the pressure presses the pad against the disc; the pad may tilt.

namespace
{
  constexpr double height = 0.05, length = 0.3, width = 0.1, load = 1000.;

  struct PadCase
  {
    const char                 *name;
    Cut                         disc, pad;
    Element                     element;
    std::array<unsigned int, 3> bricks = {{5, 2, 2}}; ///< bricks of the pad
  };

  const std::vector<PadCase> pad_cases = {{"matching", Cut::hexahedra, Cut::hexahedra, Element::trilinear, {{4, 3, 2}}},
                                          {"matching, quadratic", Cut::hexahedra, Cut::hexahedra, Element::quadratic, {{4, 3, 2}}},
                                          {"mortar", Cut::hexahedra, Cut::hexahedra, Element::trilinear},
                                          {"mortar, tetrahedra", Cut::tetrahedra, Cut::tetrahedra, Element::trilinear},
                                          {"mortar, quadratic tetrahedra", Cut::tetrahedra, Cut::tetrahedra, Element::quadratic}};

  Mesh pad_on_block(const PadCase &c, const char *back)
  {
    Mesh mesh;
    add_box(mesh, {c.disc, {{4, 3, 1}}, {1., 0., -0.05}, {1. + length, width, 0.}, 0.}, "disc", {{"disc_bore", "disc_contact"}});
    add_box(mesh, {c.pad, c.bricks, {1., 0., 0.}, {1. + length, width, height}, 0.}, "pin_pad", {{"pin_contact", back}});
    return mesh;
  }

  const std::vector<Mount> guided = {{"disc_bore", 1e11, 1e11, 1e11}, {"pad_back", 1e9, 1e9, 0.}};

  /// Materials with zero Poisson's ratio, so that the pad behaves like a set of columns in compression.
  MaterialParameters materials(const std::vector<Mount> &mounts)
  {
    MaterialParameters result = mounted(mounts);
    result.disc.poisson_ratio = 0.;
    result.pin.poisson_ratio  = 0.;
    return result;
  }

  SlidingParameters pressed(const std::vector<std::string> &faces = {"pad_back"})
  {
    SlidingParameters sliding;
    sliding.state         = ContactState::steady_sliding;
    sliding.control       = BackplateControl::pressure;
    sliding.pressed_faces = faces;
    return sliding;
  }

  OperationParameters along_x(const double mu)
  {
    OperationParameters operation;
    operation.friction_coefficient = mu;
    operation.sliding_direction    = "1, 0, 0";
    operation.load_per_side        = load;
    return operation;
  }

  struct PadScene : Scene
  {
    explicit PadScene(const PadCase            &c         = pad_cases[0],
                      const double              mu        = 0.,
                      const MaterialParameters &materials = ::materials(guided),
                      const char               *back      = "pad_back",
                      const double              stiffness = 0.,
                      const MPI_Comm            processes = MPI_COMM_WORLD)
      : Scene(pad_on_block(c, back), materials, along_x(mu), c.element, processes)
      , springs(interface)
    {
      for (ContactNode &node : springs)
        node.stiffness = stiffness;
      sliding = std::make_unique<SlidingModel>(model, springs, contact, system, 1e4, FactorizationLibrary::automatic);
    }

    SlidingState solve(const SlidingParameters &parameters = pressed()) const
    {
      return steady_sliding(*sliding, operation, parameters);
    }

    ContactInterface              springs; ///< contact nodes of pairs with a stiffness
    std::unique_ptr<SlidingModel> sliding;
  };

  void check(const SlidingState &state)
  {
    EXPECT_LT(state.checks.residual, 1e-9);
    EXPECT_LE(state.checks.tension, 0.);
    EXPECT_LT(state.checks.overlap, 1e-9);
    EXPECT_LT(state.checks.complementarity, 1e-9);
    EXPECT_LT(state.checks.force_balance, 1e-9);
    EXPECT_LT(state.checks.moment_balance, 1e-9);
  }

  double sum(const std::vector<double> &reactions)
  {
    return as_column(reactions).sum();
  }
} // namespace

TEST(PressedFaces, APressedColumnHasUniformPressure)
{
  for (const PadCase &c : pad_cases)
    for (const double stiffness : {0., 1e10})
      {
        SCOPED_TRACE(c.name);
        const PadScene     s(c, 0., materials(guided), "pad_back", stiffness);
        const SlidingState state = s.solve();
        check(state);
        EXPECT_NEAR(sum(state.reactions), -load, 1e-10 * load);
        for (std::size_t node = 0; node < s.interface.size(); ++node)
          EXPECT_NEAR(state.reactions[node], -load / (length * width) * s.interface[node].area, 1e-10 * load);
        EXPECT_EQ(state.approach, (std::vector<double>{0., 0.}));
      }
}

TEST(PressedFaces, OfTiedNodesPressTheNodesThatTheyFollow)
{
  // A lining tied to a plate, as long as the plate or longer, pressed on its own back or on the plate
  for (const Cut cut : {Cut::hexahedra, Cut::tetrahedra})
    for (const double plate_length : {length, 0.4 * length})
      for (const char *pressed_face : {"lining_back", "pad_back"})
        {
          if (plate_length < length && pressed_face == std::string("pad_back"))
            continue; // a lining longer than the plate would bend
          SCOPED_TRACE(pressed_face);
          Mesh mesh;
          add_box(mesh, {cut, {{4, 3, 1}}, {1., 0., -0.05}, {1. + length, width, 0.}, 0.}, "disc", {{"disc_bore", "disc_contact"}});
          add_box(mesh, {cut, {{5, 2, 1}}, {1., 0., 0.}, {1. + length, width, 0.5 * height}, 0.}, "pin_lining",
                  {{"pin_contact", "lining_back"}});
          add_box(mesh, {cut, {{3, 3, 1}}, {1., 0., 0.5 * height}, {1. + plate_length, width, height}, 0.}, "pin_plate",
                  {{"plate_front", "pad_back"}});
          mesh.tied = {{"lining_back", "plate_front"}};
          find_bodies(mesh);
          const Scene        s(mesh, materials(guided), along_x(0.));
          const SlidingModel sliding(s.model, s.interface, s.contact, s.system, 1e4, FactorizationLibrary::automatic);
          const SlidingState state = steady_sliding(sliding, s.operation, pressed({pressed_face}));
          check(state);
          EXPECT_NEAR(sum(state.reactions), -load, 1e-10 * load);
          for (std::size_t node = 0; node < s.interface.size(); ++node)
            EXPECT_NEAR(state.reactions[node], -load / (length * width) * s.interface[node].area, 1e-10 * load);
        }
}

TEST(PressedFaces, FrictionShiftsThePressureToTheLeadingEdge)
{
  // Moment balance about the back, where the springs hold the pad: F e = μ F h
  for (const PadCase &c : pad_cases)
    for (const double mu : {0.2, 0.5})
      {
        SCOPED_TRACE(c.name);
        const PadScene     s(c, mu);
        const SlidingState state = s.solve();
        check(state);
        const PinContact pad = pin_contacts(s.model, s.interface, state, s.operation).front();
        EXPECT_NEAR(pad.load, load, 1e-10 * load);
        EXPECT_NEAR(pad.sliding_offset, -mu * height, 1e-10);
        EXPECT_NEAR(pad.radial_offset, 0., 1e-10);
        EXPECT_EQ(pad.sliding_speed, s.operation.rotation_speed);
        double leading = 0., trailing = 0.; // largest pressure in each half
        for (std::size_t node = 0; node < s.interface.size(); ++node)
          {
            double &largest = s.interface[node].position[0] < 1. + 0.5 * length ? leading : trailing;
            largest         = std::max(largest, -state.reactions[node] / s.interface[node].area);
          }
        EXPECT_GT(leading, 1.2 * trailing);
      }
}

TEST(PressedFaces, SpringsTakeTheirShareOfTheLoad)
{
  // Springs along the load remove the free motion, so that uniqueness can be proved
  std::vector<Mount> mounts = guided;
  mounts[1].axial           = 1e9;
  const PadScene     s(pad_cases[2], 0.3, materials(mounts));
  const SlidingState state = s.solve();
  check(state);
  EXPECT_TRUE(state.uniqueness.meets_condition);
  EXPECT_LT(-sum(state.reactions), 0.999 * load);
  EXPECT_GT(-sum(state.reactions), 0.5 * load);
}

TEST(PressedFaces, ScalesWithTheLoadAndIsTheSameOnAllProcesses)
{
  PadScene           s(pad_cases[3], 0.5);
  const SlidingState once = s.solve(), alone = PadScene(pad_cases[3], 0.5, materials(guided), "pad_back", 0., MPI_COMM_SELF).solve();
  EXPECT_LT(max_norm(as_column(once.reactions) - as_column(alone.reactions)), 1e-9 * load);
  s.operation.load_per_side *= 2.;
  EXPECT_LT(max_norm(as_column(s.solve().reactions) - 2. * as_column(once.reactions)), 1e-9 * load);
}

TEST(PressedFaces, RatesOfReactionsAgreeWithDifferences)
{
  const auto stiffer = [](const double change) {
    MaterialParameters result = materials(guided);
    result.pin.young_modulus *= 1. + change;
    return PadScene(pad_cases[2], 0.5, result);
  };
  constexpr double   step = 1e-3;
  const PadScene     here = stiffer(0.), less = stiffer(-step), more = stiffer(step);
  const SlidingState state = here.solve();
  const MultiVector  f    = -0.5 / step * ((*more.system.stiffness * *state.displacement) - (*less.system.stiffness * *state.displacement));
  const DenseMatrix rates = reaction_rates(*here.sliding, here.operation, pressed(), state, f, DenseMatrix::Zero(here.interface.size(), 1));
  const Eigen::VectorXd quotient = (as_column(more.solve().reactions) - as_column(less.solve().reactions)) / (2. * step);
  EXPECT_GT(max_norm(quotient), 1e-3);
  EXPECT_LT(max_norm(rates - quotient), 1e-5 * max_norm(quotient));
}

TEST(PressedFaces, ADiscThatFloatsBetweenPads)
{
  // Pins on both sides of an axially free disc, each with its own back face
  Mesh mesh = extrude(
    polar_plan(
      0.15, 0.3, 3, 12,
      {{Plan::Side::top, 1, 2, 1, 1}, {Plan::Side::bottom, 1, 2, 1, 1}, {Plan::Side::top, -3, 2, 1, 1}, {Plan::Side::bottom, -3, 2, 1, 1}}),
    layers(1, 2));
  const auto bodies = body_of_nodes(mesh);
  const auto first  = static_cast<unsigned int>(mesh.surface_names.size());
  for (unsigned int body = 1; body < mesh.body_names.size(); ++body)
    mesh.surface_names.push_back("back_of_" + mesh.body_names[body]);
  for (Mesh::Face &face : mesh.faces)
    if (mesh.surface_names[face.surface] == PhysicalNames::pin_clamp)
      face.surface = first + bodies[face.nodes[0]] - 1;
  const std::vector<std::string> backs(mesh.surface_names.begin() + first, mesh.surface_names.end());

  std::vector<Mount> mounts = {{"disc_bore", 0., 7.80e10, 0.}};
  for (const std::string &back : backs)
    mounts.push_back({back, 1e10, 1e10, 0.});
  const Scene        s(mesh, mounted(mounts), operating());
  const SlidingModel sliding(s.model, s.interface, s.contact, s.system, 1e4, FactorizationLibrary::automatic);
  const SlidingState state = steady_sliding(sliding, s.operation, pressed(backs));
  check(state);
  for (const PinContact &pin : pin_contacts(s.model, s.interface, state, s.operation))
    EXPECT_NEAR(pin.load, 1000., 1e-7);
  // Without a load on its back, the fourth pin is not held
  expect_refusal([&] { steady_sliding(sliding, s.operation, pressed({backs[0], backs[1], backs[2]})); }, {"nothing holds pin_"});
}

TEST(PressedFaces, Refusals)
{
  const PadScene s, free(pad_cases[0], 0.3, materials({guided[0]})), held(pad_cases[0], 0., materials({guided[0]}), "pin_clamp");
  const auto     expect = [](const PadScene &scene, const SlidingParameters &parameters, const std::vector<std::string> &parts) {
    expect_refusal([&] { scene.solve(parameters); }, parts);
  };
  expect(s, pressed({"pad_bck"}), {"no surface named `pad_bck`", "pad_back"});
  expect(s, pressed({"disc_bore"}), {"includes faces of the disc", "Steady sliding/Pressed faces, surface disc_bore"});
  expect(s, pressed({"pin_contact"}), {"includes faces in contact with the disc"});
  expect(held, pressed({"pin_clamp"}), {"has clamped nodes"});
  expect(free, pressed(), {"nothing holds pin_pad against the friction forces"});
  SlidingParameters moved = pressed({});
  moved.control           = BackplateControl::load_per_side;
  expect(s, moved, {"nothing holds pin_pad", "Pressed faces"});

  expect_refusal([] { pressed({}).check_steady(); }, {"no face is pressed"});
  expect_refusal([] { pressed({"a", "a"}).check_steady(); }, {"is named twice"});
  moved.pressed_faces = {"pad_back"};
  expect_refusal([&] { moved.check_steady(); }, {"pressed faces are given, but `load per side` is prescribed"});
}
