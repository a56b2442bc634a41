#include <squeal/studies/steps/parameter_usage.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

using namespace Squeal;

namespace
{
  namespace fs = std::filesystem;

  /// Parameters read from an empty file and overrides.
  Parameters parameters_of(const std::vector<std::string> &overrides)
  {
    const fs::path file = fs::temp_directory_path() / ("squeal_usage_" + std::to_string(getpid()) + ".prm");
    std::ofstream(file.string()).flush();
    const Parameters parameters = Parameters::read(file.string(), overrides);
    fs::remove(file);
    return parameters;
  }

  /// What a study needs to be told, since it has no default.
  std::vector<std::string> run_of(const Study &study)
  {
    std::vector<std::string> overrides = {std::string("Study=") + study.name};
    if (overrides.front() == "Study=geometry" || overrides.front() == "Study=search")
      overrides.emplace_back("Designs/Variables=Geometry/Pin height = 0.03 to 0.04 in 2");
    return overrides;
  }

  std::set<std::string> unused(const std::vector<std::string> &overrides)
  {
    std::set<std::string> paths;
    for (const UnusedParameter &parameter : unused_parameters(parameters_of(overrides)))
      paths.insert(parameter.path);
    return paths;
  }

  /// A value other than the default for every parameter that some run does not use.
  const std::map<std::string, std::string> &other_values()
  {
    static const std::map<std::string, std::string> values = {{"Disc material/Rayleigh alpha", "1"},
                                                              {"Disc material/Rayleigh beta", "1e-9"},
                                                              {"Pin material/Rayleigh alpha", "1"},
                                                              {"Pin material/Rayleigh beta", "1e-9"},
                                                              {"Damping/Modal damping ratio", "100: 0.01"},
                                                              {"Operation/Friction coefficient", "0.3"},
                                                              {"Operation/Rotation", "negative"},
                                                              {"Operation/Rotation speed", "5"},
                                                              {"Operation/Gyroscopic forces", "true"},
                                                              {"Operation/Load per side", "500"},
                                                              {"Operation/Radial dissipation", "consistent"},
                                                              {"Operation/Friction slope", "-0.01"},
                                                              {"Steady sliding/Contact state", "steady sliding"},
                                                              {"Steady sliding/Control", "load per pin"},
                                                              {"Steady sliding/Displacement", "1e-5"},
                                                              {"Steady sliding/Loads", "pin_top_1: 100"},
                                                              {"Steady sliding/Gaps", "pin_top_1: 1e-6"},
                                                              {"Reduction/Problem", "frictionless"},
                                                              {"Reduction/Bases", "free"},
                                                              {"Reduction/Component modes", "6000"},
                                                              {"Reduction/Coupled frequency", "6000"},
                                                              {"Reduction/Rank tolerance", "1e-9"},
                                                              {"Reduction/Grown tolerances", "1e-5"},
                                                              {"Reduction/Snapshots", "0.1"},
                                                              {"Reduction/POD tolerance", "1e-5"},
                                                              {"Sweep/First friction coefficient", "0.1"},
                                                              {"Sweep/Last friction coefficient", "0.3"},
                                                              {"Sweep/Number of friction coefficients", "10"},
                                                              {"Sweep/Tolerance", "1e-5"},
                                                              {"Sweep/Maximum basis", "1000"},
                                                              {"Sweep/Threshold tolerance", "1e-5"},
                                                              {"Sweep/Compare dissipation", "false"},
                                                              {"Sweep/Mode shapes at", "0.2"},
                                                              {"Sweep/Complex plane at", "0.2"},
                                                              {"Sweep/Count modes at", "0.2"},
                                                              {"Sweep/Map parameter", "load"},
                                                              {"Sweep/First map value", "200"},
                                                              {"Sweep/Last map value", "2000"},
                                                              {"Sweep/Number of map values", "3"},
                                                              {"Sweep/Map friction coefficients", "3"},
                                                              {"Accuracy study/Mesh factors", "1, 2"},
                                                              {"Accuracy study/Elements", "quadratic"},
                                                              {"Accuracy study/Outlines", "true area"},
                                                              {"Accuracy study/Bases", "real"},
                                                              {"Accuracy study/Grown tolerance", "1e-5"},
                                                              {"Accuracy study/Largest number of dofs", "1e6"},
                                                              {"Accuracy study/Band margin", "0.2"},
                                                              {"Designs/Plan", "one at a time"},
                                                              {"Designs/Variables", "Geometry/Pin height = 0.03, 0.032"},
                                                              {"Designs/File", "designs.csv"},
                                                              {"Designs/Number of designs", "5"},
                                                              {"Designs/Seed", "2"},
                                                              {"Designs/Processes", "3"},
                                                              {"Sensitivity/Largest number of modes", "3"},
                                                              {"Sensitivity/Thresholds", "false"},
                                                              {"Sensitivity/Geometry", "none"},
                                                              {"Sensitivity/Tolerance", "1e-5"},
                                                              {"Search/Goal", "onset"},
                                                              {"Search/Method", "COBYLA"},
                                                              {"Search/Samples", "5"},
                                                              {"Search/Evaluations", "30"},
                                                              {"Search/First step", "0.1"},
                                                              {"Search/Smallest step", "0.01"},
                                                              {"Ingredients/Frequency tolerance", "2"},
                                                              {"Ingredients/Divergence tolerance", "0.1"},
                                                              {"Ingredients/Trial friction slope", "-0.01"},
                                                              {"Ingredients/Trial damping ratio", "0.01"},
                                                              {"Complex modes/Solver", "residual iteration"},
                                                              {"Complex modes/Shift inverse", "sparse LU"},
                                                              {"Complex modes/Tolerance", "1e-8"},
                                                              {"Complex modes/Iteration tolerance", "1e-6"},
                                                              {"Complex modes/Maximum basis", "1000"},
                                                              {"Output/Mode shapes", "unstable"},
                                                              {"Output/Component mode shapes", "true"},
                                                              {"Output/Real mode shapes", "true"},
                                                              {"Output/Animation frames", "3"},
                                                              {"Output/Animation periods", "2"},
                                                              {"Output/Animation growth", "true"},
                                                              {"Output/Write matrices", "true"}};
    return values;
  }

