// SPDX-License-Identifier: GPL-3.0-or-later

#include "scenes.h"

#include <squeal/geometry/mesher.h>

using namespace Scenes;

namespace
{
  const MesherLimits wide{60., 4e9, true};
  const std::string  script = blocks("Physical Volume(\"disc\") = {1};");

  GmshMesh mesh_of(const File &file, const MesherLimits &limits = wide)
  {
    return run_mesher({file.string(), "", {}}, "here", limits);
  }
} // namespace

TEST(Mesher, HandsOverWhatGmshHolds)
{
  const GmshMesh mesh = mesh_of(File("blocks.geo", script));
  EXPECT_EQ(mesh.dimension(), 3);
  EXPECT_EQ(mesh.points.size(), 54u);
  ASSERT_EQ(mesh.groups.size(), 1u);
  EXPECT_EQ(mesh.groups[0].name, "disc");
  ASSERT_EQ(mesh.groups[0].elements.size(), 1u);
  EXPECT_EQ(mesh.groups[0].elements.begin()->first, "Hexahedron 8");
  ASSERT_EQ(mesh.groups[0].elements.begin()->second.size(), 8u);
  EXPECT_EQ(mesh.groups[0].elements.begin()->second[0].nodes.size(), 8u);

  // Truncated bytes are rejected
  const std::string bytes = to_bytes(mesh);
  EXPECT_EQ(to_bytes(from_bytes(bytes)), bytes);
  for (const std::size_t n : {std::size_t(0), std::size_t(7), bytes.size() / 2, bytes.size() - 1})
    EXPECT_THROW(from_bytes(bytes.substr(0, n)), std::length_error);
}

TEST(Mesher, ReadsAScriptFromMemoryWithNumbersOfItsOwn)
{
  std::string sized = "size = DefineNumber[ 1, Name \"Parameters/Size\" ];\n" + script;
  sized.replace(sized.find("0.25}"), 5, "size - 0.5}");
  double height = 0.;
  for (const auto &point : run_mesher({"", sized, {{"Parameters/Size", 2.5}}}, "here", wide).points)
    height = std::max(height, point[2]);
  EXPECT_EQ(height, 2.5);
}

TEST(Mesher, ConfinesGmsh)
{
  const auto attempt = [](const std::string &statement) {
    return message<ForbiddenAction>([&] { mesh_of(File("script.geo", "Point(1) = {0, 0, 0};\n" + statement)); });
  };
  for (const std::string statement : {"SystemCall \"true\";", "NonBlockingSystemCall \"true\";", "Printf(\"x\") > \"trace\";",
                                      "Save \"trace.msh\";", "CreateDir \"trace\";"})
    expect_mentions(attempt(statement), {"starts a program, changes files or opens a connection"});

  // System calls run if allowed
  const File file("script.geo", "");
  const auto trace = file.directory / "trace";
  std::ofstream(file.path) << "SystemCall \"touch " << trace.string() << "\";\n" << script;
  EXPECT_EQ(mesh_of(file, {60., 4e9, false}).points.size(), 54u);
  EXPECT_TRUE(std::filesystem::exists(trace));
}

TEST(Mesher, SurvivesWhatHappensToGmsh)
{
  const auto failure = [](const std::string &text, const MesherLimits &limits) {
    return message<MeshError>([&] { mesh_of(File("script.geo", text), limits); });
  };
  expect_mentions(failure("Exit;", wide), {"Gmsh ended", "here"});
  std::string errors;
  for (int i = 0; i < 100; ++i)
    errors += "foo bar;\n";
  expect_mentions(failure(errors, wide), {"line 1", "'foo'"});
  expect_mentions(failure("For i In {1 : 1000000000}\n  a = i;\nEndFor\n", {1., 4e9, true}),
                  {"did not finish within 1 s", "Meshing time limit"});
#if !defined(__SANITIZE_ADDRESS__) // the address sanitizer allows no memory limit
  expect_mentions(failure("l() = {1 : 100000000}; m() = {l(), l()};", {60., 1e9, true}), {"more than 1 GB", "Meshing memory limit"});
#endif
}
