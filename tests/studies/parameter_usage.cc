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

  using Paths = std::vector<std::string>;

  Paths joined(Paths a, const Paths &b)
  {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  }

  /// A run, the sections of studies of which it uses something, and beginnings of the paths that it does not use beside the other sections.
  struct Usage
  {
    Paths              run, sections;
    std::vector<Paths> unused;

    std::set<std::string> expected() const
    {
      Paths beginnings;
      for (const char *section : {"Accuracy study/", "Designs/", "Ingredients/", "Reduction/", "Search/", "Sensitivity/", "Sweep/"})
        if (std::find(sections.begin(), sections.end(), section) == sections.end())
          beginnings.emplace_back(section);
      for (const Paths &some : unused)
        beginnings = joined(beginnings, some);
      std::set<std::string> paths;
      for (const auto &[path, value] : other_values())
        for (const std::string &beginning : beginnings)
          if (path.rfind(beginning, 0) == 0)
            paths.insert(path);
      return paths;
    }
  };
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

TEST(ParameterUsage, EveryStudyIsFoundByItsNameAndUsesItsDefaults)
{
  EXPECT_EQ(studies().front(), Parameters().study);
  std::set<std::string> names;
  for (const Study *study : studies())
    {
      EXPECT_EQ(parameters_of(run_of(*study)).study, study) << study->name;
      EXPECT_EQ(unused(run_of(*study)), std::set<std::string>()) << study->name; // by default
      EXPECT_NE(study->run, nullptr) << study->name;
      EXPECT_TRUE(names.insert(study->name).second) << study->name;
    }
  EXPECT_EQ(names,
            (std::set<std::string>{"accuracy", "geometry", "ingredients", "reduction", "search", "sensitivity", "stability", "sweep"}));
}

TEST(ParameterUsage, OfEveryStudy)
{
  const std::string dissipation = "Operation/Radial dissipation=consistent", steady = "Steady sliding/Contact state=steady sliding";
  const Paths       no_sliding = {"Steady sliding/Control", "Steady sliding/Displacement", "Steady sliding/Loads", "Steady sliding/Gaps"};
  const Paths       undamped   = {"Operation/Load", "Operation/Rotation speed"};
  const Paths       krylov     = {"Complex modes/Iteration", "Complex modes/Maximum"};
  const Paths       no_shapes  = {"Output/", "Complex modes/Iteration"};
  const Paths       reduced    = {"Output/", "Complex modes/"};
  const Paths       no_map     = {"Sweep/First map", "Sweep/Last map", "Sweep/Number of map", "Sweep/Map friction"};
  const Paths       no_sweep   = joined(no_map, {"Sweep/Compare", "Sweep/Mode", "Sweep/Complex", "Sweep/Count", "Sweep/Map parameter"});
  const Paths       no_bases   = {"Reduction/Grown", "Reduction/Snapshots", "Reduction/POD"};
  const Paths       design     = {"Study=geometry", "Designs/Variables=Geometry/Pin height = 0.03 to 0.04 in 2"};
  const Paths       one_mu     = {"Operation/Friction coefficient"};

  const std::vector<Usage> table = {
    {{}, {}, {no_sliding, undamped, krylov}},
    {{dissipation}, {}, {no_sliding, krylov}},
    {{steady}, {}, {krylov}},
    {{steady, "Steady sliding/Control=displacement", "Steady sliding/Displacement=1e-6"}, {}, {krylov, {"Operation/Load"}}},
    {{"Complex modes/Solver=residual iteration", "Output/Mode shapes=none", "Operation/Friction slope=0.01"},
     {},
     {no_sliding, {"Complex modes/Shift", "Complex modes/Tolerance", "Output/Animation"}}},
    {{"Output/Animation frames=0"}, {}, {no_sliding, undamped, krylov, {"Output/Animation periods", "Output/Animation growth"}}},

    {{"Study=accuracy"}, {"Accuracy study/"}, {no_shapes, no_sliding, undamped}},
    {{"Study=accuracy", "Accuracy study/Bases=real", dissipation},
     {"Accuracy study/"},
     {no_shapes, no_sliding, {"Complex modes/Maximum", "Accuracy study/Grown"}}},

    // The study goes through contact states, dissipations, solvers and rotation on its own: what they need is of use
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
     {reduced, no_sliding, no_bases, {"Operation/", "Damping/", "Disc material/", "Pin material/", "Reduction/Coupled"}}},

    {{"Study=sweep"}, {"Sweep/"}, {reduced, no_map, no_sliding, undamped, one_mu}},
    {{"Study=sweep", "Sweep/Mode shapes at=0.1", dissipation, "Sweep/Map parameter=speed"},
     {"Sweep/"},
     {{"Complex modes/", "Output/Write", "Output/Component", "Output/Real"}, no_sliding, one_mu}},

    {{"Study=sensitivity"}, {"Sensitivity/", "Sweep/"}, {reduced, no_sweep, no_sliding, undamped}},
    {{"Study=sensitivity", dissipation}, {"Sensitivity/", "Sweep/"}, {reduced, no_sweep, no_sliding}},
    {{"Study=sensitivity", "Sensitivity/Thresholds=false"},
     {"Sensitivity/", "Sweep/"},
     {reduced,
      no_sweep,
      no_sliding,
      undamped,
      {"Sweep/First friction", "Sweep/Last friction", "Sweep/Number of friction", "Sweep/Threshold"}}},

    {design, {"Designs/", "Sweep/"}, {reduced, no_sweep, no_sliding, undamped, one_mu, {"Designs/Number", "Designs/Seed", "Designs/File"}}},
    {joined(design, {"Designs/Plan=Sobol sequence", steady}),
     {"Designs/", "Sweep/"},
     {reduced, no_sweep, one_mu, {"Designs/File", "Operation/Rotation speed"}}},
    // A search has ranges in the place of a plan
    {{"Study=search", "Designs/Variables=Geometry/Pin height=0.03 to 0.04"},
     {"Designs/", "Search/", "Sweep/"},
     {reduced, no_sweep, no_sliding, undamped, one_mu, {"Designs/Plan", "Designs/Number", "Designs/File"}}}};
  for (const Usage &usage : table)
    EXPECT_EQ(unused_alone(usage.run), usage.expected()) << ::testing::PrintToString(usage.run);
}

TEST(ParameterUsage, OfGeometries)
{
  const fs::path folder = fs::temp_directory_path() / ("squeal_geometries_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const auto file = [&](const std::string &name, const std::string &text) {
    std::ofstream((folder / name).string()) << text;
    return "Geometry/File=" + (folder / name).string();
  };
  const Paths sizes = {"Geometry/Disc thickness=0.04", "Geometry/Pin diameter=0.04", "Geometry/Disc outer radius=0.32"};
  const auto  with  = [&](const std::string &geometry) { return unused(joined(sizes, {geometry})); };

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
