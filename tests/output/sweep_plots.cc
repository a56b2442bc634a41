#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/studies/sweep_plots.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace Squeal;

namespace
{
  using Complex = std::complex<double>;
  using Style   = PlotSeries::Style;

  constexpr double band = 100.;

  /// Two branches that coalesce at 0.25, a third that is absent at 0.2, and one beyond the band.
  ChartLine example()
  {
    ChartLine line;
    line.title  = "without";
    line.labels = {"A0-4 -", "A0-4 +", "F1", "F2"};
    line.chart.branches.resize(4);
    for (int k = 0; k <= 4; ++k)
      {
        const double mu = 0.1 * k, root = std::sqrt(std::abs(0.25 - mu));
        ChartPoint   point;
        point.friction_coefficient = mu;
        if (mu < 0.25)
          point.lambda = {Complex(0., 10. - root), Complex(0., 10. + root)};
        else
          point.lambda = {Complex(-root, 10.), Complex(root, 10.)};
        line.chart.branches[0].modes.push_back(mu < 0.25 ? 0 : 1);
        line.chart.branches[1].modes.push_back(mu < 0.25 ? 1 : 0);
        line.chart.branches[2].modes.push_back(k == 2 ? -1 : static_cast<int>(point.lambda.size()));
        if (k != 2)
          point.lambda.emplace_back(-1., 50.);
        line.chart.branches[3].modes.push_back(point.lambda.size());
        point.lambda.emplace_back(1., 2. * band);
        point.verdicts.assign(point.lambda.size(), Verdict::stable);
        line.chart.points.push_back(point);
      }
    Threshold threshold;
    threshold.friction_coefficient = 0.25;
    threshold.mechanism            = ThresholdMechanism::coalescence;
    threshold.branch               = 0;
    threshold.partner              = 1;
    threshold.lambda               = Complex(0., 10.);
    line.chart.thresholds          = {threshold};
    return line;
  }

  const PlotSeries &series(const PlotPanel &panel, const std::string &title)
  {
    for (const PlotSeries &candidate : panel.series)
      if (candidate.title == title)
        return candidate;
    throw std::runtime_error("no series " + title);
  }

  /// Number of points, and of parts between breaks.
  std::pair<int, int> points_and_parts(const PlotSeries &line)
  {
    int n = 0, parts = 0;
    for (std::size_t i = 0; i < line.x.size(); ++i)
      if (std::isfinite(line.x[i]))
        {
          ++n;
          parts += i == 0 || !std::isfinite(line.x[i - 1]);
        }
    return {n, parts};
  }

  StabilityMap example_map()
  {
    // Unstable from 0.2 on under the larger load alone, undecided before
    StabilityMap map{"map", {0., 0.1, 0.2, 0.3}, {100., 1000.}, "load", "N", {}};
    for (const double load : map.ordinates)
      for (const double mu : map.friction_coefficients)
        {
          MapCell cell;
          cell.friction_coefficient = mu;
          cell.value                = load;
          cell.is_known             = true;
          cell.n_unstable           = load > 500. && mu > 0.15 ? 2 : 0;
          cell.n_undecided          = load > 500. && mu > 0.05 ? 1 : 0;
          cell.divergence_rate      = cell.n_unstable > 0 ? 0.03 : 0.;
          cell.leader               = cell.n_unstable > 0 ? "F1" : "";
          map.cells.push_back(cell);
        }
    return map;
  }
} // namespace



TEST(SweepPlots, FamiliesHaveNoSigns)
{
  EXPECT_EQ(branch_family("A0-4 -"), "A0-4");
  EXPECT_EQ(branch_family("A0-4 +"), "A0-4");
  EXPECT_EQ(branch_family("A0-4"), "A0-4");
  EXPECT_EQ(branch_family("F1"), "F1");
  EXPECT_EQ(branch_family(" -"), " -");
  EXPECT_EQ(branch_family(""), "");
}



TEST(SweepPlots, CurvesBreakAndMeetAtThresholds)
{
  const Plot plot = overview_plot({example()}, band);
  ASSERT_EQ(plot.panels.size(), 2u);
  // Both branches of the pair with the threshold between their five points; the third in two parts; the last is beyond the band
  const PlotSeries &all = series(plot.panels[0], "without");
  EXPECT_EQ(points_and_parts(all), std::make_pair(6 + 6 + 4, 4));
  double highest = 0.;
  for (const double value : all.y)
    highest = std::fmax(highest, value);
  EXPECT_DOUBLE_EQ(highest, hertz(50.));

  // One branch grows, from the threshold on
  const PlotSeries &growing = series(plot.panels[1], "growing, without");
  EXPECT_EQ(points_and_parts(growing), std::make_pair(3, 1));
  EXPECT_DOUBLE_EQ(growing.x[0], 0.25);
  EXPECT_DOUBLE_EQ(growing.y[0], 0.);
  EXPECT_NEAR(growing.y[2], 100. * std::sqrt(0.15) / 10., 1e-12);
  EXPECT_NE(growing.colour, all.colour);
  EXPECT_EQ(series(plot.panels[0], "onset").x, std::vector<double>{0.25});
  EXPECT_TRUE(series(plot.panels[0], "restabilisation").x.empty());
}