  /// Those of the parameters that are not used when each alone is changed.
  std::set<std::string> unused_alone(const std::vector<std::string> &run)
  {
    std::set<std::string> paths;
    for (const auto &[path, value] : other_values())
      {
        std::vector<std::string> overrides = run;
        overrides.push_back(path + "=" + value);
        try
          {
            for (const std::string &unused_path : unused(overrides))
              if (unused_path == path)
                paths.insert(path);
          }
        catch (const std::exception &)
          {} // a combination that is refused is no question of use
      }
    return paths;
  }

  /// Paths that begin with one of the given texts, without some exceptions.
  std::set<std::string> those_of(const std::vector<std::string> &beginnings, const std::set<std::string> &exceptions = {})
  {
    std::set<std::string> paths;
    for (const auto &[path, value] : other_values())
      for (const std::string &beginning : beginnings)
        if (path.rfind(beginning, 0) == 0 && exceptions.count(path) == 0)
          paths.insert(path);
    return paths;
  }

  const std::vector<std::string> sweep_map = {"Sweep/First map value", "Sweep/Last map value", "Sweep/Number of map values",
                                              "Sweep/Map friction"};

  std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string> &b)
  {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  }
} // namespace

TEST(ParameterUsage, EveryParameterIsAccountedFor)
{
  // Of these sections every run uses everything; of the others every parameter must be in the table of the tests below.
  const std::set<std::string> always       = {"Geometry", "Mounts", "Discretization", "Band", "Real modes", "Linear algebra"};
  const std::set<std::string> of_materials = {"Young modulus", "Poisson ratio", "Density", "Single pins"};
  Parameters                  parameters;
  Declarations                declarations;
  parameters.declare(declarations);
  std::set<std::string> declared;
  for (const DeclaredParameter &parameter : declarations.parameters())
    {
      declared.insert(parameter.path);
      const auto slash          = parameter.path.find('/');
      const bool is_always_used = parameter.path == "Study" || parameter.path == "Accuracy" ||
                                  always.count(parameter.path.substr(0, slash)) > 0 ||
                                  of_materials.count(parameter.path.substr(slash + 1)) > 0;
      EXPECT_TRUE(is_always_used || other_values().count(parameter.path) > 0) << parameter.path << " has no rule of when it is used";
    }
  for (const auto &[path, value] : other_values())
    EXPECT_EQ(declared.count(path), 1u) << path;
  for (const std::string &path : conditional_parameters())
    EXPECT_TRUE(std::any_of(declared.begin(), declared.end(), [&](const std::string &name) { return name.rfind(path, 0) == 0; })) << path;
}

