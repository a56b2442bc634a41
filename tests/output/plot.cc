#include <squeal/base/exceptions.h>
#include <squeal/output/plot.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

using namespace Squeal;
namespace fs = std::filesystem;

namespace
{
  std::string content(const fs::path &file)
  {
    std::ifstream     stream(file);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
  }

  unsigned int n_lines_of_data(const std::string &text)
  {
    std::istringstream stream(text);
    unsigned int       n = 0;
    for (std::string line; std::getline(stream, line);)
      n += !line.empty() && line[0] != '#';
    return n;
  }
} // namespace



TEST(Plots, DataScriptAndPicture)
{
  // A name that a shell would take apart
  const fs::path base = fs::temp_directory_path() / "squeal plot's test";
  fs::remove_all(base);
  {
    ResultFolder folder(base.string(), true);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Plot         plot{"Two panels", {}, 2};
    plot.panels.push_back({"marks", "", "error", false, true, {"res", "mac"}, {{"a \"quoted\" basis", {1., 2.}, {1e-3, 0.}}, {"", {1.}, {nan}}}});
    plot.panels.push_back({"lines", "mu", "Hz", false, false, {}, {{"branch", {0., 1., 2.}, {-1., nan, 4.}, PlotSeries::Style::lines, 2, 0}}});
    plot.panels.push_back({"nothing to show", "x", "y", true, true, {}, {{"negative", {-1.}, {-2.}}}});
    const bool is_drawn = write_plot("test", plot, folder);
    EXPECT_EQ(is_drawn, std::system("gnuplot --version >/dev/null 2>&1") == 0);
    folder.commit();
    EXPECT_EQ(fs::exists(base / "plots" / "test.svg"), is_drawn);
  }

  // Zero on a logarithmic axis and what is no number are left out
  const std::string data = content(base / "plots" / "test.dat");
  EXPECT_EQ(n_lines_of_data(data), 3u);
  EXPECT_EQ(data.find("nan"), std::string::npos);
  const std::string script = content(base / "plots" / "test.gp");
  EXPECT_NE(script.find("\\\"quoted\\\""), std::string::npos);
  if (fs::exists(base / "plots" / "test.svg"))
    {
      const std::string picture = content(base / "plots" / "test.svg");
      for (const char *text : {"Two panels", "marks", "lines", "nothing to show", "branch", "quoted"})
        EXPECT_NE(picture.find(text), std::string::npos) << text;
    }
  fs::remove_all(base);
}



TEST(Plots, CellsTextsAndBrokenLines)
{
  const fs::path base = fs::temp_directory_path() / "squeal plot of cells";
  fs::remove_all(base);
  {
    ResultFolder folder(base.string(), true);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    PlotPanel    panel{"map", "mu", "load [N]", false, true, {}, {}, {0., 3.}, {1., 100.}, {1., 10., 100.}};
    panel.colour_label = "rate [%]";
    panel.colour_end   = 5.;
    PlotSeries cells{"", {0.5, 1.5}, {3., 3.}, PlotSeries::Style::cells};
    cells.cells  = {{0., 1., 1., 10.}, {1., 2., 1., 10.}};
    cells.values = {1., 4.};
    PlotSeries texts{"", {0.5}, {3.}, PlotSeries::Style::texts};
    texts.labels = {"A0-4 -"};
    PlotSeries line{"limit", {nan, 0., 1., nan, nan, 2., 3., nan}, {nan, 1., 1., nan, nan, 2., 2., nan}, PlotSeries::Style::lines};
    line.dashed    = true;
    line.key_place = 1;
    PlotSeries mark{"first in the key", {1.}, {50.}};
    panel.series = {cells, texts, line, mark};
    EXPECT_EQ(write_plot("cells", {"Cells", {panel}, 1}, folder), std::system("gnuplot --version >/dev/null 2>&1") == 0);

    // What some points have all must have
    panel.series[0].cells.pop_back();
    EXPECT_THROW(write_plot("bad", {"Cells", {panel}, 1}, folder), Error);
    panel.series[0] = texts;
    panel.series[0].labels.clear();
    EXPECT_THROW(write_plot("bad", {"Cells", {panel}, 1}, folder), Error);
    folder.commit();
  }
  const std::string data = content(base / "plots" / "cells.dat");
  EXPECT_EQ(n_lines_of_data(data), 2u + 1u + 4u + 1u);
  EXPECT_NE(data.find("0.5 3 0 1 1 10 1\n"), std::string::npos);
  // One empty line between the parts of the line, two at its end
  EXPECT_NE(data.find("0 1\n1 1\n\n2 2\n3 2\n\n\n"), std::string::npos);
  const std::string script = content(base / "plots" / "cells.gp");
  EXPECT_NE(script.find("set cbrange [0:5]"), std::string::npos);
  EXPECT_LT(script.find("set label 1 \"first in the key\""), script.find("set label 2 \"limit\""));
  if (fs::exists(base / "plots" / "cells.svg"))
    {
      const std::string picture = content(base / "plots" / "cells.svg");
      for (const char *text : {"rate [%]", "A0-4 -", "limit"})
        EXPECT_NE(picture.find(text), std::string::npos) << text;
    }
  fs::remove_all(base);
}
