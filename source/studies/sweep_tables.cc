#include <squeal/base/conventions.h>
#include <squeal/studies/sweep_tables.h>

#include <algorithm>

namespace Squeal
{
  Table branch_table(const StabilityChart &chart, const std::vector<ModeLabel> &labels, const double largest_circular_frequency)
  {
    struct Row : ModalQuantities
    {
      const ChartPoint &point;
      int               mode; ///< of the point
      int               branch;
      ModeLabel         label;
      bool              is_refinement;
    };
    std::vector<Row> rows;
    for (std::size_t i = 0; i < chart.points.size(); ++i)
      for (std::size_t b = 0; b < chart.branches.size(); ++b)
        {
          const ChartPoint &point = chart.points[i];
          const int         j     = chart.branches[b].modes[i];
          if (j >= 0 && point.lambda[j].imag() <= largest_circular_frequency)
            rows.push_back({modal_quantities(point.lambda[j]), point, j, static_cast<int>(b + 1), labels[b], chart.is_refinement[i]});
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

  Table threshold_table(const StabilityChart &chart, const std::vector<ModeLabel> &labels)
  {
    using Row                = Threshold;
    const auto partner       = [](const Row &row) { return row.partner >= 0 ? Cell(row.partner + 1) : Cell(); };
    const auto partner_label = [&](const Row &row) { return row.partner >= 0 ? Cell(labels[row.partner]) : Cell(); };
    return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 6},
                              {"uncertainty", "-", &Row::uncertainty, 1, true},
                              {"event", "", &Row::event},
                              {"mechanism", "", &Row::mechanism},
                              {"branch", "-", [](const Row &row) { return row.branch + 1; }},
                              {"label", "", [&](const Row &row) { return labels[row.branch]; }},
                              {"partner", "-", partner},
                              {"label of partner", "", partner_label},
                              {"frequency", "Hz", [](const Row &row) { return modal_quantities(row.lambda).frequency; }, 3}},
                 chart.thresholds);
  }

  Table crossing_table(const StabilityChart &chart, const std::vector<ModeLabel> &labels)
  {
    using Row = BandCrossing;
    return Table(Columns<Row>{{"mu", "-", &Row::friction_coefficient, 6},
                              {"uncertainty", "-", &Row::uncertainty, 1, true},
                              {"branch", "-", [](const Row &row) { return row.branch + 1; }},
                              {"label", "", [&](const Row &row) { return labels[row.branch]; }},
                              {"direction", "", [](const Row &row) { return row.enters ? "enters" : "leaves"; }},
                              {"edge", "", &Row::edge}},
                 chart.crossings);
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

  std::size_t n_incomplete(const StabilityChart &chart)
  {
    return std::count_if(chart.counts.begin(), chart.counts.end(),
                         [](const ChartCount &count) { return count.n_modes != count.n_expected; });
  }
} // namespace Squeal
