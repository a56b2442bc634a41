#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/bases/mode_labels.h>
#include <squeal/studies/sweep_plots.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <utility>

namespace Squeal
{
  namespace
  {
    using Side  = PlotSeries::Side;
    using Style = PlotSeries::Style;

    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

    /// Colours of the plot's palette for each line, and for its growing parts.
    constexpr int line_colours[] = {0, 1, 2, 4}, growing_colours[] = {3, 6, 7, 5}, n_line_colours = 4;

    /// Of the plot's markers.
    constexpr int disc = 0, ring = 5, square = 6, triangle_down = 3, open_triangle = 7, open_triangle_down = 8;

    constexpr int families_per_plot = 3;

    std::string number(const double value)
    {
      std::ostringstream stream;
      stream << value;
      return stream.str();
    }

    void check(const std::vector<ChartLine> &lines)
    {
      for (const ChartLine &line : lines)
        if (line.labels.size() != line.chart.branches.size())
          throw Error(std::to_string(line.labels.size()) + " labels for " + std::to_string(line.chart.branches.size()) + " branches",
                      "plots of `" + line.title + "`", "give one label for each branch");
    }

    /// The friction coefficients of all lines.
    PlotRange friction_range(const std::vector<ChartLine> &lines)
    {
      PlotRange range;
      for (const ChartLine &line : lines)
        for (const ChartPoint &point : line.chart.points)
          {
            range.first = std::fmin(range.first, point.friction_coefficient);
            range.last  = std::fmax(range.last, point.friction_coefficient);
          }
      return range;
    }

    /// A point of a branch.
    struct CurvePoint
    {
      double               mu;
      std::complex<double> lambda;
      bool                 is_shown, grows; ///< whether it is in the band; whether it grows
    };

    /// A branch from point to point, with the thresholds at which it begins or ceases to grow, or to decay.
    std::vector<CurvePoint> curve(const StabilityChart &chart, const int branch, const double largest_frequency)
    {
      std::vector<CurvePoint> result;
      std::size_t             t = 0;
      for (std::size_t k = 0; k < chart.points.size(); ++k)
        {
          const ChartPoint &point = chart.points[k];
          for (; t < chart.thresholds.size() && chart.thresholds[t].friction_coefficient <= point.friction_coefficient; ++t)
            if (chart.thresholds[t].branch == branch || chart.thresholds[t].partner == branch)
              result.push_back({chart.thresholds[t].friction_coefficient, chart.thresholds[t].lambda,
                                chart.thresholds[t].lambda.imag() <= largest_frequency, false});
          const int mode = chart.branches[branch].modes.at(k);
          if (mode < 0)
            result.push_back({point.friction_coefficient, {}, false, false});
          else
            {
              const std::complex<double> lambda = point.lambda.at(mode);
              result.push_back({point.friction_coefficient, lambda, lambda.imag() <= largest_frequency, is_growing(lambda)});
            }
        }
      return result;
    }

    bool grows_somewhere(const std::vector<CurvePoint> &curve)
    {
      return std::any_of(curve.begin(), curve.end(), [](const CurvePoint &point) { return point.is_shown && point.grows; });
    }

    using Quantity = std::function<double(const std::complex<double> &)>;

    double frequency(const std::complex<double> &lambda)
    {
      return modal_quantities(lambda).frequency;
    }

    double divergence(const std::complex<double> &lambda)
    {
      return 100. * modal_quantities(lambda).divergence_rate;
    }

    void append(PlotSeries &series, const double x, const double y)
    {
      series.x.push_back(x);
      series.y.push_back(y);
    }

    void end_line(PlotSeries &series)
    {
      if (!series.x.empty() && std::isfinite(series.x.back()))
        append(series, nothing, nothing);
    }

