// SPDX-License-Identifier: GPL-3.0-or-later

#include "input.h"
#include "printed.h"

#include <squeal/base/exceptions.h>
#include <squeal/parameters/design_plan.h>

#include <cmath>
#include <limits>
#include <map>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  Parameters read(const std::string &text, const std::vector<std::string> &overrides = {})
  {
    return Parameters::read(File("run.prm", text).string(), overrides);
  }

  std::string refusal(const std::string &text, const std::vector<std::string> &overrides = {})
  {
    return message<ParameterError>([&] { read(text, overrides); });
  }

  std::string in_section(const std::string &section, const std::string &line)
  {
    return "subsection " + section + "\n  " + line + "\nend\n";
  }

  using Refusals = std::vector<std::pair<std::string, std::vector<std::string>>>;

  /// Expects overrides to be rejected with messages that name the parameter.
  void expect_refused(const Refusals &refusals)
  {
    for (const auto &[setting, mentions] : refusals)
      {
        const std::string text = refusal("", {setting});
        expect_mentions(text, mentions);
        expect_mentions(text, {setting.substr(0, setting.find('='))});
      }
  }
} // namespace

TEST(ParameterFiles, AnEmptyFileGivesTheDefaults)
{
  EXPECT_EQ(printed(read("")), printed(Parameters()));
  EXPECT_NO_THROW(Parameters().check());
  EXPECT_THROW(Parameters::read("/nonexistent.prm", {}), FileError);
}

TEST(ParameterFiles, ValuesReachTheirMembers)
{
  const Parameters p =
    read(in_section("Operation", "set Friction coefficient = 0.25\n set Rotation = negative\n set Radial dissipation = published") +
         in_section("Mounts", "set Elastic mounts = disc_bore: 1, 2e3, 3e10; disc_rim: 0, 0, 5") +
         in_section("Geometry", "set Top pin radii = 0.2, 0.25\n set Top pin angles = -10, 12.5") +
         in_section("Disc material", "set Rayleigh alpha = 2.5") + in_section("Pin material", "set Rayleigh beta = 3e-7") +
         in_section("Complex modes", "set Solver = residual iteration"));
  EXPECT_EQ(p.materials.disc.rayleigh_alpha, 2.5);
  EXPECT_EQ(p.materials.pin.rayleigh_alpha, 0.);
  EXPECT_EQ(p.materials.pin.rayleigh_beta, 3e-7);
  EXPECT_EQ(p.operation.friction_coefficient, 0.25);
  EXPECT_EQ(p.operation.rotation, Rotation::negative);
  EXPECT_EQ(p.operation.radial_dissipation, RadialDissipation::published);
  EXPECT_EQ(p.geometry.top.radii, (std::vector<double>{0.2, 0.25}));
  EXPECT_EQ(p.geometry.top.angles, (std::vector<double>{-10., 12.5}));
  EXPECT_EQ(p.solvers.complex_solver, ComplexSolver::residual_iteration);
  ASSERT_EQ(p.materials.mounts.size(), 2u);
  EXPECT_EQ(p.materials.mounts[0].radial, 1.);
  EXPECT_EQ(p.materials.mounts[0].tangential, 2e3);
  EXPECT_EQ(p.materials.mounts[0].axial, 3e10);
  EXPECT_EQ(p.materials.mounted_surfaces(), (std::vector<std::string>{"disc_bore", "disc_rim"}));
  EXPECT_TRUE(read(in_section("Mounts", "set Elastic mounts =")).materials.mounts.empty());
  const Parameters one_side = read(in_section("Geometry", "set Top pin radii =\n set Top pin angles ="));
  EXPECT_TRUE(one_side.geometry.top.radii.empty());
  EXPECT_EQ(one_side.geometry.bottom.radii, Parameters().geometry.bottom.radii);
}