TEST(ParameterUsage, NothingIsUnusedByDefault)
{
  for (const Study *study : studies())
    EXPECT_EQ(unused(run_of(*study)), std::set<std::string>()) << study->name;
}

TEST(ParameterUsage, EveryStudyIsFoundByItsName)
{
  EXPECT_EQ(studies().front(), Parameters().study);
  std::set<std::string> names;
  for (const Study *study : studies())
    {
      EXPECT_EQ(parameters_of(run_of(*study)).study, study) << study->name;
      EXPECT_NE(study->run, nullptr) << study->name;
      EXPECT_TRUE(names.insert(study->name).second) << study->name;
    }
  EXPECT_EQ(names,
            (std::set<std::string>{"accuracy", "geometry", "ingredients", "reduction", "search", "sensitivity", "stability", "sweep"}));
}

TEST(ParameterUsage, OfStability)
{
  const std::vector<std::string> others = {
    "Reduction/",           "Sweep/", "Ingredients/", "Accuracy study/", "Designs/", "Search/", "Sensitivity/", "Complex modes/Iteration",
    "Complex modes/Maximum"};
  const std::vector<std::string> steady = {"Steady sliding/Control", "Steady sliding/Displacement", "Steady sliding/Loads",
                                           "Steady sliding/Gaps"};
  EXPECT_EQ(unused_alone({}), those_of(joined(joined(others, steady), {"Operation/Load", "Operation/Rotation speed"})));
  EXPECT_EQ(unused_alone({"Operation/Radial dissipation=consistent"}), those_of(joined(others, steady)));
  EXPECT_EQ(unused_alone({"Steady sliding/Contact state=steady sliding"}), those_of(others));
  EXPECT_EQ(unused_alone(
              {"Steady sliding/Contact state=steady sliding", "Steady sliding/Control=displacement", "Steady sliding/Displacement=1e-6"}),
            those_of(joined(others, {"Operation/Load"})));
  EXPECT_EQ(unused_alone({"Complex modes/Solver=residual iteration", "Output/Mode shapes=none", "Operation/Friction slope=0.01"}),
            those_of(joined({"Reduction/", "Sweep/", "Ingredients/", "Accuracy study/", "Designs/", "Search/", "Sensitivity/",
                             "Complex modes/Shift", "Complex modes/Tolerance", "Output/Animation"},
                            steady)));
  EXPECT_EQ(unused_alone({"Output/Animation frames=0"}),
            those_of(joined(joined(joined(others, steady), {"Operation/Load", "Operation/Rotation speed"}),
                            {"Output/Animation periods", "Output/Animation growth"})));
}

TEST(ParameterUsage, OfAccuracy)
{
  const std::vector<std::string> steady = {"Steady sliding/Control", "Steady sliding/Displacement", "Steady sliding/Loads",
                                           "Steady sliding/Gaps"};
  const std::vector<std::string> others =
    joined({"Reduction/", "Sweep/", "Ingredients/", "Designs/", "Search/", "Sensitivity/", "Output/", "Complex modes/Iteration"}, steady);
  EXPECT_EQ(unused_alone({"Study=accuracy"}), those_of(joined(others, {"Operation/Load", "Operation/Rotation speed"})));
  EXPECT_EQ(unused_alone({"Study=accuracy", "Accuracy study/Bases=real", "Operation/Radial dissipation=consistent"}),
            those_of(joined(others, {"Complex modes/Maximum", "Accuracy study/Grown"}), {"Accuracy study/Bases"}));
}

