// SPDX-License-Identifier: GPL-3.0-or-later

#include "input.h"

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/design_plan.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  using Values = std::vector<std::string>;

  DesignPlan plan_of(const DesignChoice choice, const std::string &variables, const unsigned int n = 20, const unsigned int seed = 1)
  {
    Parameters parameters;
    parameters.designs.choice    = choice;
    parameters.designs.variables = variables;
    parameters.designs.n_samples = n;
    parameters.designs.seed      = seed;
    return design_plan(parameters);
  }

  /// Values of one variable in all designs.
  std::vector<double> column(const DesignPlan &plan, const std::size_t variable)
  {
    std::vector<double> result;
    for (const Values &design : plan.designs)
      result.push_back(*parse_number(design[variable]));
    return result;
  }

  /// Parameters of a study with designs from a file.
  Parameters reading(const File &file)
  {
    Parameters parameters;
    parameters.designs.choice = DesignChoice::file;
    parameters.designs.file   = file.string();
    return parameters;
  }

  ParameterError refusal_of(const Parameters &parameters)
  {
    try
      {
        design_plan(parameters);
      }
    catch (const ParameterError &error)
      {
        return error;
      }
    return {"accepted", "", ""};
  }
} // namespace

TEST(DesignPlan, GridsAndOneAtATime)
{
  using Designs = std::vector<Values>;
  EXPECT_EQ(plan_of(DesignChoice::full_grid, "A/x = 0.03 to 0.04 in 3; B/y = 0.044, 0.046").designs,
            (Designs{{"0.03", "0.044"}, {"0.03", "0.046"}, {"0.035", "0.044"}, {"0.035", "0.046"}, {"0.04", "0.044"}, {"0.04", "0.046"}}));
  EXPECT_EQ(plan_of(DesignChoice::full_grid, "A/x = 1e9 to 1e11 in 3 by ratio").designs, (Designs{{"1e+09"}, {"1e+10"}, {"1e+11"}}));
  // Values that contain commas
  const DesignPlan lists = plan_of(DesignChoice::full_grid, "Geometry/Top pin angles = -10, 0, 10 | -20, 0, 20");
  EXPECT_EQ(lists.names, Values{"Geometry/Top pin angles"});
  EXPECT_EQ(lists.designs, (Designs{{"-10, 0, 10"}, {"-20, 0, 20"}}));
  // The first design is the unchanged model
  EXPECT_EQ(plan_of(DesignChoice::one_at_a_time, "A/x = 1, 2; B/y = 3").designs, (Designs{{"", ""}, {"1", ""}, {"2", ""}, {"", "3"}}));
  for (const char *variables : {"A/x[1] = 1, 2; A/x[2] = 3, 4", "A/x = 1, 2; B/y = 1, 2"})
    EXPECT_EQ(plan_of(DesignChoice::full_grid, variables).designs.size(), 4u) << variables;
  EXPECT_EQ(plan_of(DesignChoice::full_grid, "A/x = 1,2").designs.size(), 2u);
}

TEST(DesignPlan, LatinHypercubeMeetsEveryPartOnce)
{
  constexpr int    n    = 40;
  const DesignPlan plan = plan_of(DesignChoice::latin_hypercube, "A/x = 2 to 6; B/y = 1 to 100 by ratio; C/z = red, green", n, 7);
  ASSERT_EQ(plan.designs.size(), n);
  std::set<int> parts_x, parts_y;
  for (const double x : column(plan, 0))
    parts_x.insert(static_cast<int>((x - 2.) / 4. * n));
  for (const double y : column(plan, 1))
    parts_y.insert(static_cast<int>(std::log10(y) / 2. * n));
  EXPECT_EQ(parts_x.size(), n);
  EXPECT_EQ(parts_y.size(), n);
  EXPECT_EQ(std::count_if(plan.designs.begin(), plan.designs.end(), [](const Values &design) { return design[2] == "red"; }), n / 2);

  // Equal seeds give equal designs
  EXPECT_EQ(plan_of(DesignChoice::latin_hypercube, "A/x = 2 to 6", n, 7).designs,
            plan_of(DesignChoice::latin_hypercube, "A/x = 2 to 6", n, 7).designs);
  EXPECT_NE(plan_of(DesignChoice::latin_hypercube, "A/x = 2 to 6", n, 7).designs,
            plan_of(DesignChoice::latin_hypercube, "A/x = 2 to 6", n, 8).designs);
}

