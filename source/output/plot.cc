#include <squeal/base/exceptions.h>
#include <squeal/base/file_writing.h>
#include <squeal/output/plot.h>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <ostream>
#include <sstream>

namespace Squeal
{
  namespace
  {
    // Colours that are told apart with every kind of colour vision (Okabe and Ito, after black and grey), and gnuplot's markers
    constexpr const char *palette[] = {"#000000", "#999999", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f5539"};
    constexpr int         n_colours = sizeof(palette) / sizeof(palette[0]);
    constexpr int         markers[] = {7, 5, 9, 11, 13, 6, 4, 8, 10, 12, 2, 1, 3};
    constexpr int         n_markers = sizeof(markers) / sizeof(markers[0]);

    constexpr int key_height = 24, smallest_key = 230, key_mark = 56, letter = 7, title_height = 30; // [pixels]
    constexpr int left_margin = 92, right_margin = 15, bottom_margin = 56, top_margin = 33;         // [pixels]
    constexpr int scale_margin = 88, scale_gap = 10, scale_width = 14;                              // [pixels]

    /// From pale to dark, without white and grey, which cells of other meanings have; black texts are legible on all of them.
    constexpr int scale[][3] = {{255, 243, 196}, {253, 210, 127}, {249, 160, 82}, {232, 103, 58}, {196, 58, 36}};
    constexpr int n_scale    = sizeof(scale) / sizeof(scale[0]);

    /// Numbers of modes up to this have a colour each.
    constexpr int most_steps = 12;

    /// gnuplot's name of a colour of the scale at @p share ∈ [0, 1].
    std::string scale_colour(const double share)
    {
      const int          i = std::min(static_cast<int>(share * (n_scale - 1)), n_scale - 2);
      const double       t = share * (n_scale - 1) - i;
      std::ostringstream text;
      text << "'#" << std::hex << std::setfill('0');
      for (int c = 0; c < 3; ++c)
        text << std::setw(2) << static_cast<int>(std::lround((1. - t) * scale[i][c] + t * scale[i + 1][c]));
      return text.str() + "'";
    }

    /// gnuplot's definition of the scale: in @p n_steps of one colour each, or continuous if there are none.
    std::string scale_definition(const int n_steps)
    {
      std::ostringstream text;
      for (int i = 0; i < n_steps; ++i)
        {
          const std::string colour = scale_colour(n_steps > 1 ? static_cast<double>(i) / (n_steps - 1) : 0.);
          text << (i > 0 ? ", " : "") << i << ' ' << colour << ", " << i + 1 << ' ' << colour;
        }
      if (n_steps == 0)
        for (int i = 0; i < n_scale; ++i)
          text << (i > 0 ? ", " : "") << i << ' ' << scale_colour(static_cast<double>(i) / (n_scale - 1));
      return "(" + text.str() + ")";
    }

    /// A text in gnuplot's quotation marks, without its markup.
    std::string quoted(const std::string &text)
    {
      std::string result = "\"";
      for (const char c : text)
        {
          if (c == '"' || c == '\\')
            result += '\\';
          result += c;
        }
      return result + "\"";
    }

    bool is_shown(const PlotPanel &panel, const double x, const double y)
    {
      return std::isfinite(x) && std::isfinite(y) && !(panel.logarithmic_x && x <= 0.) && !(panel.logarithmic_y && y <= 0.);
    }

    bool is_empty(const PlotPanel &panel, const PlotSeries &series)
    {
      for (std::size_t i = 0; i < series.x.size(); ++i)
        if (is_shown(panel, series.x[i], series.y[i]))
          return false;
      return true;
    }

    void write_data(std::ostream &stream, const Plot &plot)
    {
      stream << std::setprecision(12);
      for (const PlotPanel &panel : plot.panels)
        for (const PlotSeries &series : panel.series)
          if (!is_empty(panel, series))
          {
            stream << "# " << panel.title << ": " << series.title << "\n# " << panel.x_label << ", " << panel.y_label;
            if (!series.cells.empty())
              stream << ", left, right, low, high";
            if (!series.values.empty())
              stream << ", " << panel.colour_label;
            stream << '\n';
            // One empty line breaks a line, two end a block
            bool has_begun = false, is_broken = false;
            for (std::size_t i = 0; i < series.x.size(); ++i)
              if (is_shown(panel, series.x[i], series.y[i]))
                {
                  if (is_broken && has_begun)
                    stream << '\n';
                  has_begun = true;
                  is_broken = false;
                  stream << series.x[i] << ' ' << series.y[i];
                  if (!series.cells.empty())
                    stream << ' ' << series.cells[i].left << ' ' << series.cells[i].right << ' ' << series.cells[i].low << ' ' << series.cells[i].high;
                  if (!series.values.empty())
                    stream << ' ' << series.values[i];
                  if (!series.labels.empty())
                    stream << ' ' << quoted(series.labels[i]);
                  stream << '\n';
                }
              else
                is_broken = series.style == PlotSeries::Style::lines;
            stream << "\n\n";
          }
    }

    /// How the marks of a series look; in the key if @p in_key.
    std::string look(const PlotSeries &series, const bool in_key)
    {
      std::ostringstream text;
      std::string        colour = std::string(" lc rgb '") + palette[series.colour % n_colours] + "'";
      switch (series.style)
        {
          case PlotSeries::Style::points:
            text << "with points pt " << markers[series.marker % n_markers] << " ps " << 0.9 * series.size << " lw 1.5";
            break;
          case PlotSeries::Style::lines:
            text << "with lines lw " << 1.8 * series.size << (series.dashed ? " dt (8,5)" : "");
            break;
          case PlotSeries::Style::dots:
            text << "with points pt 7 ps " << (in_key ? std::max(0.5, 0.25 * series.size) : 0.25 * series.size);
            break;
          case PlotSeries::Style::texts:
            break;
          case PlotSeries::Style::cells:
            // The edges have the colour of the cell, too: without them hairlines show between cells
            if (in_key)
              text << "with points pt 5 ps 1.6";
            else
              text << "with boxxyerror fs solid border lw 0.5";
            if (!in_key && !series.values.empty())
              colour = " lc palette";
            break;
        }
      return text.str() + colour;
    }

    /// How labels are placed beside their points.
    std::string label_place(const PlotSeries::Side side)
    {
      switch (side)
        {
          case PlotSeries::Side::lower_right:
            return "offset 0.6,-0.5 left";
          case PlotSeries::Side::upper_left:
            return "offset -0.6,0.5 right";
          case PlotSeries::Side::lower_left:
            return "offset -0.6,-0.5 right";
          case PlotSeries::Side::centre:
            return "center";
          default:
            return "offset 0.6,0.5 left";
        }
    }

    /// A range in gnuplot's brackets, automatic if it is empty.
    std::string range_text(const PlotRange &range)
    {
      std::ostringstream text;
      text << std::setprecision(12);
      const auto end = [&](const double value) {
        if (std::isfinite(value))
          text << value;
        else
          text << '*';
      };
      const bool is_point = std::isfinite(range.first) && std::isfinite(range.last) && !(range.first < range.last);
      text << '[';
      end(is_point ? NAN : range.first);
      text << ':';
      end(is_point ? NAN : range.last);
      text << ']';
      return text.str();
    }

    void check(const Plot &plot)
    {
      for (const PlotPanel &panel : plot.panels)
        for (const PlotSeries &series : panel.series)
          {
            const std::size_t n    = series.x.size();
            const auto        fits = [n](const std::size_t m) { return m == 0 || m == n; };
            const bool        is_complete =
              (series.style != PlotSeries::Style::texts || series.labels.size() == n) && (series.style != PlotSeries::Style::cells || series.cells.size() == n);
            if (series.y.size() != n || !fits(series.labels.size()) || !fits(series.cells.size()) || !fits(series.values.size()) || !is_complete)
              throw Error("a series of " + std::to_string(n) + " points lacks ordinates, labels, cells or values", "plot `" + plot.title + "`",
                          "give as many as there are points");
          }
    }

    /// Whether gnuplot is there and draws what a script says, in the folder of the script.
    bool runs_gnuplot(const std::filesystem::path &script)
    {
      std::string        program = "gnuplot", folder = script.parent_path().string(), file = script.filename().string();
      std::vector<char *> arguments = {program.data(), file.data(), nullptr};

      posix_spawn_file_actions_t actions;
      posix_spawn_file_actions_init(&actions);
      posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
      for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&actions, descriptor, "/dev/null", O_WRONLY, 0);
      pid_t     process;
      const int problem = ::posix_spawnp(&process, program.c_str(), &actions, nullptr, arguments.data(), environ);
      posix_spawn_file_actions_destroy(&actions);
      if (problem != 0)
        return false;
      int status = 0;
      while (::waitpid(process, &status, 0) < 0 && errno == EINTR)
        ;
      return WIFEXITED(status) && WEXITSTATUS(status) == 0;
    }

