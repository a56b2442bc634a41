// SPDX-License-Identifier: GPL-3.0-or-later

#include "input.h"

#include <squeal/base/exceptions.h>
#include <squeal/studies/designs/design_work.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /// Error message of a design study, or `accepted`.
  std::string refusal(const std::string &variables, std::vector<std::string> settings = {})
  {
    settings.insert(settings.begin(), {"Study=geometry", "Designs/Variables=" + variables});
    return message<Error>([&] { Parameters::read("/dev/null", settings); });
  }

  void expect_refusal(const std::vector<std::string> &mentions, const std::string &variables, const std::vector<std::string> &settings = {})
  {
    expect_mentions(refusal(variables, settings), mentions);
  }

  std::string refusal_of_file(const std::string &designs)
  {
    const File file("designs.csv", designs);
    return refusal("", {"Designs/Plan=file", "Designs/File=" + file.string()});
  }

  const std::string changes_nothing = "has no effect";
} // namespace

TEST(DesignChecks, VariablesThatChangeNothingAreRefused)
{
  const std::string load = "Operation/Load per side = 500, 1000";
  expect_refusal({changes_nothing, "Operation/Load per side", "no contact damping"}, load);
  EXPECT_EQ(refusal(load, {"Operation/Radial dissipation=consistent"}), "accepted");
  // Accepted, because some designs use the load
  EXPECT_EQ(refusal(load + "; Operation/Radial dissipation = none, consistent"), "accepted");

  for (const char *variable :
       {"Real modes/Tolerance = 1e-9, 1e-8", "Complex modes/Solver = Krylov, residual iteration", "Sweep/Tolerance = 1e-6, 1e-5",
        "Linear algebra/Threads = 1, 2", "Output/Mode shapes = none, all", "Geometry/Meshing time limit = 100, 200", "Designs/Seed = 1, 2",
        "Study = sweep, stability", "Operation/Friction coefficient = 0.2, 0.3", "Search/Samples = 1, 2",
        "Reduction/POD tolerance = 1e-8, 1e-7"})
    expect_refusal({changes_nothing, std::string(variable).substr(0, std::string(variable).find(" ="))}, variable);
  for (const char *variable :
       {"Geometry/Pin height = 0.03, 0.034", "Disc material/Density = 7000, 7200", "Band/Maximum frequency = 3000, 4000",
        "Discretization/Element = trilinear, quadratic", "Sweep/Last friction coefficient = 0.3, 0.4", "Geometry/Pin layers = 3, 4",
        "Mounts/Elastic mounts[3] = 1e10, 2e10"})
    EXPECT_EQ(refusal(variable), "accepted");

  expect_refusal({changes_nothing, "Geometry/Pin layers", "Accuracy"}, "Geometry/Pin layers = 3, 4", {"Accuracy=1 %"});
  EXPECT_EQ(refusal("Geometry/Pin height = 0.03, 0.034", {"Accuracy=1 %"}), "accepted");

  // One effective parameter is sufficient if several parameters share a value
  EXPECT_EQ(refusal("Geometry/Pin height + Operation/Load per side = 0.03, 0.034"), "accepted");
}

TEST(DesignChecks, SizesOfTheBuiltInPlanChangeNothingInAMesh)
{
  const File                     mesh("solid.msh",
                                      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"disc_rim\"\n3 2 \"disc\"\n$EndPhysicalNames\n");
  const std::vector<std::string> own = {"Geometry/File=" + mesh.string()};
  expect_refusal({changes_nothing, "Geometry/Pin height"}, "Geometry/Pin height = 0.03, 0.034", own);
  expect_refusal({changes_nothing, "Geometry/Pin height"}, "Disc material/Density = 7000, 7200; Geometry/Pin height = 0.03, 0.034", own);
  EXPECT_EQ(refusal("Disc material/Density = 7000, 7200", own), "accepted");
  expect_refusal({changes_nothing, "Geometry/Pin height"}, "Geometry/Pin height = 0.03 to 0.034", {own.front(), "Study=search"});
}

TEST(DesignChecks, ColumnsThatChangeNothingAreRefusedWhereRowsBecomeEqual)
{
  const std::string names = "Geometry/Pin height,Operation/Friction coefficient\n";
  EXPECT_EQ(refusal_of_file(names + "0.03,0.3\n0.035,0.4\n0.03,0.3\n"), "accepted");
  expect_mentions(refusal_of_file(names + "0.03,0.3\n0.03,0.4\n"),
                  {"`Operation/Friction coefficient` varies, but has no effect", "line 1"});
}

TEST(DesignChecks, ValuesAreHeldAgainstTheirBoundsFirst)
{
  expect_refusal({"Pin material/Poisson ratio must lie in -1 ... 0.5, not 25", "design 2"}, "Pin material/Poisson ratio = 0,25");
  expect_refusal({"Young", "positive", "Pin material/Young modulus = 0"}, "Pin material/Young modulus = 2e9, 0");
  expect_refusal({"must be >= 0 m, not -0.01", "Geometry/Pin height = -0.01"},
                 "Disc material/Density = 1, 2; Geometry/Pin height = 0.03, -0.01");
  expect_refusal({"integer", "Geometry/Disc layers = 1.5"}, "Geometry/Disc layers = 1 to 3 in 5");
  // A value that is invalid together with a fixed parameter
  expect_refusal({"beyond the inner radius", "Geometry/Pin diameter = 0.2"}, "Geometry/Pin diameter = 0.05, 0.2");
  // Samples of ranges are also checked
  expect_refusal({"Poisson", "Pin material/Poisson ratio = 0."}, "Pin material/Poisson ratio = 0.2 to 0.8",
                 {"Designs/Plan=Latin hypercube"});
  expect_refusal({"Pin material/Poisson ratio must lie in -1 ... 0.5, not 0.8"}, "Pin material/Poisson ratio = 0.2 to 0.8",
                 {"Study=search"});
  // Invalid combinations of varied values are accepted, because other designs are valid
  EXPECT_EQ(refusal("Operation/Load per side = 0, 1000; Operation/Radial dissipation = none, consistent"), "accepted");
  // The message names the line of the file
  expect_mentions(refusal_of_file("Geometry/Pin height\n0.03\n\n-1\n"), {"line 4", "not -1"});
  expect_mentions(refusal_of_file("Pin height\n0.03\n"), {"line 1", "`Geometry/Pin height`"});
}