    /// Curves of some branches of one line, their growing parts and their thresholds.
    void add_curves(PlotPanel              &panel,
                    const ChartLine        &line,
                    const int               line_number,
                    const std::vector<int> &branches,
                    const double            largest_frequency,
                    const Quantity         &quantity,
                    const double            width)
    {
      const int  colour = line_colours[line_number % n_line_colours];
      PlotSeries all{line.title, {}, {}, Style::lines, colour}, growing{"growing, " + line.title, {}, {}, Style::lines, growing_colours[line_number % n_line_colours]};
      all.size     = 0.6 * width;
      growing.size = 1.6 * width;
      // A line needs two points
      if (line.chart.points.size() == 1)
        {
          all.style = growing.style = Style::dots;
          all.size                  = 1.6;
          growing.size              = 2.4;
        }
      all.key_place = growing.key_place = line_number;
      for (const int branch : branches)
        {
          const std::vector<CurvePoint> points = curve(line.chart, branch, largest_frequency);
          for (std::size_t k = 0; k < points.size(); ++k)
            {
              if (!points[k].is_shown)
                {
                  end_line(all);
                  end_line(growing);
                  continue;
                }
              const double x = points[k].mu, y = quantity(points[k].lambda);
              append(all, x, y);
              // From the threshold to the threshold, which are neutral points beside growing ones
              const bool reaches_here = points[k].grows || (k > 0 && points[k - 1].is_shown && points[k - 1].grows);
              const bool leaves_here  = k + 1 < points.size() && points[k + 1].is_shown && points[k + 1].grows;
              if (reaches_here || leaves_here)
                append(growing, x, y);
              if (!points[k].grows && !leaves_here)
                end_line(growing);
            }
          end_line(all);
          end_line(growing);
        }
      panel.series.push_back(all);
      panel.series.push_back(growing);

      const std::set<int> shown(branches.begin(), branches.end());
      for (const ThresholdEvent event : {ThresholdEvent::onset, ThresholdEvent::restabilisation})
        {
          PlotSeries marks{to_string(event), {}, {}, Style::points, colour, event == ThresholdEvent::onset ? open_triangle : open_triangle_down};
          marks.size      = 0.9 * width;
          marks.key_place = std::numeric_limits<int>::max();
          for (const Threshold &threshold : line.chart.thresholds)
            if (threshold.event == event && shown.count(threshold.branch) != 0 && threshold.lambda.imag() <= largest_frequency)
              append(marks, threshold.friction_coefficient, quantity(threshold.lambda));
          panel.series.push_back(marks);
        }
    }

    /// Names at the first point of branches, lower ones of a doublet below their curves.
    void add_names(PlotPanel &panel, const ChartLine &line, const std::vector<int> &branches, const double largest_frequency)
    {
      // A name that many branches share says no more than the title
      std::map<std::string, int> occurrences;
      for (const int branch : branches)
        ++occurrences[line.labels[branch]];
      std::vector<std::pair<double, int>> starts;
      std::map<int, double>               abscissae;
      for (const int branch : branches)
        if (occurrences[line.labels[branch]] == 1)
          for (const CurvePoint &point : curve(line.chart, branch, largest_frequency))
            if (point.is_shown)
              {
                starts.emplace_back(frequency(point.lambda), branch);
                abscissae[branch] = point.mu;
                break;
              }
      std::sort(starts.begin(), starts.end());
      PlotSeries above{"", {}, {}, Style::texts, 0}, below{"", {}, {}, Style::texts, 0};
      below.side = Side::lower_right;
      for (std::size_t i = 0; i < starts.size(); ++i)
        {
          PlotSeries &series = i == 0 && starts.size() > 1 ? below : above;
          append(series, abscissae[starts[i].second], starts[i].first);
          series.labels.push_back(line.labels[starts[i].second]);
        }
      panel.series.push_back(above);
      panel.series.push_back(below);
    }

    // ------------------------------------------------------------ complex plane

    /// Room for texts beside points of a panel, in shares of its width and height.
    class TextRoom
    {
    public:
      TextRoom(const int width, const int height)
        : character(5.5 / width)
        , line(12. / height)
      {}

      void occupy(const double x, const double y)
      {
        boxes.push_back({x - 0.9 * character, x + 0.9 * character, y - 0.5 * line, y + 0.5 * line});
      }