TEST(SweepPlots, FamiliesThatGrow)
{
  std::vector<NamedPlot> plots = frequency_plots({example()}, band);
  ASSERT_EQ(plots.size(), 1u);
  EXPECT_EQ(plots[0].name, "sweep_families");
  ASSERT_EQ(plots[0].plot.panels.size(), 2u);
  EXPECT_EQ(plots[0].plot.panels[0].title, "A0-4");
  EXPECT_EQ(points_and_parts(series(plots[0].plot.panels[0], "without")), std::make_pair(12, 2));

  // A partner of another family belongs to the panels, in the other line, too
  ChartLine other = example(), second = example();
  other.labels[1] = second.labels[1] = "R0-1";
  second.title                       = "with";
  second.chart.thresholds.clear();
  plots = frequency_plots({other, second}, band);
  ASSERT_EQ(plots.size(), 1u);
  EXPECT_EQ(points_and_parts(series(plots[0].plot.panels[0], "without")), std::make_pair(12, 2));
  EXPECT_EQ(points_and_parts(series(plots[0].plot.panels[0], "with")), std::make_pair(10, 2));

  // With a wider band a second family grows
  plots = frequency_plots({example()}, 3. * band);
  ASSERT_EQ(plots.size(), 1u);
  ASSERT_EQ(plots[0].plot.panels.size(), 4u);
  EXPECT_EQ(plots[0].plot.panels[1].title, "F2");
}



TEST(SweepPlots, ComplexPlane)
{
  ChartLine line                   = example();
  line.chart.points[4].verdicts[2] = Verdict::undecided;
  const Plot plot                  = complex_plane_plot({line}, {0.09, 1.}, band);
  ASSERT_EQ(plot.panels.size(), 2u);
  EXPECT_EQ(series(plot.panels[0], "without").x.size(), 3u);
  EXPECT_TRUE(series(plot.panels[0], "growing").x.empty());
  // The point nearest to 1 is the last
  ASSERT_EQ(series(plot.panels[1], "growing").x.size(), 1u);
  EXPECT_NEAR(series(plot.panels[1], "growing").y[0], 100. * std::sqrt(0.15) / 10., 1e-12);
  EXPECT_EQ(series(plot.panels[1], "undecided").x.size(), 1u);
  const auto &all  = plot.panels[1].series;
  const auto  text = std::find_if(all.begin(), all.end(), [](const PlotSeries &s) { return s.style == Style::texts; });
  ASSERT_NE(text, all.end());
  EXPECT_EQ(text->labels, std::vector<std::string>{"A0-4 -"});
}



TEST(SweepPlots, NothingToShow)
{
  EXPECT_TRUE(frequency_plots({}, band).empty());
  EXPECT_EQ(overview_plot({}, band).panels.size(), 2u);
  EXPECT_EQ(complex_plane_plot({}, {0.4}, band).panels.size(), 1u);
  EXPECT_EQ(complex_plane_plot({}, {}, band).panels.size(), 1u);
  EXPECT_TRUE(frequency_plots({ChartLine()}, band).empty());
  EXPECT_EQ(complex_plane_plot({ChartLine()}, {0.4}, band).panels.size(), 1u);

  // No branch grows within a lower band
  EXPECT_TRUE(frequency_plots({example()}, 5.).empty());

  ChartLine point = example();
  point.chart.points.resize(1);
  for (Branch &branch : point.chart.branches)
    branch.modes.resize(1);
  point.chart.thresholds.clear();
  EXPECT_EQ(points_and_parts(series(overview_plot({point}, band).panels[0], "without")).first, 3);

  point.labels.pop_back();
  EXPECT_THROW(overview_plot({point}, band), Error);
}



TEST(SweepPlots, MapOfStability)
{
  StabilityMap map  = example_map();
  const Plot   plot = map_plot(map);
  ASSERT_EQ(plot.panels.size(), 2u);
  const PlotPanel &panel = plot.panels[0];
  EXPECT_DOUBLE_EQ(panel.colour_end, 3.);
  EXPECT_DOUBLE_EQ(plot.panels[1].colour_end, 2.);
  EXPECT_EQ(series(panel, "undecided").x, std::vector<double>{0.1});
  EXPECT_TRUE(series(panel, "not computed").x.empty());
  const auto cells = std::find_if(panel.series.begin(), panel.series.end(), [](const PlotSeries &s) { return !s.values.empty(); });
  ASSERT_NE(cells, panel.series.end());
  EXPECT_EQ(cells->values, (std::vector<double>{3., 3.}));
  EXPECT_NEAR(cells->cells[0].left, 0.15, 1e-12);
  EXPECT_NEAR(cells->cells[0].low, std::sqrt(1e5), 1e-9);
  EXPECT_NEAR(panel.x_range.first, 0., 1e-12);

  // The limit runs up beside one cell and along below two
  EXPECT_EQ(points_and_parts(series(panel, "limit of stability")), std::make_pair(2 + 3, 2));
  EXPECT_TRUE(series(panel, "change of the contact set").x.empty());
  map.cells[0].n_open = 4;
  EXPECT_EQ(points_and_parts(series(map_plot(map).panels[0], "change of the contact set")), std::make_pair(2 + 2, 2));
  map.cells[0].is_known = false;
  EXPECT_TRUE(series(map_plot(map).panels[0], "change of the contact set").x.empty());
  EXPECT_EQ(panel.series.back().labels, std::vector<std::string>{"F1"});

  map.ordinates = {1000., 100.};
  EXPECT_THROW(map_plot(map), Error);
  map = example_map();
  map.cells.pop_back();
  EXPECT_THROW(map_plot(map), Error);
  const StabilityMap one{"one cell", {0.4}, {1000.}, "load", "N", {MapCell()}};
  EXPECT_EQ(map_plot(one).panels.size(), 2u);
}