TEST(ParameterFiles, OverridesComeLast)
{
  const std::string text = in_section("Operation", "set Friction coefficient = 0.25");
  const Parameters  p =
    read(text, {"Operation/Friction coefficient=0.3", "Band/Maximum frequency = 1234", "Operation/Friction coefficient=0.35"});
  EXPECT_EQ(p.operation.friction_coefficient, 0.35);
  EXPECT_EQ(p.discretization.maximum_frequency, 1234.);

  expect_mentions(refusal("", {"Operation/Friction coefficient"}), {"the override has no `=`"});
  expect_mentions(refusal("", {"Operation/Friction coeficient=0.3"}),
                  {"unknown parameter `Operation/Friction coeficient`", "`Operation/Friction coefficient`", "--set"});
}

TEST(ParameterFiles, UnknownNamesAreAnsweredWithTheNearest)
{
  expect_mentions(refusal(in_section("Operation", "set Rotaton speed = 3")),
                  {"unknown parameter `Operation/Rotaton speed`", "nearest known name is `Operation/Rotation speed`", "line 2"});
  expect_mentions(refusal(in_section("Opertion", "set Rotation speed = 3")), {"unknown section `Opertion/`", "`Operation/`"});
  // Right name in the wrong section
  expect_mentions(refusal(in_section("Operation", "set Maximum frequency = 3000")), {"`Band/Maximum frequency`"});
}

TEST(ParameterFiles, RefusedValuesAreAnsweredWithWhatIsAccepted)
{
  const Refusals refusals = {
    {"Operation/Friction coefficient=-0.1", {"Operation/Friction coefficient must lie in 0 ... 10, not -0.1\n"}},
    {"Operation/Friction coefficient=much", {"must be a number in 0 ... 10, not `much`\n"}},
    {"Operation/Friction coefficient=", {"must be a number in 0 ... 10, but is empty\n"}},
    {"Geometry/Pin height=-1", {"Geometry/Pin height must be >= 0 m, not -1\n"}},
    {"Geometry/Pin height=30 mm", {"must be a number >= 0 m, not `30 mm`\n"}},
    {"Linear algebra/Threads=-1", {"must lie in 0 ... 1024"}},
    {"Linear algebra/BLAS threads=1.5", {"must be an integer in 1 ... 256, not 1.5\n"}},
    {"Geometry/Pin layers=0", {"must be >= 1, not 0\n"}},
    {"Geometry/Pin layers=3000000000", {"must be at most 2147483647, not 3000000000\n"}},
    {"Output/Write matrices=maybe", {"must be true or false, not `maybe`\n"}},
    {"Study=noise",
     {"Study must be one of stability, reduction, sweep, sensitivity, accuracy, ingredients, geometry, search, robustness, updating, not `noise`\n"}},
    {"Geometry/Top pin radii=0.2, x", {"Geometry/Top pin radii, value 2, must be a number >= 0 m, not `x`\n"}},
    {"Sweep/Mode shapes at=0.1, 11", {"Sweep/Mode shapes at, value 2, must lie in 0 ... 10, not 11\n"}}};
  expect_refused(refusals);
  for (const auto &[setting, mentions] : refusals)
    expect_mentions(refusal("", {setting}), {"--set \"" + setting + "\""});
  EXPECT_EQ(refusal("", {"Operation/Friction coefficient=-0.1"}).find("Operation/Friction coefficient must lie"), 0u);
  expect_mentions(refusal(in_section("Operation", "set Friction coefficient = -0.1")), {".prm, line 2"});
  expect_mentions(refusal(in_section("Mounts", "set Elastic mounts = disc_bore: 1, stiff, 3")),
                  {"line 2, parameter Mounts/Elastic mounts, surface disc_bore"});
  std::string many = "0";
  for (unsigned int i = 0; i < 1000; ++i)
    many += ", 0";
  expect_refused({{"Sweep/Count modes at=" + many, {"has 1001 values, but accepts at most 1000"}}});
}

TEST(ParameterFiles, LongValuesAreCut)
{
  const std::string message = refusal("", {"Study=" + std::string(100000, 'x')});
  EXPECT_LT(message.size(), 600u);
  expect_mentions(message, {"(100000 characters)"});
  EXPECT_LT(refusal(in_section("Mounts", "set Elastic mounts = " + std::string(100000, 'x'))).size(), 600u);
  EXPECT_LT(refusal(in_section("Operation", "set " + std::string(10000, 'x') + " = 1")).size(), 600u);
}

