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
