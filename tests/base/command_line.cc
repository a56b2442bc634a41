#include <squeal/base/command_line.h>
#include <squeal/base/exceptions.h>

#include <gtest/gtest.h>

#include <string>
#include <utility>
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

TEST(CommandLines, QuoteTheWordThatIsWrong)
{
  for (const auto &[words, wrong] :
       std::vector<std::pair<std::vector<std::string>, std::string>>{{{"a", "--set", "x=1", "--sett", "y"}, "--sett"},
                                                                     {{"-x", "a"}, "-x"},
                                                                     {{"a", "--set"}, "--set"},
                                                                     {{"--set", "--dry-run", "a"}, "--set"},
                                                                     {{"--help=yes"}, "--help=yes"},
                                                                     {{"a", "--help", "b"}, "b"}})
    try
      {
        parse_command_line(words);
        FAIL() << wrong;
      }
    catch (const ParameterError &error)
      {
        EXPECT_NE(std::string(error.what()).find("`" + wrong + "`"), std::string::npos) << error.what();
      }
}