      /// A side of the point at which the text covers nothing; false if there is none.
      bool find(const double x, const double y, const std::string &text, Side &side)
      {
        const double length = text.size() * character;
        for (const Side candidate : {Side::upper_right, Side::lower_right, Side::upper_left, Side::lower_left})
          {
            const bool     is_right = candidate == Side::upper_right || candidate == Side::lower_right;
            const bool     is_upper = candidate == Side::upper_right || candidate == Side::upper_left;
            const PlotCell box{is_right ? x + character : x - character - length, is_right ? x + character + length : x - character,
                               is_upper ? y + 0.1 * line : y - 1.1 * line, is_upper ? y + 1.1 * line : y - 0.1 * line};
            const bool is_free = box.left > 0. && box.right < 1.02 && std::none_of(boxes.begin(), boxes.end(), [&box](const PlotCell &other) {
                                   return box.left < other.right && other.left < box.right && box.low < other.high && other.low < box.high;
                                 });
            if (is_free)
              {
                boxes.push_back(box);
                side = candidate;
                return true;
              }
          }
        return false;
      }

    private:
      double                character, line;
      std::vector<PlotCell> boxes;
    };

    /// Number of the point nearest to a friction coefficient, of equally near ones the first.
    std::size_t nearest_point(const StabilityChart &chart, const double mu)
    {
      std::size_t nearest = 0;
      for (std::size_t k = 1; k < chart.points.size(); ++k)
        if (std::abs(chart.points[k].friction_coefficient - mu) < std::abs(chart.points[nearest].friction_coefficient - mu))
          nearest = k;
      return nearest;
    }

