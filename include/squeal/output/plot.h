#pragma once

#include <squeal/output/result_folder.h>

#include <limits>
#include <string>
#include <vector>

namespace Squeal
{
  /// A rectangle of the plane: its edges, in the units of the axes.
  struct PlotCell
  {
    double left, right, low, high;
  };

  /// Points that belong together.
  struct PlotSeries
  {
    enum class Style
    {
      points,
      lines,
      dots,
      texts, ///< the labels alone
      cells  ///< filled rectangles about the points
    };

    /// Where labels are written, seen from their points.
    enum class Side
    {
      upper_right,
      lower_right,
      upper_left,
      lower_left,
      centre
    };

    std::string         title;           ///< in the key; empty: none
    std::vector<double> x, y;            ///< points that are not finite, or not positive on a logarithmic axis, are left out; lines break there
    Style               style  = Style::points;
    int                 colour = 0;      ///< of the plot's palette
    int                 marker = 0;      ///< of the plot's markers
    std::vector<std::string> labels = {}; ///< beside each point; empty: none
    Side                     side   = Side::upper_right;
    double                   size   = 1.;    ///< of the marks, or width of the lines, relative to the usual one
    bool                     dashed = false; ///< of lines
    std::vector<PlotCell>    cells  = {};    ///< one for each point
    std::vector<double>      values = {};    ///< colour of each cell on the panel's scale; empty: the series' colour
    int                      key_place = 0; ///< titles of lower ones come first in the key
  };

  /// Ends of an axis; those that are not finite follow from the points.
  struct PlotRange
  {
    double first = std::numeric_limits<double>::quiet_NaN(), last = std::numeric_limits<double>::quiet_NaN();
  };

  /// One diagram.
  struct PlotPanel
  {
    std::string              title, x_label, y_label;
    bool                     logarithmic_x = false, logarithmic_y = false;
    std::vector<std::string> x_names = {}; ///< of the abscissae 1, 2, ...; empty: numbers
    std::vector<PlotSeries>  series;
    PlotRange                x_range = {}, y_range = {};
    std::vector<double>      y_ticks      = {};    ///< empty: where gnuplot likes them
    bool                     zero_line    = false; ///< a line along y = 0
    std::string              colour_label = {};    ///< of the scale of cells; empty: no scale
    double                   colour_end   = 1.;    ///< largest value of the scale, which begins at zero
    bool                     counts       = false; ///< whether values of cells are numbers 1, 2, ...
  };

  /// Diagrams beside each other in one picture, with one key.
  struct Plot
  {
    std::string            title;
    std::vector<PlotPanel> panels;
    int                    n_columns   = 3;
    int                    panel_width = 380, panel_height = 330; ///< [pixels]
  };

  /**
   * Writes `plots/NAME.dat` (one block for each series), `plots/NAME.gp` and, if
   * gnuplot is installed, `plots/NAME.svg`; `gnuplot NAME.gp` in that folder draws
   * it again. Returns whether it was drawn. Does nothing but on the root process.
   * Throws Error if a series has labels, cells or values for some of its points only.
   */
  bool write_plot(const std::string &name, const Plot &plot, const ResultFolder &folder);
} // namespace Squeal
