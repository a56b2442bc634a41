// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/text.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

using namespace Squeal;

TEST(Text, ExactNumbersReadBack)
{
  for (const double value : {0.1, 1. / 3., 1e-300, -7850., 0.31550001, 5000.})
    EXPECT_EQ(std::stod(exact_text(value)), value);
  EXPECT_EQ(exact_text(-0.), "0");
  EXPECT_EQ(exact_text(0.0463), "0.0463");
}

TEST(Text, DecimalNumbersKeepTheirDigits)
{
  EXPECT_EQ(decimal_text(0.0067704, 3), "0.00677");
  EXPECT_EQ(decimal_text(-54000.3), "-54000");
  EXPECT_EQ(decimal_text(-0., 1), "0");
}

TEST(Text, CountsAgreeWithTheirNouns)
{
  EXPECT_EQ(counted(1, "node"), "1 node");
  EXPECT_EQ(counted(0, "node"), "0 nodes");
  EXPECT_EQ(counted(2, "branch", "branches"), "2 branches");
}

TEST(Text, NumbersAreParsedAsAWhole)
{
  EXPECT_EQ(parse_number(" 1.5e3 "), 1500.);
  EXPECT_FALSE(std::signbit(parse_number("-0").value()));
  for (const char *text : {"", " ", "1 %", "0,4", "nan", "inf", "1e999", "three", "0x10", "--1"})
    EXPECT_FALSE(parse_number(text)) << text;
}

TEST(Text, CommandsAreQuotedForAShell)
{
  EXPECT_EQ(shell_command({"squeal", "prm/sweep.prm", "--set", "Geometry/Element size=0.04"}),
            "squeal prm/sweep.prm --set 'Geometry/Element size=0.04'");
  // A shell must split the quoted command into the original words
  const std::vector<std::string> words   = {"a b", "",  "$HOME",     "`id`", "it's", "\"",         "\\",
                                            "*",   "~", "a;b|c&d>e", "!x",   "#",    "two\nlines", "\u00b5"};
  const std::string              command = "printf '%s\\0' " + shell_command(words);
  FILE *const                    shell   = ::popen(command.c_str(), "r");
  ASSERT_NE(shell, nullptr);
  std::string printed, expected;
  for (int byte = std::fgetc(shell); byte != EOF; byte = std::fgetc(shell))
    printed += static_cast<char>(byte);
  EXPECT_EQ(::pclose(shell), 0);
  for (const std::string &word : words)
    expected += word + '\0';
  EXPECT_EQ(printed, expected);
}