TEST(Declarations, SayWhatEveryKindAccepts)
{
  constexpr double    infinity = std::numeric_limits<double>::infinity();
  double              number   = 1.;
  unsigned int        integer  = 1;
  std::vector<double> numbers;
  std::string         text;
  Declarations        declarations;
  declarations.add("any number", number, "m", "");
  declarations.add("number below", number, "none", "", {-infinity, 2.5});
  declarations.add("small number", number, "none", "", {1e-14, 1e-4});
  declarations.add("any integer", integer, "none", "", {});
  declarations.add("numbers", numbers, "N or rad/s", "", {-2., 7.});
  declarations.add("anything", text, "");
  std::vector<std::string> accepted;
  for (const DeclaredParameter &parameter : declarations.parameters())
    accepted.push_back(parameter.accepted);
  EXPECT_EQ(accepted, (std::vector<std::string>{"a number in m", "a number <= 2.5", "a number in 1e-14 ... 1e-04", "an integer",
                                                "numbers in -2 ... 7, separated by commas", ""}));

  // Only text parameters with a custom format lack a description of accepted values
  Declarations             all;
  Parameters               parameters;
  std::vector<std::string> free_texts;
  parameters.declare(all);
  for (const DeclaredParameter &parameter : all.parameters())
    {
      if (parameter.accepted.empty())
        free_texts.push_back(parameter.path);
    }
  EXPECT_EQ(free_texts, (std::vector<std::string>{"System",
                                                  "System values",
                                                  "Geometry/File",
                                                  "Materials/Volumes",
                                                  "Materials/Orthotropic",
                                                  "Materials/Axes",
                                                  "Mounts/Elastic mounts",
                                                  "Mounts/Dashpots",
                                                  "Mounts/Added masses",
                                                  "Discretization/Coarser mesh",
                                                  "Contact/Pairs",
                                                  "Contact/Tied",
                                                  "Operation/Sliding direction",
                                                  "Steady sliding/Loads",
                                                  "Steady sliding/Pressed faces",
                                                  "Steady sliding/Gaps",
                                                  "Damping/Modal damping ratio",
                                                  "Reduction/Bases",
                                                  "Reduction/Component modes",
                                                  "Sweep/Parameter",
                                                  "Sweep/Second parameter",
                                                  "Accuracy study/Elements",
                                                  "Accuracy study/Outlines",
                                                  "Accuracy study/Bases",
                                                  "Designs/Variables",
                                                  "Designs/File",
                                                  "Robustness/Distributions",
                                                  "Robustness/Correlations",
                                                  "Updating/Measured modes",
                                                  "Updating/Sensors"}));
}

