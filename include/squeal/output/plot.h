#pragma once

#include <squeal/output/result_folder.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Points that belong together.
  struct PlotSeries
  {
    enum class Style
    {
      points,
      lines,
      dots
    };

    std::string         title;           ///< in the key; empty: none
    std::vector<double> x, y;            ///< points that are not finite, or not positive on a logarithmic axis, are left out
    Style               style  = Style::points;
    int                 colour = 0;      ///< of the plot's palette
    int                 marker = 0;      ///< of the plot's markers
    std::vector<std::string> labels = {}; ///< beside each point; empty: none
  };

  /// One diagram.
  struct PlotPanel
  {
    std::string              title, x_label, y_label;
    bool                     logarithmic_x = false, logarithmic_y = false;
    std::vector<std::string> x_names = {}; ///< of the abscissae 1, 2, ...; empty: numbers
    std::vector<PlotSeries>  series;
  };

  /// Diagrams beside each other in one picture, with one key.
  struct Plot
  {
    std::string            title;
    std::vector<PlotPanel> panels;
    int                    n_columns = 3;
  };

  /**
   * Writes `plots/NAME.dat` (one block for each series), `plots/NAME.gp` and, if
   * gnuplot is installed, `plots/NAME.svg`; `gnuplot NAME.gp` in that folder draws
   * it again. Returns whether it was drawn. Does nothing but on the root process.
   */
  bool write_plot(const std::string &name, const Plot &plot, const ResultFolder &folder);
} // namespace Squeal
