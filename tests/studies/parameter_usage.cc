// SPDX-License-Identifier: GPL-3.0-or-later

#include "input.h"

#include <squeal/studies/steps/parameter_usage.h>

#include <algorithm>
#include <set>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  using Paths = std::vector<std::string>;

  Parameters parameters_of(const Paths &overrides)
  {
    return Parameters::read("/dev/null", overrides);
  }

  const Paths &all_paths()
  {
    static const Paths paths = [] {
      Parameters   parameters;
      Declarations declarations;
      parameters.declare(declarations);
      Paths result;
      for (const DeclaredParameter &parameter : declarations.parameters())
        result.push_back(parameter.path);
      return result;
    }();
    return paths;
  }

  std::set<std::string> names(const std::vector<UnusedParameter> &unused)
  {
    std::set<std::string> paths;
    for (const UnusedParameter &parameter : unused)
      paths.insert(parameter.path);
    return paths;
  }

  std::set<std::string> unused(const Paths &overrides)
  {
    return names(unused_parameters(parameters_of(overrides)));
  }

  Paths joined(Paths a, const Paths &b)
  {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  }

  constexpr const char *measured_modes = "state,label,frequency [Hz]\ncoupled,A0-4 -,2200\n";

  Paths updating(const File &measured)
  {
    return {"Study=updating", "Updating/Measured modes=" + measured.string(), "Designs/Variables=Pin material/Density = 3000 to 3200"};
  }

  /// A run, the study sections that it uses, and prefixes of other paths that it does not use.
  struct Usage
  {
    Paths              run, sections;
    std::vector<Paths> unused;

    std::set<std::string> expected() const
    {
      Paths beginnings = {"System values", "Sweep/Parameter", "Sweep/Second parameter"}; // parameters of a system file
      for (const char *section :
           {"Accuracy study/", "Designs/", "Ingredients/", "Reduction/", "Robustness/", "Search/", "Sensitivity/", "Sweep/", "Updating/"})
        if (std::find(sections.begin(), sections.end(), section) == sections.end())
          beginnings.emplace_back(section);
      if (!run.empty() && run.front().rfind("Study=", 0) == 0) // the run is not a stability study
        beginnings.emplace_back("Discretization/Coarser mesh");
      for (const Paths &some : unused)
        beginnings = joined(beginnings, some);
      std::set<std::string> paths;
      for (const std::string &path : all_paths())
        for (const std::string &beginning : beginnings)
          if (path.rfind(beginning, 0) == 0)
            paths.insert(path);
      return paths;
    }
  };
} // namespace

TEST(ParameterUsage, EveryStudyIsFoundByItsNameAndUsesItsDefaults)
{
  const File measured("modes.csv", measured_modes);
  EXPECT_EQ(studies().front(), Parameters().study);
  std::set<std::string> names;
  for (const Study *study : studies())
    {
      Paths run = {std::string("Study=") + study->name};
      if (run.front() == "Study=geometry" || run.front() == "Study=search") // `Designs/Variables` has no default
        run.emplace_back("Designs/Variables=Geometry/Pin height = 0.03 to 0.04 in 2");
      if (run.front() == "Study=robustness")
        run.emplace_back("Robustness/Distributions=Pin material/Density = uniform 90 % to 110 %");
      if (run.front() == "Study=updating")
        run = updating(measured);
      EXPECT_EQ(parameters_of(run).study, study) << study->name;
      EXPECT_EQ(unused(run), std::set<std::string>()) << study->name; // parameters with default values are not reported
      EXPECT_NE(study->run, nullptr) << study->name;
      EXPECT_TRUE(names.insert(study->name).second) << study->name;
    }
  EXPECT_EQ(names, (std::set<std::string>{"accuracy", "geometry", "ingredients", "reduction", "robustness", "search", "sensitivity",
                                          "stability", "sweep", "updating"}));
}

