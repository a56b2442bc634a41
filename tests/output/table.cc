// SPDX-License-Identifier: GPL-3.0-or-later

#include "faces.h"

#include <squeal/output/table.h>

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <sstream>

using namespace Squeal;
using namespace Squeal::Testing;

TEST(Tables, TwelveDigitsAndUnitsOnDisk)
{
  struct Row
  {
    std::string           label;
    double                frequency, share;
    int                   number;
    std::optional<double> rest;
  };
  const Table        table(Columns<Row>{{"label", "", &Row::label},
                                        {"frequency", "Hz", &Row::frequency, 2},
                                        {"share", "-", [](const Row &row) { return row.share; }},
                                        {"number", "-", &Row::number},
                                        {"rest", "1/s", &Row::rest, 1, true}},
                           std::vector<Row>{{"A0-2 -", 1000. / 3., 1e-20, 42, {}}, {"a,\"b\"", -0., 2.5, -1, 1.}});
  std::ostringstream csv, screen;
  table.write_csv(csv);
  EXPECT_EQ(csv.str(), "label,frequency [Hz],share [-],number [-],rest [1/s]\n"
                       "A0-2 -,333.333333333,1e-20,42,\n"
                       "\"a,\"\"b\"\"\",0,2.5,-1,1\n");
  // On the screen, all lines have the same width
  table.print(screen);
  std::istringstream         lines(screen.str());
  std::multiset<std::size_t> widths;
  for (std::string line; std::getline(lines, line);)
    widths.insert(line.size());
  EXPECT_EQ(widths.size(), 3u);
  EXPECT_EQ(widths.count(*widths.begin()), 3u) << screen.str();
  EXPECT_NE(screen.str().find("333.33 "), std::string::npos) << screen.str();
  EXPECT_EQ(screen.str().find("-0.00"), std::string::npos) << screen.str();
}

TEST(Tables, RefuseWhatIsNotANumber)
{
  const Columns<double> columns = {{"label", "", [](double) { return "A0-2"; }},
                                   {"growth rate", "1/s", [](const double rate) { return rate; }}};
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    expect_refusal([&] { Table(columns, std::vector<double>{1., value}); }, {"growth rate [1/s]"});
}