TEST(DesignPlan, SobolSequenceFillsTheRanges)
{
  // The first points of the sequence in two dimensions, without the origin
  EXPECT_EQ(plan_of(DesignChoice::sobol, "A/x = 0 to 1; B/y = 0 to 1", 3, 0).designs,
            (std::vector<Values>{{"0.5", "0.5"}, {"0.75", "0.25"}, {"0.25", "0.75"}}));
  // Shifted sequences are equally uniform: every sixteenth of the range has two to six of 64 points
  for (const unsigned int seed : {1u, 2u})
    {
      const DesignPlan plan = plan_of(DesignChoice::sobol, "A/x = 0 to 1; B/y = 0 to 1", 64, seed);
      for (const std::size_t variable : {0, 1})
        {
          std::vector<int> counts(16, 0);
          for (const double x : column(plan, variable))
            {
              ASSERT_GE(x, 0.);
              ASSERT_LT(x, 1.);
              ++counts[static_cast<int>(16. * x)];
            }
          EXPECT_GE(*std::min_element(counts.begin(), counts.end()), 2);
          EXPECT_LE(*std::max_element(counts.begin(), counts.end()), 6);
        }
    }
}

TEST(DesignPlan, RefusesWhatItDoesNotUnderstandOrVariesTwiceOrIsEqual)
{
  for (const auto &[variables, reason] :
       std::vector<std::pair<std::string, std::string>>{{"", "no varied parameter is given"},
                                                        {"Geometry/Pin height", "has no `=`"},
                                                        {"Geometry/Pin height = ", "has no values"},
                                                        {"= 1, 2", "has no parameter name"},
                                                        {"Geometry/Pin height = 1 to 2", "has no levels"},
                                                        {"Geometry/Pin height = 2 to 1 in 3", "does not ascend"},
                                                        {"Geometry/Pin height = 1 to x in 3", "`x` in"},
                                                        {"Geometry/Pin height = 1 to 2 in 1", "number of levels"},
                                                        {"Geometry/Pin height = -1 to 2 in 3 by ratio", "requires positive values"},
                                                        {"Geometry/Pin height = 1; Geometry/Pin height = 2", "varies twice"},
                                                        {"A/a = 0 to 1 in 1000; A/b = 0 to 1 in 1000", "1e+06 designs"},
                                                        {"A/x = 1, 2; A/x + B/y = 3, 4", "`A/x` varies twice"},
                                                        {"A/x + A/x = 1, 2", "`A/x` varies twice"},
                                                        {"A/x = 1, 2; A/x[1] = 3, 4", "`A/x` varies twice"},
                                                        {"A/x[2] = 1, 2; A/y + A/x[ 2 ] = 3, 4", "`A/x` varies twice"},
                                                        {"A/x = 1, 1.0", "`1` and `1.0`"},
                                                        {"A/x = red, green, red", "equal values"},
                                                        {"A/x = -10, 10 | 0, 5 | -10,10.0", "equal values"},
                                                        {"A/x = 1 to 1.0000000000000002 in 5", "equal values"},
                                                        {"A/x = 0,3, 0,4", "decimal"},
                                                        {"A/x = 0,3; 0,4", "`0,4` has no `=`"},
                                                        {"A/x = 0,3 to 0,5 in 3", "`0,3` in"}})
    {
      Parameters parameters;
      parameters.designs.choice    = DesignChoice::full_grid;
      parameters.designs.variables = variables;
      const ParameterError error   = refusal_of(parameters);
      EXPECT_EQ(error.where, "parameter Designs/Variables");
      expect_mentions(error.reason, {reason});
    }
}

TEST(DesignPlan, ReadsAFile)
{
  const File       file("designs.csv", "\xEF\xBB\xBF"
                                             "A/x,\"B/y\"\r\n1,\"-10, 10\"\n\n2,\"-20, 20\"\n1,\"-10, 10\"");
  const DesignPlan plan = design_plan(reading(file));
  EXPECT_EQ(plan.names, (Values{"A/x", "B/y"}));
  EXPECT_EQ(plan.designs, (std::vector<Values>{{"1", "-10, 10"}, {"2", "-20, 20"}, {"1", "-10, 10"}})); // duplicates are kept
  EXPECT_EQ(plan.where.back(), "file " + file.string() + ", line 5");

  Parameters parameters;
  parameters.designs.choice = DesignChoice::file;
  EXPECT_THROW(design_plan(parameters), ParameterError);
  parameters.designs.file = "/nonexistent/designs.csv";
  EXPECT_THROW(design_plan(parameters), FileError);
}