TEST(ParameterUsage, OfASystemFile)
{
  const auto paths = names(unused_among({"Operation/Friction coefficient", "Geometry/File", "Sweep/Parameter", "Sweep/Map parameter",
                                         "Band/Maximum frequency", "Band/Maximum rate", "Output/Write system", "Sensitivity/Thresholds"},
                                        parameters_of({"Study=sweep", "System=brake"})));
  EXPECT_EQ(paths,
            (std::set<std::string>{"Operation/Friction coefficient", "Geometry/File", "Sweep/Map parameter", "Sensitivity/Thresholds"}));
  EXPECT_EQ(names(unused_among({"Reduction/Bases", "Reduction/Component modes", "Reduction/Problem", "Sweep/Parameter"},
                               parameters_of({"Study=reduction", "System=brake"}))),
            (std::set<std::string>{"Reduction/Component modes", "Reduction/Problem", "Sweep/Parameter"}));
  EXPECT_EQ(names(unused_among({"Band/Maximum rate"}, parameters_of({"Study=sensitivity", "System=brake"}))), std::set<std::string>());
  EXPECT_THROW(parameters_of({"Study=ingredients", "System=brake"}), ParameterError);
}

TEST(ParameterUsage, OfEveryStudy)
{
  const std::string dissipation = "Operation/Radial dissipation=consistent", steady = "Steady sliding/Contact state=steady sliding";
  const Paths no_sliding = {"Steady sliding/Control", "Steady sliding/Displacement", "Steady sliding/Loads", "Steady sliding/Pressed faces",
                            "Steady sliding/Gaps"};
  const Paths undamped   = {"Operation/Load", "Operation/Rotation speed"};
  const Paths krylov     = {"Complex modes/Iteration", "Complex modes/Maximum"};
  const Paths no_fields  = {"Output/Mode", "Output/Animation", "Output/Component", "Output/Real", "Output/Write matrices"};
  const Paths no_system  = {"Output/Write system"};
  const Paths no_shapes  = joined(no_fields, {"Complex modes/Iteration"});
  const Paths reduced    = joined(no_fields, {"Complex modes/"});
  const Paths no_stability = {"Output/Write matrices", "Output/Component", "Output/Real"};
  const Paths no_map       = {"Sweep/First map", "Sweep/Last map", "Sweep/Number of map", "Sweep/Map friction"};
  const Paths no_sweep     = joined(no_map, {"Sweep/Compare", "Sweep/Mode", "Sweep/Complex", "Sweep/Count", "Sweep/Map parameter"});
  const Paths no_bases     = {"Reduction/Grown", "Reduction/Snapshots", "Reduction/POD"};
  const Paths design       = {"Study=geometry", "Designs/Variables=Geometry/Pin height = 0.03 to 0.04 in 2"};
  const Paths own_meshes   = {"Discretization/Element", "Geometry/Outlines"};
  const Paths one_mu       = {"Operation/Friction coefficient"};
  const Paths no_rate      = {"Band/Maximum rate"};
  const File  measured("modes.csv", measured_modes);

  const std::vector<Usage> table = {
    {{}, {}, {no_sliding, undamped, krylov}},
    {{dissipation}, {}, {no_sliding, krylov}},
    {{steady}, {}, {krylov}},
    {{steady, "Steady sliding/Control=displacement", "Steady sliding/Displacement=1e-6"}, {}, {krylov, {"Operation/Load"}}},
    {{"Complex modes/Solver=residual iteration", "Output/Mode shapes=none", "Operation/Friction slope=0.01"},
     {},
     {no_sliding, {"Complex modes/Shift", "Complex modes/Tolerance", "Output/Animation"}}},
    {{"Output/Animation frames=0"}, {}, {no_sliding, undamped, krylov, {"Output/Animation periods", "Output/Animation growth"}}},

    {{"Study=accuracy"}, {"Accuracy study/"}, {no_shapes, no_system, no_sliding, undamped, own_meshes}},
    {{"Study=accuracy", "Accuracy study/Bases=real", dissipation},
     {"Accuracy study/"},
     {no_shapes, no_system, no_sliding, own_meshes, {"Complex modes/Maximum", "Accuracy study/Grown"}}},

    // The study uses all parameters of contact state, dissipation, solver and rotation, because it varies them
    {{"Study=ingredients"}, {"Ingredients/"}, {{"Output/"}}},

    {{"Study=reduction"}, {"Reduction/"}, {no_shapes, no_sliding, undamped}},
    {{"Study=reduction", "Reduction/Bases=real, free", dissipation},
     {"Reduction/"},
     {no_shapes, no_sliding, no_bases, {"Complex modes/Maximum"}}},
    {{"Study=reduction", "Reduction/Bases=residual-grown, POD", dissipation},
     {"Reduction/"},
     {no_shapes, no_sliding, {"Reduction/Component modes", "Reduction/Coupled frequency"}}},
    {{"Study=reduction", "Reduction/Problem=frictionless"},
     {"Reduction/"},
     {reduced,
      no_rate,
      no_sliding,
      no_bases,
      {"Operation/", "Damping/", "Disc material/Rayleigh", "Pin material/Rayleigh", "Reduction/Coupled"}}},

    {{"Study=sweep"},
     {"Sweep/"},
     {{"Complex modes/", "Output/Mode", "Output/Animation"}, no_stability, no_map, no_sliding, undamped, one_mu}},
    {{"Study=sweep", "Sweep/Mode shapes at=0.1", dissipation, "Sweep/Map parameter=speed"},
     {"Sweep/"},
     {{"Complex modes/"}, no_stability, no_sliding, one_mu}},

    {{"Study=sensitivity"}, {"Sensitivity/", "Sweep/"}, {reduced, no_rate, no_sweep, no_sliding, undamped}},
    {{"Study=sensitivity", dissipation}, {"Sensitivity/", "Sweep/"}, {reduced, no_rate, no_sweep, no_sliding}},
    {{"Study=sensitivity", "Sensitivity/Thresholds=false"},
     {"Sensitivity/", "Sweep/"},
     {reduced,
      no_rate,
      no_sweep,
      no_sliding,
      undamped,
      {"Sweep/First friction", "Sweep/Last friction", "Sweep/Number of friction", "Sweep/Threshold"}}},

    {design,
     {"Designs/", "Sweep/"},
     {reduced, no_system, no_rate, no_sweep, no_sliding, undamped, one_mu, {"Designs/Number", "Designs/Seed", "Designs/File"}}},
    {joined(design, {"Designs/Plan=Sobol sequence", steady}),
     {"Designs/", "Sweep/"},
     {reduced, no_system, no_rate, no_sweep, one_mu, {"Designs/File", "Operation/Rotation speed"}}},
    // A search uses ranges instead of a plan
    {{"Study=search", "Designs/Variables=Geometry/Pin height=0.03 to 0.04"},
     {"Designs/", "Search/", "Sweep/"},
     {reduced, no_system, no_sweep, no_sliding, undamped, one_mu, {"Designs/Plan", "Designs/Number", "Designs/File", "Search/Quantile"}}},
    {{"Study=search", "Designs/Variables=Pin material/Density = 2000 to 3000", "Search/Goal=quantile",
      "Robustness/Distributions=Operation/Friction coefficient = uniform 0.2 to 0.4"},
     {"Designs/", "Search/", "Robustness/"},
     {reduced, no_system, no_sliding, undamped, {"Designs/Plan", "Designs/Number", "Designs/File", "Designs/Processes"}}},

    {{"Study=robustness", "Robustness/Distributions=Pin material/Density = uniform 90 % to 110 %"},
     {"Robustness/"},
     {reduced, no_sliding, undamped}},
    {{"Study=robustness", "Robustness/Distributions=Pin material/Density = uniform 90 % to 110 %", "Robustness/Samples with onsets=5"},
     {"Robustness/", "Sweep/"},
     {reduced, no_sweep, no_sliding, undamped}},

    {updating(measured),
     {"Updating/", "Designs/"},
     {{"Output/", "Complex modes/Solver", "Complex modes/Shift", "Complex modes/Tolerance", "Complex modes/Iteration", "Designs/Plan",
       "Designs/File", "Designs/Number", "Designs/Seed", "Designs/Processes", "Updating/Least MAC"},
      no_sliding,
      undamped}}};
  std::set<std::string> conditional;
  for (const Usage &usage : table)
    {
      const std::set<std::string> found = names(unused_among(all_paths(), parameters_of(usage.run)));
      EXPECT_EQ(found, usage.expected()) << ::testing::PrintToString(usage.run);
      conditional.insert(found.begin(), found.end());
    }

  // Every parameter is either always used or unused in at least one run of the table
  const std::set<std::string> always       = {"Geometry", "Mounts", "Discretization", "Band", "Real modes", "Linear algebra", "Contact"};
  const std::set<std::string> of_materials = {"Young modulus", "Poisson ratio", "Density", "Volumes", "Orthotropic", "Axes"};
  for (const std::string &path : all_paths())
    {
      const auto slash          = path.find('/');
      const bool is_always_used = path == "Study" || path == "Accuracy" || path == "System" || path == "Steady sliding/Contact state" ||
                                  always.count(path.substr(0, slash)) > 0 || of_materials.count(path.substr(slash + 1)) > 0;
      EXPECT_TRUE(is_always_used || conditional.count(path) > 0) << path << " has no usage rule";
    }
  // Every path in a rule of a study must exist; the check above detects misspelt paths in general rules
  for (const Study *study : studies())
    {
      std::vector<std::string> beginnings(study->own_parameters.begin(), study->own_parameters.end());
      for (const UsageRule &rule : study->rules)
        beginnings.emplace_back(rule.path);
      for (const std::string &beginning : beginnings)
        EXPECT_TRUE(
          std::any_of(all_paths().begin(), all_paths().end(), [&](const std::string &path) { return path.rfind(beginning, 0) == 0; }))
          << beginning;
    }
}