TEST(ParameterFiles, WhatIsPrintedReadsBackTheSame)
{
  const Parameters p = read(
    "", {"Operation/Radial dissipation=consistent", "Mounts/Elastic mounts=disc_bore: 1, 12345678.9, 3; disc_rim: 0, 7e9, 0",
         "Geometry/Bottom pin radii=0.2", "Geometry/Bottom pin angles=0.3333333333333333", "Complex modes/Tolerance=2e-10",
         "Geometry/Element size=0.0123456789", "Pin material/Rayleigh beta=1.2345678e-7",
         "Materials/Volumes=pin_top_1: 1.23456789e9, 0.3, 3000; pin_bottom_2: 2e9, 0.25, 3070",
         "Materials/Orthotropic=pad: 2e9, 2e9, 5e8, 0.2, 0.1, 0.1, 8e8, 3e8, 3.3e8, 2600, 0, 1.5e-7; disc: 2e11, 1e11, 1e11, 0.3, 0.3, "
         "0.2, 5e10, 6e10, 7e10, 7200",
         "Materials/Axes=pad: 1, 0.123456789, 0, 0, 1, -3", "Damping/Modal damping ratio=100: 0.0123456789, 2500.5: 0.02",
         "Output/Mode shapes=unstable", "Linear algebra/Factorization=MUMPS"});
  const Parameters back = read(printed(p));
  EXPECT_NE(printed(p), printed(Parameters()));
  EXPECT_EQ(printed(back), printed(p));
  EXPECT_EQ(back.geometry.element_size, 0.0123456789);
  EXPECT_EQ(back.geometry.bottom.angles, (std::vector<double>{1. / 3.}));
  EXPECT_EQ(back.solvers.complex_tolerance, 2e-10);
  EXPECT_EQ(back.materials.mounts[0].tangential, 12345678.9);
  EXPECT_EQ(back.materials.of("pin_top_1").young_modulus, 1.23456789e9);
  EXPECT_EQ(back.materials.of("pin_bottom_2").rayleigh_beta, 0.);
  EXPECT_EQ(back.materials.of("pin_bottom_1").rayleigh_beta, 1.2345678e-7);
  const Material pad = back.materials.of("pad"), disc = back.materials.of("disc");
  EXPECT_EQ(pad.orthotropy->nu23, 0.1);
  EXPECT_EQ(pad.orthotropy->G23, 3.3e8);
  EXPECT_EQ(pad.rayleigh_beta, 1.5e-7);
  EXPECT_EQ(*pad.orthotropy->axes, (std::array<double, 6>{{1., 0.123456789, 0., 0., 1., -3.}}));
  EXPECT_EQ(disc.density, 7200.);
  EXPECT_FALSE(disc.orthotropy->axes);
  EXPECT_EQ(pad.least_wave_modulus(), 3e8);
  EXPECT_NEAR(pad.mean_poisson_ratio(), 0.2 / 3., 1e-15);
  ASSERT_EQ(back.damping.modal_ratios.size(), 2u);
  EXPECT_EQ(back.damping.modal_ratios[0].ratio, 0.0123456789);
  EXPECT_EQ(back.damping.modal_ratios[1].frequency, 2500.5);
}

TEST(ParameterFiles, ZeroHasNoSign)
{
  const Parameters p = read("", {"Operation/Friction coefficient=-0", "Mounts/Elastic mounts=disc_bore: -0, 1, 1",
                                 "Geometry/Top pin radii=0.2, 0.2", "Geometry/Top pin angles=-0, 20"});
  EXPECT_FALSE(std::signbit(p.operation.friction_coefficient));
  EXPECT_FALSE(std::signbit(p.materials.mounts[0].radial));
  EXPECT_EQ(printed(p).find("-0\n"), std::string::npos);
  EXPECT_EQ(printed(p).find("-0,"), std::string::npos);
}

