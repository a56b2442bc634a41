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
  EXPECT_EQ(decimal_text(3569.05), "3569");
  EXPECT_EQ(decimal_text(12345.6), "12346");
  EXPECT_EQ(decimal_text(354.26), "354.3");
  EXPECT_EQ(decimal_text(6.54321), "6.543");
  EXPECT_EQ(decimal_text(0.0067704, 3), "0.00677");
  EXPECT_EQ(decimal_text(-54000.3), "-54000");
  EXPECT_EQ(decimal_text(0.), "0.000");
  EXPECT_EQ(decimal_text(-0., 1), "0");
}

TEST(Text, NumbersAreParsedAsAWhole)
{
  EXPECT_EQ(parse_number(" 1.5e3 "), 1500.);
  EXPECT_FALSE(std::signbit(parse_number("-0").value()));
  for (const char *text : {"", " ", "1 %", "0,4", "nan", "inf", "1e999", "three", "0x10", "--1"})
    EXPECT_FALSE(parse_number(text)) << text;
}

TEST(Text, LongAndInvisibleTextsAreMadeLegible)
{
  EXPECT_EQ(in_quotes("short"), "`short`");
  EXPECT_EQ(legible(std::string("a\0b\n\033[1m", 8)), "a?b??[1m");
  EXPECT_EQ(legible(std::string(81, 'x')), std::string(80, 'x') + "... (81 characters)");
  // Not through the two bytes of a letter
  EXPECT_EQ(legible(std::string(79, 'x') + "\u00b5m"), std::string(79, 'x') + "... (82 characters)");
  EXPECT_EQ(single_spaced(" a \t b\n"), "a b");
}

TEST(Text, CommandsAreQuotedForAShell)
{
  EXPECT_EQ(shell_command({"squeal", "prm/sweep.prm", "--set", "Geometry/Element size=0.04"}),
            "squeal prm/sweep.prm --set 'Geometry/Element size=0.04'");
  EXPECT_EQ(shell_command({"it's"}), R"('it'\''s')");
  EXPECT_EQ(shell_command({"a", ""}), "a ''");

  // What a shell makes of it
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

TEST(Text, TheFirstDifferenceIsNamed)
{
  EXPECT_EQ(first_difference("a\n  b = 1\nc", "a\n  b = 2\nd"), "`b = 1` there, `b = 2` here");
  EXPECT_EQ(first_difference("a\nb\n", "a\n"), "`b` there, nothing here");
  EXPECT_EQ(first_difference("a\n", "a\nb\n"), "nothing there, `b` here");
  EXPECT_EQ(first_difference("a\n\n", "a\nb\n"), "nothing there, `b` here");
}
