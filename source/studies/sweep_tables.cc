#include <squeal/base/conventions.h>
#include <squeal/studies/sweep_tables.h>

#include <algorithm>

namespace Squeal
{
  Table branch_table(const StabilityChart &chart, const std::vector<std::string> &labels, const double largest_circular_frequency)
  {
    Table table({{"mu", "-", 6},
                 {"branch", "-"},
                 {"label", ""},
                 {"frequency", "Hz", 3},
                 {"growth rate", "1/s", 4},
                 {"divergence rate", "%", 4},
                 {"eps_res right", "-", 1, true},
                 {"eps_res left", "-", 1, true},
                 {"estimated error of lambda", "-", 1, true},
                 {"verdict", ""},
                 {"refinement", "-"},
                 {"growing", "-"}});
    for (std::size_t i = 0; i < chart.points.size(); ++i)
      for (std::size_t b = 0; b < chart.branches.size(); ++b)
        {
          const ChartPoint &point = chart.points[i];
          const int         j     = chart.branches[b].modes[i];
          if (j < 0 || point.lambda[j].imag() > largest_circular_frequency)
            continue;
          const ModalQuantities mode = modal_quantities(point.lambda[j]);
          table.add_row({point.friction_coefficient, static_cast<long>(b + 1), labels[b], mode.frequency, mode.growth_rate,
                         100. * mode.divergence_rate, point.right_residuals[j], point.left_residuals[j], point.errors[j],
                         to_string(point.verdicts[j]), static_cast<long>(chart.is_refinement[i]),
                         static_cast<long>(is_growing(point.lambda[j]))});
        }
    return table;
  }

  Table threshold_table(const StabilityChart &chart, const std::vector<std::string> &labels)
  {
    Table table({{"mu", "-", 6},
                 {"uncertainty", "-", 1, true},
                 {"event", ""},
                 {"mechanism", ""},
                 {"branch", "-"},
                 {"label", ""},
                 {"partner", "-"},
                 {"label of partner", ""},
                 {"frequency", "Hz", 3}});
    for (const Threshold &threshold : chart.thresholds)
      {
        const bool is_pair = threshold.partner >= 0;
        table.add_row({threshold.friction_coefficient, threshold.uncertainty, to_string(threshold.event), to_string(threshold.mechanism),
                       static_cast<long>(threshold.branch + 1), labels[threshold.branch],
                       is_pair ? Cell(static_cast<long>(threshold.partner + 1)) : Cell(),
                       is_pair ? Cell(labels[threshold.partner]) : Cell(), modal_quantities(threshold.lambda).frequency});
      }
    return table;
  }

  Table crossing_table(const StabilityChart &chart, const std::vector<std::string> &labels)
  {
    Table table({{"mu", "-", 6}, {"uncertainty", "-", 1, true}, {"branch", "-"}, {"label", ""}, {"direction", ""}, {"edge", ""}});
    for (const BandCrossing &crossing : chart.crossings)
      table.add_row({crossing.friction_coefficient, crossing.uncertainty, static_cast<long>(crossing.branch + 1), labels[crossing.branch],
                     std::string(crossing.enters ? "enters" : "leaves"), to_string(crossing.edge)});
    return table;
  }

  Table count_table(const StabilityChart &chart)
  {
    Table table({{"mu", "-", 6}, {"modes", "-"}, {"expected", "-"}, {"overdamped pairs", "-"}});
    for (const ModeCount &count : chart.counts)
      table.add_row({count.friction_coefficient, static_cast<long>(count.n_modes), static_cast<long>(count.n_expected),
                     static_cast<long>(count.n_overdamped)});
    return table;
  }

  std::size_t n_incomplete(const StabilityChart &chart)
  {
    return std::count_if(chart.counts.begin(), chart.counts.end(),
                         [](const ModeCount &count) { return count.n_modes != count.n_expected; });
  }
} // namespace Squeal
