// SPDX-License-Identifier: GPL-3.0-or-later

#include "files.h"
#include "input.h"

#include <squeal/base/exceptions.h>
#include <squeal/parameters/parameter_file.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  class ParameterFile : public testing::Test
  {
  protected:
    std::string write(const std::string &name, const std::string &text) const
    {
      put(folder.path / name, text);
      return (folder.path / name).string();
    }

    /// "path=value" of every statement.
    static std::vector<std::string> statements(const std::string &file)
    {
      std::vector<std::string> result;
      for (const ParameterStatement &statement : read_parameter_file(file))
        result.push_back(statement.path + (statement.is_section() ? "" : "=" + statement.value));
      return result;
    }

    static void expect_refusal(const std::string &file, const std::vector<std::string> &mentions)
    {
      expect_mentions(message<Error>([&] { read_parameter_file(file); }), mentions);
    }

    const TemporaryFolder folder;
  };

  using Statements = std::vector<std::string>;
} // namespace

TEST_F(ParameterFile, StatementsComeInTheirOrder)
{
  const std::string text =
    "# comment\nset Study = sweep # why\nsubsection  A  B\n\tset  c   d =  1, \\\n  2\nend\nSUBSECTION E\nSET f =\nEND\n";
  EXPECT_EQ(statements(write("a.prm", text)), (Statements{"Study=sweep", "A B/", "A B/c d=1, 2", "E/", "E/f="}));
  EXPECT_EQ(statements(write("empty.prm", "")), Statements());
  EXPECT_EQ(statements(write("no_end_of_line.prm", "set a = b=c")), Statements{"a=b=c"});
  const auto read = read_parameter_file((folder.path / "a.prm").string());
  EXPECT_NE(read[2].where.find("a.prm, line 4"), std::string::npos) << read[2].where;
  // Byte order mark and CRLF line ends
  EXPECT_EQ(statements(write("a.prm", "\xEF\xBB\xBFset a = 1\r\nset b = 2\r\n")), (Statements{"a=1", "b=2"}));
}

TEST_F(ParameterFile, IncludesAreFollowed)
{
  write("below/inner.prm", "subsection C\nset d = 2\nend\n");
  write("below/outer.prm", "include inner.prm\n"); // found in the folder of the including file
  EXPECT_EQ(statements(write("a.prm", "subsection B\ninclude below/outer.prm\nset e = 3\nend\n")),
            (Statements{"B/", "B/C/", "B/C/d=2", "B/e=3"}));
  // Including a file twice is not a cycle
  EXPECT_EQ(statements(write("twice.prm", "include below/inner.prm\ninclude below/inner.prm\n")).size(), 4u);
  expect_refusal(write("missing.prm", "\ninclude nothing.prm\n"), {"cannot be read", "missing.prm, line 2, which includes `nothing.prm`"});
  write("below/open.prm", "subsection A\n");
  expect_refusal(write("b.prm", "include below/open.prm\nend\n"), {"section `A` is not closed"});
  write("below/end.prm", "end\n");
  expect_refusal(write("b.prm", "subsection A\ninclude below/end.prm\n"), {"`end` closes no section"});
}

TEST_F(ParameterFile, FilesThatIncludeThemselvesAreNamed)
{
  expect_refusal(write("self.prm", "include self.prm\n"), {"a parameter file includes itself: ", "self.prm, line 1"});
  const std::string a = write("a.prm", "include b.prm\n"), b = write("b.prm", "\ninclude c.prm\n"), c = write("c.prm", "include ./b.prm\n");
  // The cycle consists of b and c only
  expect_refusal(a, {"includes itself: " + b + " -> " + c + " -> " + b, "c.prm, line 1"});
}

TEST_F(ParameterFile, FilesThatMultiplyEndSoon)
{
  // Each file includes the next one twice
  for (int i = 0; i < 40; ++i)
    {
      const std::string next = "include " + std::to_string(i + 1) + ".prm\n";
      write(std::to_string(i) + ".prm", next + next);
    }
  expect_refusal(write("40.prm", "include 0.prm\n"), {"includes itself"});
  write("40.prm", "");
  expect_refusal((folder.path / "0.prm").string(), {"more than 1000 parameter files"});
}

