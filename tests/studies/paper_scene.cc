#include <squeal/studies/paper_scene.h>

#include <gtest/gtest.h>

using namespace Squeal;

TEST(PaperScene, IsThatOfTheDefaultsOnAnyMesh)
{
  EXPECT_TRUE(is_paper_scene(Parameters()));
  Parameters coarse;
  coarse.geometry.element_size       = 0.04;
  coarse.geometry.nodes_per_pin_face = 7;
  coarse.discretization.element      = Element::quadratic;
  coarse.operation                   = {0.1, Rotation::negative, 3., 200., RadialDissipation::consistent, 0.01};
  coarse.sliding.state               = ContactState::steady_sliding;
  EXPECT_TRUE(is_paper_scene(coarse));
}

TEST(PaperScene, IsNoneOfAnyOtherBody)
{
  const auto expect_other = [](const char *what, const auto &change) {
    Parameters parameters;
    change(parameters);
    EXPECT_FALSE(is_paper_scene(parameters)) << what;
  };
  expect_other("file", [](Parameters &p) { p.geometry.file = "disc_pad.geo"; });
  expect_other("thickness", [](Parameters &p) { p.geometry.disc_thickness = 0.04; });
  expect_other("layout", [](Parameters &p) { p.geometry.bottom.angles[0] = -13.4; });
  expect_other("fewer pins", [](Parameters &p) { p.geometry.top.radii.pop_back(); });
  expect_other("density", [](Parameters &p) { p.materials.pin.density = 3000.; });
  expect_other("damping", [](Parameters &p) { p.materials.disc.rayleigh_beta = 1e-9; });
  expect_other("mount", [](Parameters &p) { p.materials.mounts[0].radial = 1.; });
  expect_other("no mount", [](Parameters &p) { p.materials.mounts.clear(); });
  expect_other("gap", [](Parameters &p) {
    p.sliding.state = ContactState::steady_sliding;
    p.sliding.gaps  = {{"pin_top_1", 1e-5}};
  });
}

TEST(PaperScene, HasItsComplexModesAtOneOperation)
{
  Parameters parameters;
  parameters.operation.radial_dissipation = RadialDissipation::published;
  parameters.operation.rotation           = Rotation::negative;
  EXPECT_TRUE(is_paper_operation(parameters));
  const auto expect_other = [](const auto &change) {
    Parameters other;
    change(other);
    EXPECT_FALSE(is_paper_operation(other));
  };
  expect_other([](Parameters &p) { p.operation.friction_coefficient = 0.3; });
  expect_other([](Parameters &p) { p.operation.load_per_side = 500.; });
  expect_other([](Parameters &p) { p.operation.friction_slope = 0.01; });
  expect_other([](Parameters &p) { p.operation.rotating_disc = true; });
  expect_other([](Parameters &p) {
    p.sliding.state   = ContactState::steady_sliding;
    p.sliding.control = BackplateControl::displacement;
  });
  expect_other([](Parameters &p) { p.damping.modal_ratios = {{100., 0.01}}; });
}

TEST(PaperScene, DifferencesAreNamed)
{
  Parameters parameters;
  parameters.geometry.disc_thickness  = 0.04;
  parameters.geometry.element_size    = 0.04;
  parameters.operation.rotation_speed = 5.;
  EXPECT_EQ(differences_from_paper_scene(parameters), std::vector<std::string>{"Geometry/Disc thickness"});
  EXPECT_EQ(differences_from_paper_operation(parameters), std::vector<std::string>{"Operation/Rotation speed"});
}
