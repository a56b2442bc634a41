// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/studies/steps/mode_results.h>
#include <squeal/studies/sweep/sweep_charts.h>

namespace Squeal
{
  namespace
  {
    /// One row for every mode of the band at every point of a chart, including refinement points.
    Table branch_table(const SweepChart &line, const double largest_circular_frequency, const SweepAxis &axis)
    {
      struct Row : ModalQuantities
      {
        const ChartPoint &point;
        int               mode; ///< index of the mode at the point
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
              rows.push_back(
                {modal_quantities(point.lambda[j]), point, j, static_cast<int>(b + 1), line.labels[b], chart.is_refinement[i]});
          }
      return Table(
        Columns<Row>{{axis.name, axis.unit, [](const Row &row) { return row.point.friction_coefficient; }, 6},
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
                     {"growing", "-", [](const Row &row) { return verdict_of(row.point.lambda[row.mode]) == Verdict::unstable; }}},
        rows);
    }

    Table threshold_table(const SweepChart &line, const SweepAxis &axis)
    {
      using Row                = Threshold;
      const auto partner       = [](const Row &row) { return row.partner >= 0 ? Entry(row.partner + 1) : Entry(); };
      const auto partner_label = [&](const Row &row) { return row.partner >= 0 ? Entry(line.labels[row.partner]) : Entry(); };
      return Table(Columns<Row>{{axis.name, axis.unit, &Row::friction_coefficient, 6},
                                {"uncertainty", "-", &Row::uncertainty, 1, true},
                                {"event", "", &Row::event},
                                {"mechanism", "", &Row::mechanism},
                                {"branch", "-", [](const Row &row) { return row.branch + 1; }},
                                {"label", "", [&](const Row &row) { return line.labels[row.branch]; }},
                                {"partner", "-", partner},
                                {"partner label", "", partner_label},
                                {"frequency", "Hz", [](const Row &row) { return modal_quantities(row.lambda).frequency; }, 3}},
                   line.chart.thresholds);
    }

    Table crossing_table(const SweepChart &line, const SweepAxis &axis)
    {
      using Row = BandCrossing;
      return Table(Columns<Row>{{axis.name, axis.unit, &Row::friction_coefficient, 6},
                                {"uncertainty", "-", &Row::uncertainty, 1, true},
                                {"branch", "-", [](const Row &row) { return row.branch + 1; }},
                                {"label", "", [&](const Row &row) { return line.labels[row.branch]; }},
                                {"direction", "", [](const Row &row) { return row.enters ? "enters" : "leaves"; }},
                                {"edge", "", &Row::edge}},
                   line.chart.crossings);
    }

    /// Number of modes in the band at every point, and the number expected from the crossings.
    Table count_table(const StabilityChart &chart, const SweepAxis &axis)
    {
      using Row = ChartCount;
      return Table(Columns<Row>{{axis.name, axis.unit, &Row::friction_coefficient, 6},
                                {"modes", "-", &Row::n_modes},
                                {"expected", "-", &Row::n_expected},
                                {"overdamped pairs", "-", &Row::n_overdamped}},
                   chart.counts);
    }
  } // namespace

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

  void write_charts(const SweepPlan &plan, const std::vector<std::vector<SweepChart>> &charts, const double omega_max, Run &run)
  {
    for (std::size_t l = 0; l < charts.size(); ++l)
      for (std::size_t s = 0; s < charts[l].size(); ++s)
        {
          const SweepChart &chart   = charts[l][s];
          const bool        is_main = plan.lines[l].kind == SweepLine::Kind::main;
          const std::string suffix  = (is_main ? "" : "_without_dissipation") + (s > 0 ? text("_", s + 1) : "");
          run.store_table("branches" + suffix, branch_table(chart, omega_max, plan.axis));
          run.store_table("counts" + suffix, count_table(chart.chart, plan.axis));
          run.write_table("thresholds" + suffix, threshold_table(chart, plan.axis));
          const bool crosses = !chart.chart.crossings.empty();
          (run.*(crosses ? &Run::write_table : &Run::store_table))("band_crossings" + suffix, crossing_table(chart, plan.axis));
        }
  }
} // namespace Squeal