TEST(ParameterChecks, RefuseWithNameAndReason)
{
  const std::string damped = "Operation/Radial dissipation=consistent";
  const std::string pins = "Materials/Volumes", orthotropic = "Materials/Orthotropic", mounts = "Mounts/Elastic mounts",
                    ratios = "Damping/Modal damping ratio";
  expect_refused({{"Band/Maximum frequency=0", {"give a positive frequency"}},
                  {"Band/Maximum rate=1e6", {"for a band that ends at 31415.9", "from 0.0314", "to 3.142e+05"}},
                  {"Output/Animation frames=-1", {"-1"}},
                  {"Disc material/Young modulus=0", {"positive"}},
                  {"Pin material/Poisson ratio=0.5", {"incompressible"}},
                  {"Disc material/Poisson ratio=-1", {"above -1"}},
                  {"Disc material/Rayleigh alpha=-1", {"-1"}},
                  {pins + "=pin_top_1: 2e9, 0.25", {"is not the material of a volume"}},
                  {pins + "=pin_top_1: 2e9, 0.5, 3000", {", pin_top_1/Poisson ratio", "incompressible"}},
                  {orthotropic + "=pad: 2e9, 2e9, 5e8", {"is not the orthotropic material of a volume", "E1, E2, E3, nu12"}},
                  {orthotropic + "=pad: 2e9, 0, 5e8, 0.2, 0.1, 0.1, 8e8, 3e8, 3e8, 2600", {"E2 is 0 Pa", ", pad", "positive"}},
                  {orthotropic + "=pad: 2e9, 2e9, 5e8, 0.2, 0.1, 0.1, 8e8, 3e8, -1, 2600", {"G23 is -1 Pa"}},
                  {orthotropic + "=pad: 1e9, 4e9, 4e9, 0.5, 0, 0, 1e9, 1e9, 1e9, 2600", {"nu12^2 is 0.25, not below E1/E2", "nu21"}},
                  {orthotropic + "=pad: 1e9, 1e9, 4e9, 0, 0.6, 0, 1e9, 1e9, 1e9, 2600", {"nu13^2", "E1/E3"}},
                  {orthotropic + "=pad: 4e9, 4e9, 1e9, 0, 0, 2.1, 1e9, 1e9, 1e9, 2600", {"nu23^2", "E2/E3"}},
                  {orthotropic + "=pad: 1e9, 1e9, 1e9, 0.5, 0.5, 0.5, 1e9, 1e9, 1e9, 2600", {"incompressible", "2 nu12 nu13 nu23"}},
                  {orthotropic + "=pad: 1e9, 1e9, 1e9, 0.2, 0.2, 0.2, 1e9, 1e9, 1e9, 0", {"the density is 0"}},
                  {"Materials/Axes=pad: 1, 0, 0, 0, 1, 0", {"`pad` has axes, but no orthotropic material"}},
                  {"Contact/Pairs=disc_top", {"`disc_top` is not a pair of surfaces"}},
                  {"Contact/Pairs=top / pad: 0", {"does not give a positive friction factor"}},
                  {"Contact/Pairs=top / top", {"is paired with itself"}},
                  {"Contact/Pairs=top / pad; top / pad: 2", {"is given twice"}},
                  {"Contact/Pairs=", {"the list of contact pairs is empty"}},
                  {"Contact/Tied=back / back", {"`back / back`"}},
                  {"Contact/Tied=back / disc_contact", {"`disc_contact`", "Contact/Pairs"}},
                  {"Contact/Tied=back / front; back / side", {"`back` is the first surface of two ties"}},
                  {mounts + "=disc_bore: 1, 2", {"is not an elastic mount"}},
                  {mounts + "=disc_bore: 1, two, 3", {"surface disc_bore", "`two` is not a finite number"}},
                  {mounts + "=disc_bore: 1, -2, 3", {"not a finite value >= 0"}},
                  {mounts + "=: 1, 2, 3", {"is not an elastic mount"}},
                  {mounts + "=disc_bore: 1, 2, 3; disc_bore: 1, 2, 3", {"surface `disc_bore` is given twice"}},
                  {ratios + "=1000", {"is not a frequency with its damping ratio"}},
                  {ratios + "=1000: 1 %", {"`1 %` is not a finite number"}},
                  {ratios + "=1000: 1", {"the damping ratio 1 at 1000 Hz is not in [0, 1)"}},
                  {ratios + "=-1: 0.01", {"not a finite value >= 0"}},
                  {ratios + "=2000: 0.01, 1000: 0.02", {"2000 Hz"}}});
  const std::string lining = "pad: 2e9, 2e9, 5e8, 0.2, 0.1, 0.1, 8e8, 3e8, 3e8, 2600", given = orthotropic + "=" + lining;
  expect_mentions(refusal("", {pins + "=pad: 2e9, 0.25, 2600", given}), {"`pad` has two materials", orthotropic, pins});
  for (const auto &[axes, reason] : std::map<std::string, std::string>{{"pad: 1, 2, 0, -2, -4, 0", "parallel"},
                                                                       {"pad: 0, 0, 0, 0, 1, 0", "zero"},
                                                                       {"pad: 1, 0", "not the axes of a volume"}})
    expect_mentions(refusal("", {given, "Materials/Axes=" + axes}), {reason, "Materials/Axes"});
  EXPECT_EQ(refusal("", {given, "Materials/Axes=pad: 1, 2, 0, 0, 3, 1"}), "accepted");
  // Both parameters may be zero without dissipation
  for (const std::string name : {"Operation/Rotation speed", "Operation/Load per side"})
    {
      expect_mentions(refusal("", {damped, name + "=0"}), {"parameter " + name});
      EXPECT_EQ(refusal("", {name + "=0"}), "accepted");
    }
  EXPECT_EQ(refusal("", {ratios + "=0: 0, 1000: 0.999"}), "accepted");
  // check() also rejects values that were not read from a file
  MaterialParameters infinite, negative;
  infinite.disc.rayleigh_alpha = std::numeric_limits<double>::infinity();
  negative.pin.rayleigh_beta   = -1e-9;
  EXPECT_THROW(infinite.check(), ParameterError);
  EXPECT_THROW(negative.check(), ParameterError);
}