TEST(DesignPlan, NamesTheLineOfAFileAndWhatIsWrongThere)
{
  for (const auto &[line, content, mentions] : std::vector<std::tuple<int, std::string, std::vector<std::string>>>{
         {1, "A/x;B/y\r\n0,1;0,2", {"semicolons", "decimal"}},
         {1, "A/x\tB/y\n1\t2", {"tabs"}},
         {1, "sep=;\r\nA/x;B/y\r\n", {"sep=;", "remove"}},
         {1,
          std::string("\xFF\xFE"
                      "A\0/\0x\0\n\0",
                      10),
          {"UTF-16", "UTF-8"}},
         {1, "A/x,B/y\r1,2\r", {"carriage return"}},
         {1, "A/x,B/y,\n1,2,\n", {"column 3", "ends with a comma"}},
         {3, "A/x,B/y\n1,2\n3,4,\n", {"3 values", "2 columns", "ends with a comma"}},
         {2, "A/x\n0,3\n", {"2 values", "1 column", "0.3"}},
         {2, "A/x,B/y\n1;2\n", {"semicolons"}},
         {2, "A/x,B/y\n1,\"2,\n3\"\n", {"quotation mark"}},
         {1, "A/x,B/y\n", {"no design"}},
         {2, "A/x,B/y\n1\n", {"1 value", "2 columns"}},
         {1, "A/x,B/y + A/x\n1,2\n", {"`A/x` varies twice"}},
         {1, "A/x,A/x\n1,2\n", {"`A/x` varies twice"}}})
    {
      const File           file("designs.csv", content);
      const ParameterError error = refusal_of(reading(file));
      EXPECT_EQ(error.where, "file " + file.string() + ", line " + std::to_string(line)) << error.what();
      expect_mentions(error.what(), mentions);
    }
}

TEST(WithDesign, ChangesParametersNumbersOfThemAndSeveralAtOnce)
{
  const Parameters scene;
  const Parameters design = with_design(scene,
                                        {"Geometry/Pin height", "Geometry/Top pin radii[2] + Geometry/Bottom pin radii[2]",
                                         "Mounts/Elastic mounts[3]", "Disc material/Density"},
                                        {"0.04", "0.2", "2e10", ""});
  EXPECT_EQ(design.geometry.pin_height, 0.04);
  EXPECT_EQ(design.geometry.top.radii[1], 0.2);
  EXPECT_EQ(design.geometry.bottom.radii[1], 0.2);
  EXPECT_EQ(design.geometry.top.radii[0], scene.geometry.top.radii[0]);
  EXPECT_EQ(design.materials.mounts[0].axial, 2e10);
  EXPECT_EQ(design.materials.mounts[0].tangential, scene.materials.mounts[0].tangential);
  EXPECT_EQ(design.materials.disc.density, scene.materials.disc.density);
  EXPECT_EQ(current_value(scene, "Mounts/Elastic mounts[3]"), "1.88e+10");
  EXPECT_EQ(current_value(scene, "Geometry/Pin height"), "0.0318");
}

TEST(WithDesign, RefusesUnknownNamesAndValues)
{
  for (const auto &[name, value] : {std::pair("Geometry/Pin hight", "0.04"),
                                    {"Geometry/", "0.04"},
                                    {"Geometry/Pin height", "-1"},
                                    {"Mounts/Elastic mounts[4]", "1"},
                                    {"Mounts/Elastic mounts[0]", "1"}})
    expect_mentions(message<ParameterError>([&, &name = name, &value = value] { with_design({}, {name}, {value}, "designs.csv, line 2"); }),
                    {"where:  designs.csv, line 2"});
}

TEST(WithNumber, LeavesDigitsOfNamesAlone)
{
  EXPECT_EQ(with_number("pin_top_1: 2e9, 0.25", 1, "3e9"), "pin_top_1: 3e9, 0.25");
  EXPECT_EQ(with_number("-18.4, 0, 18.4", 1, "-20"), "-20, 0, 18.4");
  EXPECT_EQ(number_of("surface2: .5, +1e-3", 2), "+1e-3");
  EXPECT_THROW(number_of("surface2: none", 1), ParameterError);
}
