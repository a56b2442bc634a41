#include "scenes.h"

#include <squeal/geometry/mesher.h>

using namespace Scenes;

namespace
{
  constexpr const char *box = R"(
    SetFactory("OpenCASCADE");
    Box(1) = {0, 0, 0, 1, 1, 1};
    Transfinite Curve{:} = 3; Transfinite Surface{:}; Recombine Surface{:}; Transfinite Volume{:};
    Physical Volume("disc") = {1};
  )";

  GmshMesh mesh_of(const File &file, const MesherLimits &limits = {60., 4e9, true})
  {
    return run_mesher({file.string(), "", {}}, "here", limits);
  }
} // namespace

TEST(Mesher, HandsOverWhatGmshHolds)
{
  const File     file("box.geo", box);
  const GmshMesh mesh = mesh_of(file);
  EXPECT_EQ(mesh.dimension(), 3);
  EXPECT_EQ(mesh.points.size(), 27u);
  ASSERT_EQ(mesh.groups.size(), 1u);
  EXPECT_EQ(mesh.groups[0].name, "disc");
  ASSERT_EQ(mesh.groups[0].elements.size(), 1u);
  EXPECT_EQ(mesh.groups[0].elements.begin()->first, "Hexahedron 8");
  ASSERT_EQ(mesh.groups[0].elements.begin()->second.size(), 8u);
  EXPECT_EQ(mesh.groups[0].elements.begin()->second[0].nodes.size(), 8u);

  // The same through bytes again, which must be complete
  const std::string bytes = to_bytes(mesh);
  EXPECT_EQ(to_bytes(from_bytes(bytes)), bytes);
  for (const std::size_t n : {std::size_t(0), std::size_t(7), bytes.size() / 2, bytes.size() - 1})
    EXPECT_THROW(from_bytes(bytes.substr(0, n)), std::length_error);
}

TEST(Mesher, ReadsAScriptFromMemoryWithNumbersOfItsOwn)
{
  std::string script = "size = DefineNumber[ 1, Name \"Parameters/Size\" ];\n" + std::string(box);
  script.replace(script.find("1, 1, 1}"), 8, "1, 1, size}");
  double height = 0.;
  for (const auto &point : run_mesher({"", script, {{"Parameters/Size", 2.5}}}, "here", {60., 4e9, true}).points)
    height = std::max(height, point[2]);
  EXPECT_EQ(height, 2.5);
}

TEST(Mesher, ConfinesGmsh)
{
  const auto attempt = [](const std::string &statement) {
    const File file("script.geo", "Point(1) = {0, 0, 0};\n" + statement);
    return message<ForbiddenAction>([&] { mesh_of(file); });
  };
  for (const char *statement : {"SystemCall \"true\";", "NonBlockingSystemCall \"true\";", "Printf(\"x\") > \"trace\";",
                                "Save \"trace.msh\";", "CreateDir \"trace\";"})
    expect_mentions(attempt(statement), {"starts a program, writes a file or opens a connection"});
}

TEST(Mesher, LetsGmshGoWhereAllowed)
{
  const File file("script.geo", "");
  const auto trace = file.directory / "trace";
  std::ofstream(file.path) << "SystemCall \"touch " << trace.string() << "\";\n" << box;
  EXPECT_EQ(mesh_of(file, {60., 4e9, false}).points.size(), 27u);
  EXPECT_TRUE(std::filesystem::exists(trace));
}

TEST(Mesher, SurvivesWhatHappensToGmsh)
{
  const auto failure = [](const std::string &text, const MesherLimits &limits) {
    const File file("script.geo", text);
    return message<MeshError>([&] { mesh_of(file, limits); });
  };
  const MesherLimits wide{60., 4e9, true};
  expect_mentions(failure("Exit;", wide), {"ended Gmsh", "here"});
  std::string errors;
  for (int i = 0; i < 100; ++i)
    errors += "foo bar;\n";
  expect_mentions(failure(errors, wide), {"line 1", "'foo'"});
  expect_mentions(failure("For i In {1 : 1000000000}\n  a = i;\nEndFor\n", {1., 4e9, true}),
                  {"did not finish within 1 s", "Meshing time limit"});
#if !defined(__SANITIZE_ADDRESS__) // with which there is no limit
  expect_mentions(failure("l() = {1 : 100000000}; m() = {l(), l()};", {60., 1e9, true}), {"more than 1 GB", "Meshing memory limit"});
#endif
}
