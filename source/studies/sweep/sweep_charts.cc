// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/studies/sweep/sweep_charts.h>

namespace Squeal
{
  namespace
  {
    /// Known friction coefficients of a line in the contact set of the model, split where values are missing.
    std::vector<std::vector<double>> stretches(const SweepModel &model, const int line)
    {
      std::vector<std::vector<double>> result;
      bool                             goes_on = false;
      for (const double mu : model.plan.lines[line].friction_coefficients)
        {
          const bool is_known = model.known.count({line, mu}) > 0;
          if (is_known && !goes_on)
            result.emplace_back();
          if (is_known)
            result.back().push_back(mu);
          goes_on = is_known;
        }
      return result;
    }

    /// Extends the basis by the missing components of the modes on both sides of all thresholds of an unrefined chart. Discards the results
    /// at these points, which were computed with the smaller basis.
    void sharpen(SweepModel &model, const int line, const StabilityChart &chart, const std::vector<double> &grid)
    {
      // Use grid values next to the thresholds, because closer to a coalescence the vectors of both modes are nearly parallel
      std::map<int, std::set<int>> modes_at; // by index of the point in the chart
      for (const Threshold &threshold : chart.thresholds)
        {
          const int above = std::upper_bound(grid.begin(), grid.end(), threshold.friction_coefficient) - grid.begin();
          for (const int i : {above - 1, above})
            for (const int branch : {threshold.branch, threshold.partner})
              if (i >= 0 && i < static_cast<int>(grid.size()) && branch >= 0 && chart.branches[branch].modes[i] >= 0)
                modes_at[i].insert(chart.branches[branch].modes[i]);
        }
      std::vector<ChartModel::ModesAt> sets;
      for (const auto &[i, modes] : modes_at)
        sets.push_back({model.plan.point(line, grid[i], model.regime.closed), &chart.points[i], {modes.begin(), modes.end()}});
      if (sets.empty())
        return;
      auto vectors = model.reduced->new_vectors(sets);
      if (!vectors || model.reduced->size() + vectors->n_columns() > static_cast<int>(model.run.parameters.sweep.maximum_basis))
        return;
      model.reduced->extend(*std::move(vectors));
      for (const ChartModel::ModesAt &set : sets)
        model.known.erase({line, set.point.friction_coefficient});
    }

    /// Labels branches by their first modes; the branch of a doublet with the largest growth over the chart is labelled +.
    std::vector<ModeLabel> branch_labels(const SweepModel &model, const StabilityChart &chart)
    {
      const int                       n_branches = chart.branches.size();
      std::vector<ModeLabel>          result(n_branches);
      std::vector<double>             growth(n_branches, 0.); // largest growth rate [1/s]; zero for a branch that never grows
      std::map<int, std::vector<int>> branches_from;          // branches by the index of their first point
      for (int b = 0; b < n_branches; ++b)
        {
          const std::vector<int> &modes = chart.branches[b].modes;
          branches_from[chart.branches[b].begin()].push_back(b);
          for (std::size_t i = 0; i < modes.size(); ++i)
            if (modes[i] >= 0 && chart.points[i].verdicts[modes[i]] == Verdict::unstable)
              growth[b] = std::max(growth[b], chart.points[i].lambda[modes[i]].real());
        }
      for (const auto &[i, branches] : branches_from)
        {
          std::vector<int>    modes;
          std::vector<double> growth_here;
          for (const int b : branches)
            {
              modes.push_back(chart.branches[b].modes[i]);
              growth_here.push_back(growth[b]);
            }
          std::vector<ModeLabel> labels = model.labels(chart.points[i], modes);
          mark_doublets(labels, growth_here);
          for (std::size_t k = 0; k < branches.size(); ++k)
            result[branches[k]] = labels[k];
        }
      return result;
    }

    /// Largest known friction coefficient on a line below @p first, for any contact set; 0: none.
    double value_before(const SweepModel &model, const int line, const double first)
    {
      double result = 0.;
      for (const ContactRegime &regime : model.plan.regimes)
        for (const OperatingPoint &point : regime.points)
          if (const double mu = point.friction_coefficient;
              point.line == line && mu < first && (&regime != &model.regime || model.known.count({line, mu}) > 0))
            result = std::max(result, mu);
      return result;
    }

    ChartOptions options_of(const SweepModel &model)
    {
      ChartOptions result;
      result.largest_circular_frequency = model.largest_circular_frequency;
      result.threshold_tolerance        = model.run.parameters.sweep.threshold_tolerance;
      return result;
    }

