// SPDX-License-Identifier: GPL-3.0-or-later

#include "files.h"

#include <squeal/base/exceptions.h>
#include <squeal/parameters/geometry_file.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  class GeometryFiles : public testing::Test
  {
  protected:
    std::string write(const std::string &name, const std::string &text) const
    {
      put(folder.path / name, text);
      return (folder.path / name).string();
    }

    const TemporaryFolder folder;
  };
} // namespace

TEST_F(GeometryFiles, VariablesAreThoseThatOthersMaySet)
{
  write("part.geo", "DefineConstant[ inner = 3 ];");
  const GeometryScript script(write("own.geo", R"(
    // DefineConstant[ no = 1 ];
    /* DefineConstant[ neither = 1 ]; */
    DefineConstant[
      a = 0.15, b = {2 * Pi / 3, Min 0, Max 7, Name "Parameters/b, the angle"},
      c, text = "x", list = {{1, 2}, Name "Parameters/list"} // the last, "quoted
    ];
    h = DefineNumber[ 0.02, Name "Parameters/Height [m]" ];
    other = 3;
    Include "part.geo";
  )"));
  std::string          found;
  for (const GeometryVariable &variable : script.variables())
    found += variable.name + " = " + variable.value + " (" + variable.onelab_name + "); ";
  EXPECT_EQ(found, "a = 0.15 (); b = 2 * Pi / 3 (); c = 0 (); h = 0.02 (Parameters/Height [m]); inner = 3 (); ");
}

TEST_F(GeometryFiles, StatementsAreFoundInIncludedFilesButNotInComments)
{
  const std::string    part = write("part.geo", "a = 1;\n  SystemCall \"x\";\n");
  const GeometryScript script(write("own.geo", "// SystemCall\nInclude \"part.geo\";\nInclude \"own.geo\";\n"));
  EXPECT_EQ(script.find({"SystemCall"}).value_or(""), part + ", line 2: SystemCall \"x\";");
  EXPECT_FALSE(script.find({"Save"}));
}

TEST_F(GeometryFiles, AreLookedForBesideTheParameterFileFirst)
{
  const auto beside = write("apart/disc_pad.geo", "");
  EXPECT_EQ(find_geometry("disc_pad.geo", (folder.path / "apart").string()), beside);
  EXPECT_TRUE(is_supplied(find_geometry("disc_pad.geo", folder.path.string())));
  EXPECT_FALSE(is_supplied(beside));
  EXPECT_EQ(find_geometry("apart/disc_pad.geo", folder.path.string()), beside);
  EXPECT_THROW(find_geometry("missing/disc_pad.geo", folder.path.string()), MeshError);
}

TEST_F(GeometryFiles, CopiesHoldWhatIsIncluded)
{
  write("parts/part.geo", "");
  write("shape.step", "");
  const std::string  own  = write("own.geo", "Include \"parts/part.geo\"; Merge \"shape.step\"; Merge \"missing.step\";");
  const GeometryCopy copy = copy_of(own);
  EXPECT_EQ(copy.name, "geometry/own.geo");
  std::string names;
  for (const GeometryCopy::File &file : copy.files)
    names += file.to + " ";
  EXPECT_EQ(names, "geometry/own.geo geometry/parts/part.geo geometry/shape.step ");

  // A script that includes files outside its folder is not copied
  const std::string inner = write("inner/own.geo", "Include \"../parts/part.geo\";");
  EXPECT_EQ(copy_of(inner).name, inner);
  EXPECT_TRUE(copy_of(find_geometry("disc_pins.geo", "")).files.empty());
}
