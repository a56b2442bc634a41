#include <squeal/base/conventions.h>
#include <squeal/studies/sweep_tables.h>

#include <algorithm>
#include <functional>
#include <tuple>

namespace Squeal
{
  Table branch_table(const SweepChart &line, const double largest_circular_frequency)
  {
    struct Row : ModalQuantities
    {
      const ChartPoint &point;
      int               mode; ///< of the point
      int               branch;
      ModeLabel         label;
      bool              is_refinement;
    };
    const StabilityChart &chart = line.chart;
    std::vector<Row>      rows;
    for (std::size_t i = 0; i < chart.points.size(); ++i)
      for (std::size_t b = 0; b < chart.branches.size(); ++b)
        {
          const ChartPoint &point = chart.points[i];
          const int         j     = chart.branches[b].modes[i];
          if (j >= 0 && point.lambda[j].imag() <= largest_circular_frequency)
            rows.push_back({modal_quantities(point.lambda[j]), point, j, static_cast<int>(b + 1), line.labels[b], chart.is_refinement[i]});
        }
    return Table(Columns<Row>{{"mu", "-", [](const Row &row) { return row.point.friction_coefficient; }, 6},
                              {"branch", "-", &Row::branch},
                              {"label", "", &Row::label},
                              {"frequency", "Hz", &Row::frequency, 3},
                              {"growth rate", "1/s", &Row::growth_rate, 4},
                              {"divergence rate", "%", [](const Row &row) { return 100. * row.divergence_rate; }, 4},
                              {"eps_res right", "-", [](const Row &row) { return row.point.right_residuals[row.mode]; }, 1, true},
                              {"eps_res left", "-", [](const Row &row) { return row.point.left_residuals[row.mode]; }, 1, true},
                              {"estimated error of lambda", "-", [](const Row &row) { return row.point.errors[row.mode]; }, 1, true},
                              {"verdict", "", [](const Row &row) { return row.point.verdicts[row.mode]; }},
                              {"refinement", "-", &Row::is_refinement},
                              {"growing", "-", [](const Row &row) { return is_growing(row.point.lambda[row.mode]); }}},
                 rows);
  }

  Table threshold_table(const SweepChart &line)
  {
    using Row                = Threshold;
    const auto partner       = [](const Row &row) { return row.partner >= 0 ? Cell(row.partner + 1) : Cell(); };
    const auto partner_label = [&](const Row &row) { return row.partner >= 0 ? Cell(line.labels[row.partner]) : Cell(); };
    return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 6},
                              {"uncertainty", "-", &Row::uncertainty, 1, true},
                              {"event", "", &Row::event},
                              {"mechanism", "", &Row::mechanism},
                              {"branch", "-", [](const Row &row) { return row.branch + 1; }},
                              {"label", "", [&](const Row &row) { return line.labels[row.branch]; }},
                              {"partner", "-", partner},
                              {"label of partner", "", partner_label},
                              {"frequency", "Hz", [](const Row &row) { return modal_quantities(row.lambda).frequency; }, 3}},
                 line.chart.thresholds);
  }

  Table crossing_table(const SweepChart &line)
  {
    using Row = BandCrossing;
    return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 6},
                              {"uncertainty", "-", &Row::uncertainty, 1, true},
                              {"branch", "-", [](const Row &row) { return row.branch + 1; }},
                              {"label", "", [&](const Row &row) { return line.labels[row.branch]; }},
                              {"direction", "", [](const Row &row) { return row.enters ? "enters" : "leaves"; }},
                              {"edge", "", &Row::edge}},
                 line.chart.crossings);
  }

  Table count_table(const StabilityChart &chart)
  {
    using Row = ChartCount;
    return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 6},
                              {"modes", "-", &Row::n_modes},
                              {"expected", "-", &Row::n_expected},
                              {"overdamped pairs", "-", &Row::n_overdamped}},
                 chart.counts);
  }

  Table map_table(std::vector<MapCell> cells, const MapParameter parameter)
  {
    using Row          = MapCell;
    const bool is_load = parameter == MapParameter::load;
    const auto known   = [](const auto &value) {
      return [value](const Row &row) { return row.leading ? Cell(std::invoke(value, row)) : Cell(); };
    };
    const auto leading = [](double ModalQuantities::*quantity, const double factor = 1.) {
      return [quantity, factor](const Row &row) { return row.leading ? Cell(factor * ((*row.leading).*quantity)) : Cell(); };
    };
    std::sort(cells.begin(), cells.end(), [](const Row &a, const Row &b) {
      return std::tie(a.value, a.friction_coefficient) < std::tie(b.value, b.friction_coefficient);
    });
    return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 4},
                              {is_load ? "load per side" : "rotation speed", is_load ? "N" : "rad/s", &Row::value, 3},
                              {"unstable modes", "-", known(&Row::n_unstable)},
                              {"undecided modes", "-", known(&Row::n_undecided)},
                              {"label", "", known(&Row::label)},
                              {"frequency", "Hz", leading(&ModalQuantities::frequency), 2},
                              {"growth rate", "1/s", leading(&ModalQuantities::growth_rate), 4},
                              {"divergence rate", "%", leading(&ModalQuantities::divergence_rate, 100.), 4},
                              {"estimated error of lambda", "-", known(&Row::error), 1, true},
                              {"open contact nodes", "-", &Row::n_open}},
                 cells);
  }

  Table argument_table(const std::vector<CountAt> &counts)
  {
    using Row = CountAt;
    return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 4},
                              {"modes of the sweep", "-", &Row::n_found},
                              {"modes counted", "-", [](const Row &row) { return row.count.n_modes; }},
                              {"real modes by inertia", "-", [](const Row &row) { return row.count.n_frictionless; }},
                              {"contour points", "-", [](const Row &row) { return row.count.n_points; }},
                              {"largest phase step", "rad", [](const Row &row) { return row.count.largest_phase_step; }, 3},
                              {"truncation bound", "-", [](const Row &row) { return row.count.truncation_bound; }, 1, true}},
                 counts);
  }

  Table contact_table(const SweepPlan &plan, const std::size_t n_pairs)
  {
    struct Row
    {
      double               friction_coefficient;
      const SweepLine     &line;
      const ContactRegime &regime;
    };
    std::vector<Row> rows;
    for (std::size_t l = 0; l < plan.lines.size(); ++l)
      if (plan.lines[l].kind != SweepLine::Kind::without_dissipation)
        for (const double mu : plan.lines[l].friction_coefficients)
          for (const ContactRegime &regime : plan.regimes)
            for (const int i : regime.on_line(static_cast<int>(l)))
              if (regime.points[i].friction_coefficient == mu)
                rows.push_back({mu, plan.lines[l], regime});
    return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 4},
                              {"load per side", "N", [](const Row &row) { return row.line.operation.load_per_side; }, 3},
                              {"rotation speed", "rad/s", [](const Row &row) { return row.line.operation.rotation_speed; }, 3},
                              {"contact set", "-", [](const Row &row) { return row.regime.number; }},
                              {"open contact nodes", "-", [&](const Row &row) { return n_pairs - row.regime.closed.size(); }}},
                 rows);
  }
} // namespace Squeal