TEST(ParameterUsage, OfGeometries)
{
  const std::string format = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n", end = "$EndPhysicalNames\n";
  const std::string thickness = "Geometry/Disc thickness", radius = "Geometry/Disc outer radius", diameter = "Geometry/Pin diameter";
  for (const auto &[name, text, paths] : std::vector<std::tuple<std::string, std::string, std::set<std::string>>>{
         {"plan.geo", "// pin_diameter\nr = disc_outer_radius;\nPhysical Surface(\"disc\") = {1};\n", {diameter}},
         {"solid.geo", "r = pin_diameter;\nPhysical  Volume(\"disc\") = {1};\n", {thickness, radius}},
         {"solid.msh", format + "2\n2 1 \"disc_rim\"\n3 2 \"disc\"\n" + end, {thickness, radius, diameter}},
         {"plan.msh", format + "1\n2 1 \"disc\"\n" + end, {radius, diameter}}})
    {
      const File file(name, text);
      EXPECT_EQ(unused({thickness + "=0.04", diameter + "=0.04", radius + "=0.32", "Geometry/File=" + file.string()}), paths) << name;
    }
  EXPECT_EQ(unused({thickness + "=0.04", diameter + "=0.04", radius + "=0.32"}), std::set<std::string>()); // parameters of disc_pins.geo
}

TEST(ParameterUsage, NoFalseAlarmOnShippedFiles)
{
  std::size_t n_files = 0;
  for (const auto &entry : std::filesystem::recursive_directory_iterator(SQUEAL_SOURCE_DIRECTORY "/prm"))
    if (entry.path().extension() == ".prm")
      {
        EXPECT_EQ(unused_parameters_note(Parameters::read(entry.path().string(), {})), "") << entry.path();
        ++n_files;
      }
  EXPECT_GE(n_files, 17u);
}

TEST(ParameterUsage, TheNoteNamesAllWithTheirReasons)
{
  EXPECT_EQ(unused_parameters_note(parameters_of({"Operation/Load per side=500", "Sweep/Tolerance=1e-5"})),
            "  note: unused parameters: Operation/Load per side (no contact damping), Sweep/Tolerance (a parameter of Study = sweep)");
}
