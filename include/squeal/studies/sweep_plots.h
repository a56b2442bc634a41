#pragma once

#include <squeal/output/plot.h>
#include <squeal/stability/branches.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Modes over the friction coefficient at one load and speed, with the names of the branches.
  struct ChartLine
  {
    std::string              title; ///< "without radial dissipation", "with ..."
    StabilityChart           chart;
    std::vector<std::string> labels; ///< one for each branch: "A0-4 -", "F1", ...
  };

  /// A plot and the name of its files.
  struct NamedPlot
  {
    std::string name;
    Plot        plot;
  };

  /// Label of a branch without the sign of its doublet: `A0-4` of `A0-4 -`.
  std::string branch_family(const std::string &label);

  /**
   * The complex plane at some friction coefficients, as in figure 6 of the paper:
   * divergence rate [%] over frequency [kHz], a panel for each coefficient, at the
   * point of each chart nearest to it. The first line is black, the second grey.
   * Growing modes have a ring and a label, modes whose growth is undecided at the
   * accuracy of the reduction a square. Modes that decay much faster than any grows would
   * squeeze the others: they are marked at the lower edge.
   *
   * @param largest_frequency end of the band [rad/s]
   *
   * Throws Error if a line has not one label for each branch.
   */
  Plot complex_plane_plot(const std::vector<ChartLine> &lines,
                          const std::vector<double>    &friction_coefficients,
                          double                        largest_frequency);

  /**
   * Coalescences, as in figures 7 to 9 of the paper: frequency [Hz] and below it divergence rate [%]
   * over the friction coefficient, for every family of branches of which one grows
   * somewhere in one of the lines, together with branches of other families that they
   * coalesce with. Families are ascending by frequency, three to a plot. Of
   * branches without a name only those that grow are shown. Growing parts are thick and coloured;
   * a branch breaks where it is not in the list of modes or beyond the band.
   *
   * @param largest_frequency end of the band [rad/s]
   *
   * Throws Error if a line has not one label for each branch.
   */
  std::vector<NamedPlot> frequency_plots(const std::vector<ChartLine> &lines, double largest_frequency);

  /**
   * All modes of the band: frequency [Hz] and divergence rate [%] over the friction coefficient.
   *
   * @param largest_frequency end of the band [rad/s]
   *
   * Throws Error if a line has not one label for each branch.
   */
  Plot overview_plot(const std::vector<ChartLine> &lines, double largest_frequency);

  /// What is known about stability at one friction coefficient and one load or speed.
  struct MapCell
  {
    double      friction_coefficient = 0.;    ///< [-]
    double      value                = 0.;    ///< of the ordinate
    double      growth_rate          = 0.;    ///< of the most unstable mode [1/s]
    double      divergence_rate      = 0.;    ///< of the most unstable mode [-]
    double      frequency            = 0.;    ///< of the most unstable mode [Hz]
    int         n_unstable           = 0;
    int         n_undecided          = 0;     ///< modes whose growth is undecided
    int         n_open               = 0;     ///< contact nodes that are lifted
    std::string leader;                       ///< label of the most unstable mode
    bool        is_known             = false; ///< whether it was computed
    double      error                = 0.;    ///< largest estimated |δλ| / |λ| [-]
  };

  /// Stability over friction coefficient and load or speed.
  struct StabilityMap
  {
    std::string          title;
    std::vector<double>  friction_coefficients; ///< ascending
    std::vector<double>  ordinates;             ///< ascending and positive
    std::string          ordinate_name;         ///< "load", "speed"
    std::string          ordinate_unit;         ///< "N", "rad/s"
    std::vector<MapCell> cells;                 ///< all friction coefficients of the first ordinate, then of the second, ...
  };

  /**
   * Divergence rate [%] of the most unstable mode, and number of unstable modes, as colours over friction
   * coefficient and, logarithmic, load or speed. Cells reach half-way to
   * their neighbours. Stable ones are white, undecided ones grey. Lines: the
   * limit of stability (thick), a change of the most unstable mode (thin), of the contact set (dashed).
   *
   * Throws Error if the axes are empty or not ascending, an ordinate is not positive or cells are missing.
   */
  Plot map_plot(const StabilityMap &map);
} // namespace Squeal