    /// Function that evaluates the modes of a line for its chart.
    EvaluateChart evaluation(SweepModel &model, const int line)
    {
      return [&model, line](const std::vector<double> &friction_coefficients) { return model.evaluate(line, friction_coefficients); };
    }

    /// Chart of a line over known friction coefficients.
    StabilityChart chart_of(SweepModel &model, const int line, const std::vector<double> &grid, const EvaluateChart &evaluate)
    {
      const auto        at      = [&](const double mu) { return model.plan.point(line, mu, model.regime.closed); };
      const PredictZero predict = model.reduced ? zero_predictor(*model.reduced, at, model.run.communicator) : PredictZero();
      return stability_chart(grid, evaluate, options_of(model), predict);
    }

    /// Compares the number of modes without friction with the count by inertia.
    void compare_with_inertia(const SweepModel &model, const StabilityChart &chart)
    {
      Progress             &progress = model.run.progress;
      const SymmetricModes &real     = model.frictionless.real;
      const double          limit    = model.largest_circular_frequency * model.largest_circular_frequency;
      const int             n_real   = static_cast<int>(n_in_band(real.eigenvalues, limit)) - real.n_rigid_body;
      const ChartCount     &first    = chart.counts.front();
      if (first.friction_coefficient != 0.)
        progress.note("  note: the number of modes is not compared with a count by inertia, because these branches do not begin at mu = 0");
      else if (first.n_modes + first.n_overdamped != n_real)
        progress.note(text("  note: the band contains ", counted(first.n_modes, "mode"), " at mu = 0, but ", counted(n_real, "real mode"),
                           " without damping; damping may have moved modes across the end of the band"));
      const auto n =
        std::count_if(chart.counts.begin(), chart.counts.end(), [](const ChartCount &count) { return count.n_modes != count.n_expected; });
      if (n > 0)
        progress.note(text("  note: at ", counted(n, "point"), ", the number of modes differs from the expected number (counts.csv)"));
    }
  } // namespace

  SweepChart follow_branches(SweepModel &model, const int line, const std::vector<double> &grid)
  {
    Run        &run         = model.run;
    std::size_t n_evaluated = 0;
    const auto  evaluate    = [&, known = evaluation(model, line)](const std::vector<double> &friction_coefficients) {
      n_evaluated += friction_coefficients.size();
      run.progress.update(counted(n_evaluated, "point"));
      return known(friction_coefficients);
    };
    run.progress.begin("Branches");
    const ChartOptions options = options_of(model);
    // Extend the basis for thresholds, because μ_c of weakly interacting modes is sensitive to small errors. All thresholds on the grid are
    // included, because a selection by uncertainty would depend on rounding errors
    ChartOptions coarse        = options;
    coarse.maximum_refinements = 0;
    if (model.reduced && model.sharpens_thresholds)
      sharpen(model, line, stability_chart(grid, evaluate, coarse), grid);
    SweepChart            result{chart_of(model, line, grid, evaluate), {}, {}, {}};
    const StabilityChart &chart  = result.chart;
    const double          before = grid.empty() ? 0. : value_before(model, line, grid.front());
    result.labels                = branch_labels(model, chart);
    result.onset                 = first_onset(chart, options.largest_circular_frequency, before);
    result.weak_onset            = onset_beyond(weak_divergence, chart, evaluate, options, before);
    run.progress.finish(text(counted(chart.branches.size(), "branch", "branches"), ", ", counted(chart.thresholds.size(), "threshold"),
                             ", ", counted(chart.crossings.size(), "crossing"), " of the end of the band, ",
                             counted(chart.points.size() - grid.size(), "refinement")));
    if (chart.n_doubtful_steps > 0)
      run.progress.note(
        text("  note: in ", counted(chart.n_doubtful_steps, "step"), ", modes could be distinguished only by their frequencies"));
    return result;
  }

  void follow_branches(SweepModel &model, std::vector<std::vector<SweepChart>> &charts)
  {
    for (std::size_t l = 0; l < charts.size(); ++l)
      if (const auto kind = model.plan.lines[l].kind; kind != SweepLine::Kind::map)
        for (const auto &stretch : stretches(model, static_cast<int>(l)))
          {
            charts[l].push_back(follow_branches(model, static_cast<int>(l), stretch));
            if (kind == SweepLine::Kind::main && model.plan.scene != nullptr)
              compare_with_inertia(model, charts[l].back().chart);
          }
  }