    PlotPanel complex_plane_panel(const std::vector<ChartLine> &lines, const double mu, const double largest_frequency, const Plot &plot)
    {
      PlotPanel panel{"μ = " + number(mu), "frequency [kHz]", "divergence rate [%]", false, false, {}, {}};
      panel.zero_line = true;
      const double last = largest_frequency > 0. && std::isfinite(largest_frequency) ? 1e-3 * hertz(largest_frequency) : nothing;
      if (std::isfinite(last))
        panel.x_range = {0., last};

      struct Mark
      {
        double      x, y;
        bool        grows, is_undecided;
        std::string label;
      };
      std::vector<std::vector<Mark>> marks(lines.size());
      double                         highest = 0., lowest = 0.;
      for (std::size_t l = 0; l < lines.size(); ++l)
        if (!lines[l].chart.points.empty())
          {
            const StabilityChart &chart = lines[l].chart;
            const std::size_t     k     = nearest_point(chart, mu);
            const ChartPoint     &point = chart.points[k];
            std::map<int, std::string> names;
            for (std::size_t b = 0; b < chart.branches.size(); ++b)
              if (chart.branches[b].modes.at(k) >= 0)
                names[chart.branches[b].modes[k]] = lines[l].labels[b];
            for (std::size_t mode = 0; mode < point.lambda.size(); ++mode)
              if (const auto &lambda = point.lambda[mode]; lambda.imag() <= largest_frequency)
                {
                  const bool is_undecided = mode < point.verdicts.size() && point.verdicts[mode] == Verdict::undecided;
                  marks[l].push_back({1e-3 * frequency(lambda), divergence(lambda), is_growing(lambda) && !is_undecided, is_undecided, names[mode]});
                  highest = std::max(highest, marks[l].back().y);
                  lowest  = std::min(lowest, marks[l].back().y);
                }
          }

      // Rates of rounding are no reason to cut
      const double smallest_top = 1e-6;
      const bool   is_cut       = highest > smallest_top && lowest < -4. * highest;
      const double edge         = is_cut ? -2.5 * highest : lowest;
      if (is_cut)
        panel.y_range = {1.08 * edge, 1.25 * highest};
      else if (highest > smallest_top)
        panel.y_range = {1.15 * edge - 0.1 * highest, 1.25 * highest};
      const double height = std::isfinite(panel.y_range.first) ? panel.y_range.last - panel.y_range.first : 1.;

      // The first line lies on top
      for (std::size_t l = lines.size(); l-- > 0;)
        {
          const int  colour = line_colours[l % n_line_colours];
          PlotSeries inside{lines[l].title, {}, {}, Style::points, colour, disc}, below{"faster decay", {}, {}, Style::points, colour, triangle_down};
          inside.size      = 0.45;
          below.size       = 0.6;
          inside.key_place = l;
          below.key_place  = std::numeric_limits<int>::max();
          for (const Mark &mark : marks[l])
            append(mark.y < edge ? below : inside, mark.x, std::max(mark.y, edge));
          panel.series.push_back(inside);
          panel.series.push_back(below);
        }
      TextRoom room(plot.panel_width - 90, plot.panel_height - 90);
      const auto x_share = [&](const Mark &mark) { return std::isfinite(last) ? mark.x / last : 0.5; };
      const auto y_share = [&](const Mark &mark) { return std::isfinite(panel.y_range.first) ? (mark.y - panel.y_range.first) / height : 0.5; };
      for (const auto &of_line : marks)
        for (const Mark &mark : of_line)
          if (mark.y >= edge)
            room.occupy(x_share(mark), y_share(mark));
      for (std::size_t l = 0; l < lines.size(); ++l)
        {
          PlotSeries rings{"growing", {}, {}, Style::points, growing_colours[0], ring}, squares{"undecided", {}, {}, Style::points, 2, square};
          rings.size      = 1.2;
          squares.size    = 1.1;
          rings.key_place = squares.key_place = lines.size();
          std::map<Side, PlotSeries> texts;
          for (const Mark &mark : marks[l])
            if (mark.grows || mark.is_undecided)
              {
                append(mark.grows ? rings : squares, mark.x, std::max(mark.y, edge));
                // The name beside the mode of an earlier line serves both
                constexpr double close    = 0.05;
                const bool       is_named = std::any_of(marks.begin(), marks.begin() + l, [&](const std::vector<Mark> &earlier) {
                  return std::any_of(earlier.begin(), earlier.end(), [&](const Mark &other) {
                    return other.grows && other.label == mark.label && std::abs(x_share(other) - x_share(mark)) < close;
                  });
                });
                Side             side;
                if (mark.grows && !is_named && !mark.label.empty() && room.find(x_share(mark), y_share(mark), mark.label, side))
                  {
                    PlotSeries &series = texts[side];
                    series.style       = Style::texts;
                    series.side        = side;
                    append(series, mark.x, mark.y);
                    series.labels.push_back(mark.label);
                  }
              }
          panel.series.push_back(rings);
          panel.series.push_back(squares);
          for (const auto &entry : texts)
            panel.series.push_back(entry.second);
        }
      return panel;
    }

    // ---------------------------------------------------------------- families

    /// Branches of a family in a line, and those of other families that they meet.
    std::vector<int> members(const ChartLine &line, const std::string &family, const std::set<std::string> &partners, const double largest_frequency)
    {
      std::vector<int> result;
      for (std::size_t b = 0; b < line.labels.size(); ++b)
        {
          const bool is_member  = branch_family(line.labels[b]) == family;
          const bool is_nameless = family == no_label;
          // Of many branches of one name it is not known which one it is that is met in the other line
          const bool is_partner = partners.count(line.labels[b]) != 0 && std::count(line.labels.begin(), line.labels.end(), line.labels[b]) == 1;
          bool       meets      = false;
          for (const Threshold &threshold : line.chart.thresholds)
            meets = meets || (threshold.partner == static_cast<int>(b) && threshold.lambda.imag() <= largest_frequency &&
                              branch_family(line.labels.at(threshold.branch)) == family);
          if ((is_member && (!is_nameless || grows_somewhere(curve(line.chart, b, largest_frequency)))) || is_partner || meets)
            result.push_back(b);
        }
      return result;
    }

    // --------------------------------------------------------------------- map