TEST(ParameterUsage, OfIngredients)
{
  // The study goes through contact states, dissipations, solvers and rotation on its own: what they need is of use
  EXPECT_EQ(unused_alone({"Study=ingredients"}),
            those_of({"Reduction/", "Sweep/", "Accuracy study/", "Designs/", "Search/", "Sensitivity/", "Output/"}));
}

TEST(ParameterUsage, OfReduction)
{
  const std::vector<std::string> always = {"Sensitivity/",
                                           "Sweep/",
                                           "Ingredients/",
                                           "Accuracy study/",
                                           "Designs/",
                                           "Search/",
                                           "Output/",
                                           "Steady sliding/Control",
                                           "Steady sliding/Displacement",
                                           "Steady sliding/Loads",
                                           "Steady sliding/Gaps",
                                           "Complex modes/Iteration"};
  EXPECT_EQ(unused_alone({"Study=reduction"}), those_of(joined(always, {"Operation/Load", "Operation/Rotation speed"})));
  EXPECT_EQ(unused_alone({"Study=reduction", "Reduction/Bases=real, free", "Operation/Radial dissipation=consistent"}),
            those_of(joined(always, {"Complex modes/Maximum", "Reduction/Grown", "Reduction/Snapshots", "Reduction/POD"})));
  EXPECT_EQ(unused_alone({"Study=reduction", "Reduction/Bases=residual-grown, POD", "Operation/Radial dissipation=consistent"}),
            those_of(joined(always, {"Reduction/Component modes", "Reduction/Coupled frequency"})));
  EXPECT_EQ(unused_alone({"Study=reduction", "Reduction/Problem=frictionless"}),
            those_of(joined(always, {"Operation/", "Damping/", "Disc material/", "Pin material/", "Complex modes/", "Reduction/Coupled",
                                     "Reduction/Grown", "Reduction/Snapshots", "Reduction/POD"})));
}

TEST(ParameterUsage, OfSweeps)
{
  const std::vector<std::string> always = {"Reduction/",   "Ingredients/",     "Accuracy study/", "Designs/",
                                           "Search/",      "Sensitivity/",     "Complex modes/",  "Operation/Friction coefficient",
                                           "Output/Write", "Output/Component", "Output/Real"};
  const std::vector<std::string> steady = {"Steady sliding/Control", "Steady sliding/Displacement", "Steady sliding/Loads",
                                           "Steady sliding/Gaps"};
  EXPECT_EQ(unused_alone({"Study=sweep"}),
            those_of(joined(joined(joined(always, sweep_map), steady), {"Operation/Load", "Operation/Rotation speed", "Output/"})));
  EXPECT_EQ(
    unused_alone({"Study=sweep", "Sweep/Mode shapes at=0.1", "Operation/Radial dissipation=consistent", "Sweep/Map parameter=speed"}),
    those_of(joined(always, steady)));
}

TEST(ParameterUsage, OfSensitivities)
{
  const std::vector<std::string> always = {"Designs/",       "Search/",         "Reduction/",     "Ingredients/",        "Accuracy study/",
                                           "Complex modes/", "Sweep/Compare",   "Sweep/Mode",     "Sweep/Complex plane", "Sweep/Count",
                                           "Sweep/Map",      "Sweep/First map", "Sweep/Last map", "Sweep/Number of map", "Output/"};
  const std::vector<std::string> steady = {"Steady sliding/Control", "Steady sliding/Displacement", "Steady sliding/Loads",
                                           "Steady sliding/Gaps"};
  const std::vector<std::string> undamped = {"Operation/Load", "Operation/Rotation speed"};
  // Modal damping is refused
  const std::set<std::string> refused = {"Damping/Modal damping ratio"};
  EXPECT_EQ(unused_alone({"Study=sensitivity"}), those_of(joined(joined(always, steady), undamped), refused));
  EXPECT_EQ(unused_alone({"Study=sensitivity", "Operation/Radial dissipation=consistent"}), those_of(joined(always, steady), refused));
  EXPECT_EQ(unused_alone({"Study=sensitivity", "Sensitivity/Thresholds=false"}),
            those_of(joined(joined(joined(always, steady), undamped),
                            {"Sweep/First friction", "Sweep/Last friction", "Sweep/Number of friction", "Sweep/Threshold"}),
                     refused));
}

