#include <squeal/output/plot.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
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

    constexpr int panel_width = 380, panel_height = 330, key_height = 24, title_height = 30; // [pixels]

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

    std::string shell_quoted(const std::string &text)
    {
      std::string result = "'";
      for (const char c : text)
        result += c == '\'' ? std::string("'\\''") : std::string(1, c);
      return result + "'";
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
            stream << "# " << panel.title << ": " << series.title << "\n# " << panel.x_label << ", " << panel.y_label << "\n";
            for (std::size_t i = 0; i < series.x.size(); ++i)
              if (is_shown(panel, series.x[i], series.y[i]))
                {
                  stream << series.x[i] << ' ' << series.y[i];
                  if (!series.labels.empty())
                    stream << ' ' << quoted(series.labels[i]);
                  stream << '\n';
                }
            stream << "\n\n";
          }
    }

    std::string look(const PlotSeries &series)
    {
      std::ostringstream text;
      const char *colour = palette[series.colour % n_colours];
      switch (series.style)
        {
          case PlotSeries::Style::points:
            text << "with points pt " << markers[series.marker % n_markers] << " ps 0.9 lw 1.5";
            break;
          case PlotSeries::Style::lines:
            text << "with lines lw 1.8";
            break;
          case PlotSeries::Style::dots:
            text << "with points pt 7 ps 0.25";
            break;
        }
      text << " lc rgb '" << colour << "'";
      return text.str();
    }

    void write_script(std::ostream &stream, const std::string &name, const Plot &plot)
    {
      const int n_panels = plot.panels.size(), n_columns = std::min(plot.n_columns, n_panels), n_rows = (n_panels + n_columns - 1) / n_columns;

      // The key: every title once, in a strip of its own below the panels
      std::vector<const PlotSeries *> key;
      for (const PlotPanel &panel : plot.panels)
        for (const PlotSeries &series : panel.series)
          if (!series.title.empty() && !is_empty(panel, series) &&
              std::none_of(key.begin(), key.end(), [&](const PlotSeries *other) { return other->title == series.title; }))
            key.push_back(&series);
      const int per_line = std::max(1, n_columns * panel_width / 230), key_lines = (key.size() + per_line - 1) / per_line;
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
          stream << "\nset lmargin at screen " << left + 0.2 * cell_width << "\nset rmargin at screen " << left + 0.96 * cell_width
                 << "\nset bmargin at screen " << low + 0.17 * cell_height << "\nset tmargin at screen " << low + 0.9 * cell_height << "\n"
                 << "set title " << quoted(panel.title) << " offset 0,-0.5\nset xlabel " << quoted(panel.x_label) << "\nset ylabel "
                 << quoted(panel.y_label) << " offset 1,0\n"
                 << (panel.logarithmic_x ? "set logscale x\nset format x '10^{%T}'\n" : "unset logscale x\nset format x '%g'\n")
                 << (panel.logarithmic_y ? "set logscale y\nset format y '%.0e'\n" : "unset logscale y\nset format y '%g'\n");
          if (panel.logarithmic_x)
            stream << "set format x '%.0e'\n";
          if (!panel.x_names.empty())
            {
              stream << "set xtics (";
              for (std::size_t i = 0; i < panel.x_names.size(); ++i)
                stream << (i > 0 ? ", " : "") << quoted(panel.x_names[i]) << " " << i + 1;
              stream << ")\nset xrange [0.5:" << panel.x_names.size() + 0.5 << "]\n";
            }
          else
            stream << "set xtics autofreq\nset xrange [*:*]\n";

          std::string separator = "plot ";
          for (const PlotSeries &series : panel.series)
            {
              if (!is_empty(panel, series))
                {
                  stream << separator << "'" << name << ".dat' index " << block << " using 1:2 " << look(series);
                  if (!series.labels.empty())
                    stream << ", '" << name << ".dat' index " << block << " using 1:2:3 with labels offset 0.6,0.5 left font 'Helvetica,9' tc rgb '#444444'";
                  separator = ", \\\n     ";
                  ++block;
                }
            }
          stream << (separator == "plot " ? "unset logscale\nplot [0:1][0:1] NaN\n" : "\n") << "unset label 1000\n";
        }

      if (!key.empty())
        {
          stream << "\nunset title\nunset xlabel\nunset ylabel\nunset logscale\nunset border\nunset tics\nunset grid\n"
                 << "set lmargin at screen 0\nset rmargin at screen 1\nset bmargin at screen 0\nset tmargin at screen " << bottom << "\n"
                 << "set xrange [0:" << per_line << "]\nset yrange [0:" << key_lines << "]\n";
          std::ostringstream marks;
          for (std::size_t k = 0; k < key.size(); ++k)
            {
              const double x = k % per_line, y = key_lines - 0.5 - static_cast<double>(k / per_line);
              stream << "set label " << k + 1 << " " << quoted(key[k]->title) << " at " << x + 0.16 << "," << y << " left\n";
              if (key[k]->style == PlotSeries::Style::lines)
                marks << (k > 0 ? ", \\\n     " : "plot ") << "'+' using ($0 == 0 ? " << x + 0.02 << " : $0 == 1 ? " << x + 0.13
                      << " : NaN):(" << y << ") " << look(*key[k]);
              else
                marks << (k > 0 ? ", \\\n     " : "plot ") << "'+' using ($0 == 0 ? " << x + 0.09 << " : NaN):(" << y << ") " << look(*key[k]);
            }
          stream << marks.str() << "\n";
        }
      stream << "unset multiplot\n";
    }
  } // namespace

  bool write_plot(const std::string &name, const Plot &plot, const ResultFolder &folder)
  {
    folder.write("plots/" + name + ".dat", [&](std::ostream &stream) { write_data(stream, plot); });
    folder.write("plots/" + name + ".gp", [&](std::ostream &stream) { write_script(stream, name, plot); });
    if (!folder.writes_here())
      return true;
    const auto directory = std::filesystem::path(folder.path("plots/" + name + ".gp")).parent_path();
    return std::system(("cd " + shell_quoted(directory.string()) + " && gnuplot " + name + ".gp >/dev/null 2>&1").c_str()) == 0;
  }
} // namespace Squeal