    /// Edges of cells half-way between values, the outer ones as far from their value; not across zero.
    std::vector<double> cell_edges(const std::vector<double> &values, const bool logarithmic)
    {
      std::vector<double> edges;
      const auto          to   = [logarithmic](const double v) { return logarithmic ? std::log(v) : v; };
      const auto          from = [logarithmic](const double v) { return logarithmic ? std::exp(v) : v; };
      const std::size_t   n    = values.size();
      // A single value has no neighbour: its cell is as wide as it likes
      constexpr double lonely = 0.05;
      edges.push_back(n > 1 ? from(1.5 * to(values[0]) - 0.5 * to(values[1])) : from(to(values[0]) - lonely));
      for (std::size_t i = 0; i + 1 < n; ++i)
        edges.push_back(from(0.5 * (to(values[i]) + to(values[i + 1]))));
      edges.push_back(n > 1 ? from(1.5 * to(values[n - 1]) - 0.5 * to(values[n - 2])) : from(to(values[0]) + lonely));
      if (values.front() >= 0.)
        edges.front() = std::max(edges.front(), 0.);
      return edges;
    }

    /// 1, 2, 5, 10, ... within a range; powers of ten alone if it is wide.
    std::vector<double> logarithmic_ticks(const double first, const double last)
    {
      constexpr double    wide = 1e4;
      std::vector<double> ticks;
      for (int power = std::floor(std::log10(first)); power <= std::log10(last); ++power)
        for (const double digit : {1., 2., 5.})
          if (const double tick = digit * std::pow(10., power); tick >= first && tick <= last && (digit == 1. || last < wide * first))
            ticks.push_back(tick);
      return ticks;
    }

    /// The plane of a map, cell by cell.
    class MapPlane
    {
    public:
      explicit MapPlane(const StabilityMap &map)
        : map(map)
        , n_columns(map.friction_coefficients.size())
        , n_rows(map.ordinates.size())
        , x_edges(cell_edges(map.friction_coefficients, false))
        , y_edges(cell_edges(map.ordinates, true))
      {}

      const MapCell &cell(const int row, const int column) const
      {
        return map.cells[row * n_columns + column];
      }

      /// Cells that @p is_chosen, coloured by @p value if there is one.
      PlotSeries cells(const std::string                            &title,
                       const int                                     colour,
                       const std::function<bool(const MapCell &)>   &is_chosen,
                       const std::function<double(const MapCell &)> &value = nullptr) const
      {
        PlotSeries series{title, {}, {}, Style::cells, colour};
        for (int row = 0; row < n_rows; ++row)
          for (int column = 0; column < n_columns; ++column)
            if (is_chosen(cell(row, column)))
              {
                append(series, map.friction_coefficients[column], map.ordinates[row]);
                series.cells.push_back({x_edges[column], x_edges[column + 1], y_edges[row], y_edges[row + 1]});
                if (value)
                  series.values.push_back(value(cell(row, column)));
              }
        return series;
      }

      /// Edges between neighbours that @p differ.
      PlotSeries limits(const std::string                                                   &title,
                        const double                                                         width,
                        const bool                                                           dashed,
                        const std::function<bool(const MapCell &first, const MapCell &second)> &differ) const
      {
        PlotSeries series{title, {}, {}, Style::lines, 0};
        series.size         = width;
        series.dashed       = dashed;
        const auto separate = [&](const int row, const int column, const int other_row, const int other_column) {
          const MapCell &first = cell(row, column), &second = cell(other_row, other_column);
          return first.is_known && second.is_known && differ(first, second);
        };
        // Edges in a row are one line, so that dashes go on
        for (int column = 0; column + 1 < n_columns; ++column)
          {
            for (int row = 0; row < n_rows; ++row)
              if (separate(row, column, row, column + 1))
                {
                  if (series.x.empty() || !std::isfinite(series.x.back()))
                    append(series, x_edges[column + 1], y_edges[row]);
                  append(series, x_edges[column + 1], y_edges[row + 1]);
                }
              else
                end_line(series);
            end_line(series);
          }
        for (int row = 0; row + 1 < n_rows; ++row)
          {
            for (int column = 0; column < n_columns; ++column)
              if (separate(row, column, row + 1, column))
                {
                  if (series.x.empty() || !std::isfinite(series.x.back()))
                    append(series, x_edges[column], y_edges[row + 1]);
                  append(series, x_edges[column + 1], y_edges[row + 1]);
                }
              else
                end_line(series);
            end_line(series);
          }
        return series;
      }