TEST(ParameterUsage, OfGeometries)
{
  const fs::path folder = fs::temp_directory_path() / ("squeal_geometries_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const auto file = [&](const std::string &name, const std::string &text) {
    std::ofstream((folder / name).string()) << text;
    return "Geometry/File=" + (folder / name).string();
  };
  const std::vector<std::string> sizes = {"Geometry/Disc thickness=0.04", "Geometry/Pin diameter=0.04", "Geometry/Disc outer radius=0.32"};
  const auto                     with  = [&](const std::string &geometry) { return unused(joined(sizes, {geometry})); };

  EXPECT_EQ(with("Geometry/File=disc_pins.geo"), std::set<std::string>());
  EXPECT_EQ(with(file("plan.geo", "// pin_diameter\nr = disc_outer_radius;\nPhysical Surface(\"disc\") = {1};\n")),
            std::set<std::string>{"Geometry/Pin diameter"});
  EXPECT_EQ(with(file("solid.geo", "r = pin_diameter;\nPhysical  Volume(\"disc\") = {1};\n")),
            (std::set<std::string>{"Geometry/Disc thickness", "Geometry/Disc outer radius"}));
  EXPECT_EQ(
    with(file("solid.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"disc_rim\"\n3 2 \"disc\"\n$EndPhysicalNames\n")),
    (std::set<std::string>{"Geometry/Disc thickness", "Geometry/Disc outer radius", "Geometry/Pin diameter"}));
  EXPECT_EQ(with(file("plan.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"disc\"\n$EndPhysicalNames\n")),
            (std::set<std::string>{"Geometry/Disc outer radius", "Geometry/Pin diameter"}));
  fs::remove_all(folder);
}

TEST(ParameterUsage, NoFalseAlarmOnShippedFiles)
{
  std::size_t n_files = 0;
  for (const auto &entry : fs::recursive_directory_iterator(fs::path(SQUEAL_SOURCE_DIRECTORY) / "prm"))
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
            "  note: not used here: Operation/Load per side (no contact damping), Sweep/Tolerance (of Study = sweep)");
}

TEST(ParameterUsage, OfDesigns)
{
  const std::vector<std::string> run =
    run_of(*Parameters::read("/dev/null", {"Study=geometry", "Designs/Variables=Geometry/Pin height=1, 2"}).study);
  const std::vector<std::string> always = {"Sensitivity/",
                                           "Search/",
                                           "Reduction/",
                                           "Ingredients/",
                                           "Accuracy study/",
                                           "Complex modes/",
                                           "Operation/Friction coefficient",
                                           "Output/",
                                           "Sweep/Compare",
                                           "Sweep/Mode shapes",
                                           "Sweep/Complex",
                                           "Sweep/Count",
                                           "Sweep/Map",
                                           "Sweep/First map",
                                           "Sweep/Last map",
                                           "Sweep/Number of map"};
  const std::vector<std::string> steady = {"Steady sliding/Control", "Steady sliding/Displacement", "Steady sliding/Loads",
                                           "Steady sliding/Gaps"};
  const std::vector<std::string> idle   = {"Operation/Load", "Operation/Rotation speed"};
  EXPECT_EQ(unused_alone(run), those_of(joined(joined(joined(always, steady), idle), {"Designs/Number", "Designs/Seed", "Designs/File"})));
  EXPECT_EQ(unused_alone(joined(run, {"Designs/Plan=Sobol sequence", "Steady sliding/Contact state=steady sliding"})),
            those_of(joined(always, {"Designs/File", "Operation/Rotation speed"})));

  // A search has ranges in the place of a plan
  std::vector<std::string> search = always;
  search.erase(std::remove(search.begin(), search.end(), "Search/"), search.end());
  EXPECT_EQ(unused_alone({"Study=search", "Designs/Variables=Geometry/Pin height=0.03 to 0.04"}),
            those_of(joined(joined(joined(search, steady), idle), {"Designs/Plan", "Designs/Number", "Designs/File"})));
}
