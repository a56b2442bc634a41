// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/command_line.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

using namespace Squeal;

TEST(CommandLines, AreTakenInAnyOrder)
{
  const CommandLine line = parse_command_line({"--set", "A/b=1", "scene.prm", "--output=--odd", "--dry-run", "--set=C/d=-2"});
  EXPECT_EQ(line.parameter_file, "scene.prm");
  EXPECT_EQ(line.overrides, (std::vector<std::string>{"A/b=1", "C/d=-2"}));
  EXPECT_EQ(line.output, "--odd");
  EXPECT_TRUE(line.dry_run);
  EXPECT_FALSE(line.help || line.version || line.print_parameters);
  EXPECT_TRUE(parse_command_line({"-h"}).help);
  EXPECT_EQ(parse_command_line({"--output", "", "--", "--help"}).parameter_file, "--help");
  EXPECT_FALSE(parse_command_line({}).output);
}