      /// The name of the most unstable mode in the middle of each region, if there is room.
      PlotSeries leaders() const
      {
        PlotSeries series{"", {}, {}, Style::texts, 0};
        series.side = Side::centre;
        std::vector<bool> is_done(map.cells.size(), false);
        for (int start = 0; start < n_rows * n_columns; ++start)
          {
            const std::string &leader = map.cells[start].leader;
            if (is_done[start] || !is_unstable(map.cells[start]) || leader.empty())
              continue;
            std::vector<int> region = {start};
            is_done[start]          = true;
            for (std::size_t i = 0; i < region.size(); ++i)
              {
                const int row = region[i] / n_columns, column = region[i] % n_columns;
                for (const auto &[other_row, other_column] :
                     {std::make_pair(row - 1, column), {row + 1, column}, {row, column - 1}, {row, column + 1}})
                  {
                    const int other = other_row * n_columns + other_column;
                    if (other_row >= 0 && other_row < n_rows && other_column >= 0 && other_column < n_columns && !is_done[other] &&
                        is_unstable(map.cells[other]) && map.cells[other].leader == leader)
                      {
                        is_done[other] = true;
                        region.push_back(other);
                      }
                  }
              }

            // The cell from which it is farthest to the rim, of several the one nearest to the middle
            const std::set<int> inside(region.begin(), region.end());
            const auto          reach = [&](const int row, const int column, const int row_step, const int column_step) {
              int steps = 0;
              for (int r = row, c = column; r >= 0 && r < n_rows && c >= 0 && c < n_columns && inside.count(r * n_columns + c) != 0;
                   r += row_step, c += column_step)
                ++steps;
              return steps;
            };
            double middle_row = 0., middle_column = 0.;
            for (const int i : region)
              {
                middle_row += static_cast<double>(i / n_columns) / region.size();
                middle_column += static_cast<double>(i % n_columns) / region.size();
              }
            int    best       = -1;
            double best_share = 0., best_distance = 0.;
            for (const int i : region)
              {
                const int    row = i / n_columns, column = i % n_columns;
                const double width = 2. * std::min(reach(row, column, 0, 1), reach(row, column, 0, -1)) - 1.;
                const double height   = 2. * std::min(reach(row, column, 1, 0), reach(row, column, -1, 0)) - 1.;
                const double share    = std::min(width / n_columns, height / n_rows);
                const double distance = std::hypot((row - middle_row) / n_rows, (column - middle_column) / n_columns);
                // A text of so many letters is so wide, and a line so high, in shares of the panel
                const bool has_room = width / n_columns > 0.02 * leader.size() && height / n_rows > 0.04;
                if (has_room && (best < 0 || share > best_share || (share == best_share && distance < best_distance)))
                  {
                    best          = i;
                    best_share    = share;
                    best_distance = distance;
                  }
              }
            if (best >= 0)
              {
                append(series, map.friction_coefficients[best % n_columns], map.ordinates[best / n_columns]);
                series.labels.push_back(leader);
              }
          }
        return series;
      }

      static bool is_unstable(const MapCell &cell)
      {
        return cell.is_known && cell.n_unstable > 0;
      }

      PlotRange x_range() const
      {
        return {x_edges.front(), x_edges.back()};
      }

      PlotRange y_range() const
      {
        return {y_edges.front(), y_edges.back()};
      }

    private:
      const StabilityMap &map;
      int                 n_columns, n_rows;
      std::vector<double> x_edges, y_edges;
    };
  } // namespace

  std::string branch_family(const std::string &label)
  {
    const std::size_t n = label.size();
    return n > 2 && label[n - 2] == ' ' && (label[n - 1] == '-' || label[n - 1] == '+') ? label.substr(0, n - 2) : label;
  }