TEST(ModalDampingRatios, AreLinearBetweenTheEntries)
{
  using Ratios = std::vector<std::pair<double, double>>; // frequencies and expected ratios
  for (const auto &[entries, ratios] : std::vector<std::pair<std::string, Ratios>>{
         {"", {{1000., 0.}}},
         {"800: 0.01", {{0., 0.01}, {800., 0.01}, {5000., 0.01}}},
         {"500: 0.02, 1500: 0.01, 3500: 0.05",
          {{100., 0.02}, {500., 0.02}, {1000., 0.015}, {1500., 0.01}, {2500., 0.03}, {3500., 0.05}, {9000., 0.05}}}})
    for (const auto &[frequency, ratio] : ratios)
      EXPECT_DOUBLE_EQ(read("", {"Damping/Modal damping ratio=" + entries}).damping.modal_ratio(frequency), ratio) << frequency;
}

TEST(NumberLists, DecimalCommasAreRefused)
{
  expect_refused({{"Operation/Friction coefficient=0,4", {"must be a number in 0 ... 10, not `0,4`\n", "decimal", "0.4"}},
                  {"Pin material/Young modulus=1,5e9", {"decimal", "1.5"}},
                  {"Sweep/Count modes at=0,3, 0,4", {"decimal", "0.3"}},
                  {"Reduction/Snapshots=0,05, 0,25", {"decimal", "0.05"}},
                  {"Geometry/Top pin angles=-12,5, 12,5", {"decimal", "-12.5"}},
                  {"Accuracy study/Mesh factors=1, 1,5, 2,5", {"decimal", "1.5"}},
                  {"Mounts/Elastic mounts=disc_bore: 0, 7,8e10, 1,88e10", {"decimal", "7.8"}},
                  {"Steady sliding/Loads=pin_top_1: 500,5", {"decimal", "500.5"}}});
}

TEST(NumberLists, RealListsAreRead)
{
  for (const char *angles :
       {"0, 60, 120, 180, 240, 300", "0,60,120,180,240,300", "-150,-90,-30,30,90,150", "0.5,60.5,120.5,180.5,240.5,300.5",
        "0,60,120, 180,240,300", "-150,-90, -30,30, 90,150", "0 , 60 , 120 , 180 , 240 , 300"})
    EXPECT_EQ(refusal("", {std::string("Geometry/Top pin angles=") + angles}), "accepted") << angles;
  for (const auto &[name, given, value] : std::vector<std::tuple<std::string, std::string, std::string>>{
         {"Accuracy study/Mesh factors", "1,2", "1, 2"},
         {"Accuracy study/Mesh factors", "1,2,3, 4", "1, 2, 3, 4"},
         {"Reduction/Coupled frequency", "0,10000", "0, 10000"},
         {"Reduction/Component modes", "80, 120, 60; 30,36,36", "80, 120, 60; 30, 36, 36"},
         {"Mounts/Elastic mounts", "disc_bore: 0,1,2", "disc_bore: 0, 1, 2"},
         {"Sweep/Count modes at", "0.1,0.2, 0.3", "0.1, 0.2, 0.3"}})
    EXPECT_EQ(current_value(read("", {name + "=" + given}), name), value);
}

TEST(NumberLists, ListsOfPointsNameEachOnce)
{
  for (const char *list : {"Sweep/Mode shapes at", "Sweep/Complex plane at", "Sweep/Count modes at", "Reduction/Snapshots"})
    expect_refused({{list + std::string("=0,0.3,0,0.4"), {"0 is given twice"}}});
}