TEST_F(ParameterFile, SectionsThatAreNeverClosedEndSoon)
{
  std::string text;
  for (int i = 0; i < 100000; ++i)
    text += "subsection A\n";
  expect_refusal(write("a.prm", text), {"more than 100 sections", "line 101"});
}

TEST_F(ParameterFile, WhatIsNoParameterFileIsRefused)
{
  expect_refusal("/dev/zero", {"larger than 16777216 bytes"});
  expect_refusal(write("a.prm", std::string("\xFF\xFEs\0e\0t\0", 8)), {"encoded as UTF-16"});
  expect_refusal(write("a.prm", std::string("\xFE\xFF\0s\0e\0t", 8)), {"encoded as UTF-16"});
  expect_refusal(write("a.prm", std::string("set a = 1\nset b\0 = 2\n", 21)), {"zero byte", "line 2"});
  expect_refusal(folder.path.string(), {"is a directory"});
  expect_refusal((folder.path / "none.prm").string(), {"cannot be read"});
  expect_refusal(write("a.prm", "end\n"), {"`end` closes no section"});
  expect_refusal(write("a.prm", "subsection A\n\nset b = 1\n"), {"a.prm, line 1"});
  expect_refusal(write("a.prm", "set b\n"), {"`set b` has no `=`"});
  expect_refusal(write("a.prm", "friction = 3\n"), {"`friction = 3` is not a valid line of a parameter file"});
  expect_refusal(write("a.prm", "subsection A\nend of it\n"), {"`end of it` is not a valid line"});
}

TEST_F(ParameterFile, ValuesBetweenQuotesAreTakenAsTheyAre)
{
  EXPECT_EQ(statements(write("a.prm", "set a = \"plate #2.geo\" # why\nset b=\" x \"\nset c = \"\"\nset d = \"a\\\\b \\\"c\\\" \\n\"\n"
                                      "set e = no \"quotes\"\nset f = \"one, \\\n two\"\n")),
            (Statements{"a=plate #2.geo", "b= x ", "c=", "d=a\\b \"c\" \n", "e=no \"quotes\"", "f=one, two"}));
  write("below/part #1.prm", "set g = 1\n");
  EXPECT_EQ(statements(write("b.prm", "include \"below/part #1.prm\" # why\n")), Statements{"g=1"});
}

TEST_F(ParameterFile, WrittenValuesReadBackUnchanged)
{
  EXPECT_EQ(written_value("disc_bore: 0, 7.8e10; \"b\" \\x"), "disc_bore: 0, 7.8e10; \"b\" \\x"); // quotes are used only where needed
  const std::vector<std::string> parts = {
    "", " ", "\t", "#", "\"", "\\", "\n", "\r", "\"\"", "\\n", "\\\"", "set a = 1\nend", "\xC3\xBC", "\xFF", "$(x)", "a = b"};
  std::vector<std::string> values = parts;
  for (const std::string &first : parts)
    for (const std::string &last : parts)
      values.push_back(first + "a" + last);
  for (const std::string &value : values)
    {
      EXPECT_EQ(statements(write("a.prm", "set a = " + written_value(value) + " \r\nset b = 1 # end\n")),
                (Statements{"a=" + value, "b=1"}));
      EXPECT_EQ(read_value(written_value(value), ""), value);
    }
}

TEST_F(ParameterFile, WhatWouldCutAValueIsRefused)
{
  expect_refusal(write("a.prm", "set a = 1\nset b = plate#2.geo\n"), {"`#`", "`plate#2.geo`", "line 2"});
  EXPECT_EQ(statements(write("a.prm", "set a = 1# why\nset b = 2 #why\nset c = #why\n")), (Statements{"a=1", "b=2", "c="}));
  expect_refusal(write("a.prm", "include part#1.prm\n"), {"`part#1.prm`"});
  expect_refusal(write("a.prm", "set a = \"x # y\n"), {"`\"x # y`"});
  expect_refusal(write("a.prm", "set a = \"x\" y # z\n"), {"`\"x\" y`"});
  expect_refusal(write("a.prm", "set a = \"C:\\data\"\n"), {"`\\d`"});
}