  Plot complex_plane_plot(const std::vector<ChartLine> &lines,
                          const std::vector<double>    &friction_coefficients,
                          const double                  largest_frequency)
  {
    check(lines);
    Plot plot{"Modes in the complex plane", {}, 2, 520, 340};
    for (const double mu : friction_coefficients)
      plot.panels.push_back(complex_plane_panel(lines, mu, largest_frequency, plot));
    if (plot.panels.empty())
      plot.panels.push_back({"no friction coefficient", "frequency [kHz]", "divergence rate [%]", false, false, {}, {}});
    return plot;
  }

  std::vector<NamedPlot> frequency_plots(const std::vector<ChartLine> &lines, const double largest_frequency)
  {
    check(lines);
    // Families of which a branch grows, by the lowest frequency at which one begins to
    std::map<std::string, double>                families;
    std::map<std::string, std::set<std::string>> partners;
    for (const ChartLine &line : lines)
      {
        for (std::size_t b = 0; b < line.chart.branches.size(); ++b)
          for (const CurvePoint &point : curve(line.chart, b, largest_frequency))
            if (point.is_shown && point.grows)
              {
                const auto entry = families.emplace(branch_family(line.labels[b]), frequency(point.lambda)).first;
                entry->second    = std::min(entry->second, frequency(point.lambda));
                break;
              }
        for (const Threshold &threshold : line.chart.thresholds)
          if (threshold.partner >= 0 && threshold.lambda.imag() <= largest_frequency)
            partners[branch_family(line.labels.at(threshold.branch))].insert(line.labels.at(threshold.partner));
      }
    std::vector<std::pair<double, std::string>> order;
    for (const auto &[family, lowest] : families)
      order.emplace_back(lowest, family);
    std::sort(order.begin(), order.end());

    std::vector<NamedPlot> plots;
    for (std::size_t first = 0; first < order.size(); first += families_per_plot)
      {
        const std::size_t      n = std::min<std::size_t>(families_per_plot, order.size() - first);
        std::vector<PlotPanel> upper, lower;
        for (std::size_t f = first; f < first + n; ++f)
          {
            const std::string &family = order[f].second;
            PlotPanel          frequencies{family, "μ", "frequency [Hz]", false, false, {}, {}}, rates{family, "μ", "divergence rate [%]", false, false, {}, {}};
            frequencies.x_range = rates.x_range = friction_range(lines);
            rates.zero_line                     = true;
            // The first line lies on top
            for (std::size_t l = lines.size(); l-- > 0;)
              {
                const std::vector<int> shown = members(lines[l], family, partners[family], largest_frequency);
                add_curves(frequencies, lines[l], l, shown, largest_frequency, frequency, 1.);
                add_curves(rates, lines[l], l, shown, largest_frequency, divergence, 1.);
                if (l == 0)
                  add_names(frequencies, lines[l], shown, largest_frequency);
              }
            // Names lie above the highest and below the lowest branch
            double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
            for (const PlotSeries &series : frequencies.series)
              for (const double value : series.y)
                if (std::isfinite(value))
                  {
                    lowest  = std::min(lowest, value);
                    highest = std::max(highest, value);
                  }
            constexpr double margin = 0.1;
            if (lowest < highest)
              frequencies.y_range = {lowest - margin * (highest - lowest), highest + margin * (highest - lowest)};
            upper.push_back(frequencies);
            lower.push_back(rates);
          }
        // A single family has its panels beside each other
        Plot plot{"Branches that grow, with their families", upper, n > 1 ? static_cast<int>(n) : 2};
        plot.panels.insert(plot.panels.end(), lower.begin(), lower.end());
        plots.push_back({"sweep_families" + (order.size() > families_per_plot ? "_" + std::to_string(first / families_per_plot + 1) : ""), plot});
      }
    return plots;
  }