    void write_script(std::ostream &stream, const std::string &name, const Plot &plot)
    {
      const int n_panels = plot.panels.size(), n_columns = std::min(plot.n_columns, n_panels), n_rows = (n_panels + n_columns - 1) / n_columns;

      // The key: every title once, in a strip of its own below the panels
      std::vector<const PlotSeries *> key;
      for (const PlotPanel &panel : plot.panels)
        for (const PlotSeries &series : panel.series)
          if (!series.title.empty() && series.style != PlotSeries::Style::texts && !is_empty(panel, series) &&
              std::none_of(key.begin(), key.end(), [&](const PlotSeries *other) { return other->title == series.title; }))
            key.push_back(&series);
      std::stable_sort(key.begin(), key.end(), [](const PlotSeries *first, const PlotSeries *second) { return first->key_place < second->key_place; });
      int key_width = smallest_key;
      for (const PlotSeries *series : key)
        key_width = std::max(key_width, key_mark + letter * static_cast<int>(series->title.size()));
      const int panel_width = plot.panel_width, panel_height = plot.panel_height;
      const int per_line = std::max(1, n_columns * panel_width / key_width), key_lines = (key.size() + per_line - 1) / per_line;
      const int width = n_columns * panel_width, strip = key_lines * key_height + 10;
      const int height = n_rows * panel_height + strip + title_height;
      const double bottom = static_cast<double>(strip) / height, top = 1. - static_cast<double>(title_height) / height;

      stream << "# Draws " << name << ".svg from " << name << ".dat\n"
             << "set terminal svg size " << width << "," << height << " font 'Helvetica,12' background rgb 'white' noenhanced\n"
             << "set output '" << name << ".svg'\n"
             << "set multiplot\n"
             << "set label 1000 " << quoted(plot.title) << " at screen 0.5," << 1. - 0.5 * title_height / height << " center font 'Helvetica,14'\n"
             << "set border 3 lc rgb '#555555'\nset tics nomirror\nset grid lc rgb '#dddddd'\nunset key\n";
      int block = 0;
      for (int p = 0; p < n_panels; ++p)
        {
          const PlotPanel &panel = plot.panels[p];
          const int        row = p / n_columns, column = p % n_columns;
          const double     cell_width = 1. / n_columns, cell_height = (top - bottom) / n_rows;
          const double     left = column * cell_width, low = top - (row + 1) * cell_height;
          const bool       has_scale = !panel.colour_label.empty();
          const bool       has_cells = std::any_of(panel.series.begin(), panel.series.end(),
                                             [](const PlotSeries &series) { return series.style == PlotSeries::Style::cells; });
          const double right = left + cell_width - static_cast<double>(has_scale ? scale_margin : right_margin) / width;
          const double floor = low + static_cast<double>(bottom_margin) / height, ceiling = low + cell_height - static_cast<double>(top_margin) / height;
          stream << "\nset lmargin at screen " << left + static_cast<double>(left_margin) / width << "\nset rmargin at screen " << right
                 << "\nset bmargin at screen " << floor << "\nset tmargin at screen " << ceiling << "\n"
                 << "set title " << quoted(panel.title) << " offset 0,-0.5\nset xlabel " << quoted(panel.x_label) << "\nset ylabel "
                 << quoted(panel.y_label) << " offset 1,0\n"
                 << (panel.logarithmic_x ? "set logscale x\nset format x '%.0e'\n" : "unset logscale x\nset format x '%g'\n")
                 << (panel.logarithmic_y ? "set logscale y\n" : "unset logscale y\n")
                 << (panel.logarithmic_y && panel.y_ticks.empty() ? "set format y '%.0e'\n" : "set format y '%g'\n")
                 << (panel.zero_line ? "set xzeroaxis lt 1 lw 1.2 lc rgb '#555555'\n" : "unset xzeroaxis\n")
                 << (has_cells ? "unset grid\nset border 15\n" : "set grid lc rgb '#dddddd'\nset border 3\n");
          if (panel.y_ticks.empty())
            stream << "set ytics autofreq\n";
          else
            {
              stream << "set ytics (";
              for (std::size_t i = 0; i < panel.y_ticks.size(); ++i)
                stream << (i > 0 ? ", " : "") << panel.y_ticks[i];
              stream << ")\n";
            }
          stream << "set yrange " << range_text(panel.y_range) << "\n";
          if (has_scale)
            {
              const bool in_steps = panel.counts && panel.colour_end <= most_steps;
              stream << "set palette defined " << scale_definition(in_steps ? std::max(1, static_cast<int>(panel.colour_end)) : 0) << "\nset cbrange ["
                     << (panel.counts ? "0.5:" : "0:") << (panel.colour_end > 0. ? panel.colour_end : 1.) + (panel.counts ? 0.5 : 0.)
                     << "]\nset cblabel " << quoted(panel.colour_label) << "\nset cbtics " << (in_steps ? "1" : "autofreq")
                     << "\nset colorbox vertical user origin screen " << right + static_cast<double>(scale_gap) / width << "," << floor
                     << " size screen " << static_cast<double>(scale_width) / width << "," << ceiling - floor << "\n";
            }
          else
            stream << "unset colorbox\n";
          if (!panel.x_names.empty())
            {
              stream << "set xtics (";
              for (std::size_t i = 0; i < panel.x_names.size(); ++i)
                stream << (i > 0 ? ", " : "") << quoted(panel.x_names[i]) << " " << i + 1;
              stream << ")\nset xrange [0.5:" << panel.x_names.size() + 0.5 << "]\n";
            }
          else
            stream << "set xtics autofreq\nset xrange " << range_text(panel.x_range) << "\n";

          std::string separator = "plot ";
          for (const PlotSeries &series : panel.series)
            {
              if (!is_empty(panel, series))
                {
                  const std::string data = "'" + name + ".dat' index " + std::to_string(block) + " using ";
                  // gnuplot's columns: the point, the edges of a cell, its value, the label
                  const int label = 3 + (series.cells.empty() ? 0 : 4) + (series.values.empty() ? 0 : 1);
                  stream << separator;
                  if (series.style == PlotSeries::Style::cells)
                    stream << data << (series.values.empty() ? "1:2:3:4:5:6 " : "1:2:3:4:5:6:7 ") << look(series, false);
                  else if (series.style != PlotSeries::Style::texts)
                    stream << data << "1:2 " << look(series, false);
                  if (!series.labels.empty())
                    stream << (series.style != PlotSeries::Style::texts ? ", " : "") << data << "1:2:" << label << " with labels " << label_place(series.side)
                           << " font 'Helvetica,9' tc rgb '" << (series.style == PlotSeries::Style::texts ? palette[series.colour % n_colours] : "#444444")
                           << "'";
                  separator = ", \\\n     ";
                  ++block;
                }
            }
          stream << (separator == "plot " ? "unset logscale\nplot [0:1][0:1] NaN\n" : "\n") << "unset label 1000\n";
        }

      if (!key.empty())
        {
          stream << "\nunset title\nunset colorbox\nunset xzeroaxis\nunset xlabel\nunset ylabel\nunset logscale\nunset border\nunset tics\nunset grid\n"
                 << "set lmargin at screen 0\nset rmargin at screen 1\nset bmargin at screen 0\nset tmargin at screen " << bottom << "\n"
                 << "set xrange [0:" << per_line << "]\nset yrange [0:" << key_lines << "]\n";
          std::ostringstream marks;
          for (std::size_t k = 0; k < key.size(); ++k)
            {
              const double x = k % per_line, y = key_lines - 0.5 - static_cast<double>(k / per_line);
              stream << "set label " << k + 1 << " " << quoted(key[k]->title) << " at " << x + 0.16 << "," << y << " left\n";
              if (key[k]->style == PlotSeries::Style::lines)
                marks << (k > 0 ? ", \\\n     " : "plot ") << "'+' using ($0 == 0 ? " << x + 0.02 << " : $0 == 1 ? " << x + 0.13
                      << " : NaN):(" << y << ") " << look(*key[k], true);
              else
                marks << (k > 0 ? ", \\\n     " : "plot ") << "'+' using ($0 == 0 ? " << x + 0.09 << " : NaN):(" << y << ") " << look(*key[k], true);
            }
          stream << marks.str() << "\n";
        }
      stream << "unset multiplot\n";
    }
  } // namespace

  bool write_plot(const std::string &name, const Plot &plot, const ResultFolder &folder)
  {
    check(plot);
    folder.write("plots/" + name + ".dat", [&](std::ostream &stream) { write_data(stream, plot); });
    folder.write("plots/" + name + ".gp", [&](std::ostream &stream) { write_script(stream, name, plot); });
    if (!folder.writes_here())
      return true;
    const std::filesystem::path script = folder.path("plots/" + name + ".gp"), picture = std::filesystem::path(script).replace_extension(".svg");
    const bool                  is_drawn = runs_gnuplot(script);
    if (!is_drawn)
      {
        std::error_code ignored;
        std::filesystem::remove(picture, ignored);
      }
    // gnuplot does not tell whether there was room for the picture.
    else if (!file_ends_with(picture, "</svg>"))
      throw FileError("the picture is incomplete", "file " + folder.name() + "/plots/" + name + ".svg", "check free space");
    return is_drawn;
  }
} // namespace Squeal