  std::vector<SquealOnset> mode_onsets(SweepModel &model, const int line)
  {
    const EvaluateChart                                   evaluate = evaluation(model, line);
    const ChartOptions                                    options  = options_of(model);
    std::map<std::pair<std::string, double>, SquealOnset> first; // first onset by label and divergence rate
    for (const std::vector<double> &grid : stretches(model, line))
      {
        const StabilityChart         chart  = chart_of(model, line, grid, evaluate);
        const std::vector<ModeLabel> labels = branch_labels(model, chart);
        const double                 before = value_before(model, line, grid.front());
        for (int b = 0; b < static_cast<int>(labels.size()); ++b)
          for (const auto &[rate, onset] : {std::make_pair(0., onset_of(b, chart, options.largest_circular_frequency, before)),
                                            {weak_divergence, onset_beyond(weak_divergence, chart, evaluate, options, before, b)}})
            if (onset)
              {
                const auto [known, is_new] = first.try_emplace({to_string(labels[b]), rate}, SquealOnset{rate, *onset, labels[b]});
                if (!is_new && onset->friction_coefficient < known->second.onset.friction_coefficient)
                  known->second.onset = *onset;
              }
      }
    std::vector<SquealOnset> result;
    for (auto &[key, onset] : first)
      result.push_back(std::move(onset));
    return result;
  }

  std::vector<SquealOnset> squeal_onsets(const std::vector<SweepChart> &charts)
  {
    std::vector<SquealOnset> result;
    for (const auto &[rate, onset] : {std::make_pair(0., &SweepChart::onset), {weak_divergence, &SweepChart::weak_onset}})
      {
        const SweepChart *first = nullptr;
        for (const SweepChart &chart : charts)
          if (chart.*onset && (!first || (chart.*onset)->friction_coefficient < (first->*onset)->friction_coefficient))
            first = &chart;
        if (first)
          result.push_back({rate, *(first->*onset), first->labels[(first->*onset)->branch]});
      }
    return result;
  }

  std::string verdict(const std::vector<SweepChart> &charts,
                      const std::size_t              n_asked,
                      const double                   largest_circular_frequency,
                      const std::string             &parameter)
  {
    double          at = 0.; // friction coefficient of the fastest growing mode
    ModalQuantities most{};
    std::string     label;
    std::size_t     n_known = 0; // number of requested values that are known
    for (const SweepChart &line : charts)
      {
        const StabilityChart &chart = line.chart;
        n_known += std::count(chart.is_refinement.begin(), chart.is_refinement.end(), false);
        for (std::size_t i = 0; i < chart.points.size(); ++i)
          for (std::size_t b = 0; b < line.labels.size(); ++b)
            if (const ChartPoint &point = chart.points[i]; chart.branches[b].modes[i] >= 0)
              if (const int j = chart.branches[b].modes[i];
                  point.lambda[j].imag() <= largest_circular_frequency && point.verdicts[j] == Verdict::unstable)
                if (const auto mode = modal_quantities(point.lambda[j]); label.empty() || mode.divergence_rate > most.divergence_rate)
                  {
                    at    = point.friction_coefficient;
                    most  = mode;
                    label = to_string(line.labels[b]);
                  }
      }
    const std::vector<SquealOnset> onsets = squeal_onsets(charts);
    if (onsets.empty())
      return n_known == n_asked ? "  stable: no mode of the band grows at any value of the sweep" :
                                  text("  no mode of the band grows at ", n_known, " of ", n_asked,
                                       " values; the other values have no results within the tolerance");
    std::string result = "  squeal";
    for (const auto &[rate, onset, of_onset] : onsets)
      {
        // Report an uncertainty that is visible in the digits shown
        const bool is_uncertain = onset.uncertainty > 1e-3 * onset.friction_coefficient;
        result += text(rate > 0. ? text(", divergence rate exceeds ", 100. * rate, " %") : " begins", " at ", parameter, " = ",
                       onset.friction_coefficient, is_uncertain ? text(" +- ", onset.uncertainty) : "", " (", to_string(of_onset), ")");
      }
    return text(result, "; largest divergence rate at ", parameter, " = ", at, ": ", label, " at ", decimal_text(most.frequency),
                " Hz with ", decimal_text(100. * most.divergence_rate), " %");
  }
} // namespace Squeal