  Plot overview_plot(const std::vector<ChartLine> &lines, const double largest_frequency)
  {
    check(lines);
    PlotPanel frequencies{"Frequencies", "μ", "frequency [Hz]", false, false, {}, {}}, rates{"Divergence rates", "μ", "divergence rate [%]", false, false, {}, {}};
    frequencies.x_range = rates.x_range = friction_range(lines);
    rates.zero_line                     = true;
    if (largest_frequency > 0. && std::isfinite(largest_frequency))
      frequencies.y_range = {0., hertz(largest_frequency)};
    for (std::size_t l = lines.size(); l-- > 0;)
      {
        std::vector<int> all;
        for (std::size_t b = 0; b < lines[l].chart.branches.size(); ++b)
          all.push_back(b);
        add_curves(frequencies, lines[l], l, all, largest_frequency, frequency, 0.75);
        add_curves(rates, lines[l], l, all, largest_frequency, divergence, 0.75);
      }
    return {"Modes of the band over the friction coefficient", {frequencies, rates}, 2, 480, 480};
  }

  Plot map_plot(const StabilityMap &map)
  {
    const auto is_ascending = [](const std::vector<double> &values) {
      return !values.empty() && std::adjacent_find(values.begin(), values.end(), [](const double a, const double b) { return !(a < b); }) == values.end();
    };
    if (!is_ascending(map.friction_coefficients) || !is_ascending(map.ordinates) || !(map.ordinates.front() > 0.))
      throw Error("an axis is empty, not ascending or, the ordinate, not positive", "map `" + map.title + "`", "give ascending values");
    if (map.cells.size() != map.friction_coefficients.size() * map.ordinates.size())
      throw Error(std::to_string(map.cells.size()) + " cells for " + std::to_string(map.friction_coefficients.size()) + " by " +
                    std::to_string(map.ordinates.size()) + " points",
                  "map `" + map.title + "`", "give one cell for each point");

    const MapPlane plane(map);
    const auto     is_unstable  = [](const MapCell &cell) { return MapPlane::is_unstable(cell); };
    const auto     is_undecided = [](const MapCell &cell) { return cell.is_known && cell.n_unstable == 0 && cell.n_undecided > 0; };
    double         largest_rate = 0.;
    int            largest_number = 1;
    for (const MapCell &cell : map.cells)
      if (is_unstable(cell))
        {
          largest_rate   = std::max(largest_rate, 100. * cell.divergence_rate);
          largest_number = std::max(largest_number, cell.n_unstable);
        }

    Plot plot{map.title, {}, 2, 500, 400};
    for (const bool counts : {false, true})
      {
        PlotPanel panel{counts ? "Number of unstable modes" : "Most unstable mode", "μ", map.ordinate_name + " [" + map.ordinate_unit + "]",
                        false, true, {}, {}, plane.x_range(), plane.y_range()};
        panel.y_ticks      = logarithmic_ticks(panel.y_range.first, panel.y_range.last);
        panel.colour_label = counts ? "unstable modes" : "divergence rate [%]";
        panel.colour_end   = counts ? largest_number : largest_rate;
        panel.counts       = counts;
        panel.series.push_back(plane.cells("not computed", 7, [](const MapCell &cell) { return !cell.is_known; }));
        panel.series.push_back(plane.cells("undecided", 1, is_undecided));
        panel.series.push_back(plane.cells("", 0, is_unstable, [counts](const MapCell &cell) {
          return counts ? static_cast<double>(cell.n_unstable) : 100. * cell.divergence_rate;
        }));
        if (!counts)
          panel.series.push_back(plane.limits("change of the most unstable mode", 0.4, false, [&](const MapCell &a, const MapCell &b) {
            return is_unstable(a) && is_unstable(b) && a.leader != b.leader;
          }));
        panel.series.push_back(
          plane.limits("change of the contact set", 0.8, true, [](const MapCell &a, const MapCell &b) { return a.n_open != b.n_open; }));
        panel.series.push_back(plane.limits("limit of stability", 1.5, false, [&](const MapCell &a, const MapCell &b) {
          return is_unstable(a) != is_unstable(b);
        }));
        if (!counts)
          panel.series.push_back(plane.leaders());
        plot.panels.push_back(panel);
      }
    return plot;
  }
} // namespace Squeal
