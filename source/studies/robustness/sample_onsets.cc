// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/studies/robustness/robustness.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

namespace Squeal
{
  namespace
  {
    /// Onsets of instability of the modes with one label, over the samples that meet the tolerance.
    struct OnsetDistribution
    {
      std::string         label;           ///< empty: the first onset of any mode
      double              divergence_rate; ///< divergence rate that is exceeded above the onset [-]
      int                 n_samples;       ///< number of samples that meet the tolerance at all points
      std::vector<double> onsets;          ///< onsets of the samples in which the divergence rate is exceeded, ascending
      double              uncertainty;     ///< largest uncertainty of an onset

      /// @p p-quantile over n_samples samples, with infinite onsets in samples without onset; empty if it is infinite.
      Entry quantile_of_all(const double p) const
      {
        std::vector<double> all = onsets;
        all.resize(n_samples, std::numeric_limits<double>::infinity());
        const double result = quantile(all, p);
        return std::isfinite(result) ? Entry(result) : Entry();
      }
    };

    OnsetDistribution distribution(const std::vector<FollowedSample> &followed, const std::string &label, const double divergence_rate)
    {
      OnsetDistribution result{label, divergence_rate, 0, {}, 0.};
      for (const FollowedSample &sample : followed)
        if (sample.n_missed == 0)
          {
            ++result.n_samples;
            if (const SquealOnset *first = sample.first(divergence_rate, label))
              {
                result.onsets.push_back(first->onset.friction_coefficient);
                result.uncertainty = std::max(result.uncertainty, first->onset.uncertainty);
              }
          }
      std::sort(result.onsets.begin(), result.onsets.end());
      return result;
    }

    /// Distributions of the first onset of any mode, then of the onsets of each label, most frequent first; each for both divergence rates.
    std::vector<OnsetDistribution> distributions(const std::vector<FollowedSample> &followed)
    {
      std::set<std::string> labels;
      for (const FollowedSample &sample : followed)
        for (const SquealOnset &onset : sample.onsets)
          labels.insert(to_string(onset.label));
      std::vector<OnsetDistribution> result;
      for (const std::string &label : labels)
        result.push_back(distribution(followed, label, 0.));
      std::stable_sort(result.begin(), result.end(),
                       [](const OnsetDistribution &a, const OnsetDistribution &b) { return a.onsets.size() > b.onsets.size(); });
      result.insert(result.begin(), distribution(followed, "", 0.));
      std::vector<OnsetDistribution> both;
      for (OnsetDistribution &of_growth : result)
        {
          OnsetDistribution of_rate = distribution(followed, of_growth.label, weak_divergence);
          both.push_back(std::move(of_growth));
          both.push_back(std::move(of_rate));
        }
      return both;
    }

    Table distribution_table(const std::vector<OnsetDistribution> &rows, const std::string &parameter)
    {
      using Row          = OnsetDistribution;
      const auto grows   = [](const Row &row) { return probability(static_cast<int>(row.onsets.size()), row.n_samples); };
      const auto percent = [grows](double Estimate::*member) {
        return [grows, member](const Row &row) { return 100. * (grows(row).*member); };
      };
      const auto of_all  = [](const double p) { return [p](const Row &row) { return row.quantile_of_all(p); }; };
      const auto of_some = [](double (*statistic)(const std::vector<double> &)) {
        return [statistic](const Row &row) { return row.onsets.empty() ? Entry() : Entry(statistic(row.onsets)); };
      };
      return Table(Columns<Row>{{"label", "", [](const Row &row) { return row.label.empty() ? "all modes" : row.label; }},
                                {"divergence rate beyond", "%", [](const Row &row) { return 100. * row.divergence_rate; }, 2},
                                {"samples", "-", &Row::n_samples},
                                {"samples with an onset", "%", percent(&Estimate::value), 2},
                                {"lower confidence limit", "%", percent(&Estimate::lower), 2},
                                {"upper confidence limit", "%", percent(&Estimate::upper), 2},
                                {parameter + " of 5 % of all samples", "-", of_all(0.05), 5},
                                {parameter + " of 25 % of all samples", "-", of_all(0.25), 5},
                                {parameter + " of 50 % of all samples", "-", of_all(0.5), 5},
                                {parameter + " of 75 % of all samples", "-", of_all(0.75), 5},
                                {parameter + " of 95 % of all samples", "-", of_all(0.95), 5},
                                {"mean of the onsets", "-", of_some(mean), 5},
                                {"deviation of the onsets", "-", of_some(deviation), 5},
                                {"largest uncertainty of an onset", "-", &Row::uncertainty, 1, true}},
                   rows);
    }

    Table sample_onset_table(const std::vector<FollowedSample> &followed, const std::string &parameter)
    {
      using Row        = int;
      const auto first = [&followed](const double rate, auto value) {
        return [&followed, rate, value](const Row &s) -> Entry {
          const SquealOnset *onset = followed[s].first(rate);
          return onset != nullptr && followed[s].n_missed == 0 ? Entry(value(*onset)) : Entry();
        };
      };
      Columns<Row> columns = {{"sample", "-", [](const Row &s) { return s + 1; }},
                              {"values that miss the tolerance", "-", [&followed](const Row &s) { return followed[s].n_missed; }}};
      for (const auto &[rate, name] : {std::make_pair(0., std::string("growth")), {weak_divergence, text(100. * weak_divergence, " %")}})
        {
          columns.push_back(
            {parameter + " of " + name, "-", first(rate, [](const SquealOnset &first) { return first.onset.friction_coefficient; }), 6});
          columns.push_back({"uncertainty of " + parameter + " of " + name, "-",
                             first(rate, [](const SquealOnset &first) { return first.onset.uncertainty; }), 1, true});
          columns.push_back({"label of " + name, "", first(rate, [](const SquealOnset &first) { return to_string(first.label); })});
          columns.push_back({"frequency of " + name, "Hz",
                             first(rate, [](const SquealOnset &first) { return modal_quantities(first.onset.lambda).frequency; }), 2});
        }
      std::vector<Row> all(followed.size());
      std::iota(all.begin(), all.end(), 0);
      return Table(columns, all);
    }

    Table mode_onset_table(const std::vector<FollowedSample> &followed, const std::string &parameter)
    {
      using Row = std::pair<int, const SquealOnset *>;
      std::vector<Row> rows;
      for (std::size_t s = 0; s < followed.size(); ++s)
        for (const SquealOnset &onset : followed[s].onsets)
          rows.emplace_back(static_cast<int>(s) + 1, &onset);
      return Table(
        Columns<Row>{{"sample", "-", [](const Row &row) { return row.first; }},
                     {"label", "", [](const Row &row) { return to_string(row.second->label); }},
                     {"divergence rate beyond", "%", [](const Row &row) { return 100. * row.second->divergence_rate; }, 2},
                     {parameter, "-", [](const Row &row) { return row.second->onset.friction_coefficient; }, 6},
                     {"uncertainty of " + parameter, "-", [](const Row &row) { return row.second->onset.uncertainty; }, 1, true},
                     {"frequency", "Hz", [](const Row &row) { return modal_quantities(row.second->onset.lambda).frequency; }, 2}},
        rows);
    }
  } // namespace

  const SquealOnset *FollowedSample::first(const double divergence_rate, const std::string &label) const
  {
    const SquealOnset *result = nullptr;
    for (const SquealOnset &onset : onsets)
      if (onset.divergence_rate == divergence_rate && (label.empty() || to_string(onset.label) == label) &&
          (result == nullptr || onset.onset.friction_coefficient < result->onset.friction_coefficient))
        result = &onset;
    return result;
  }

  void follow_samples(SweepModel &model, const std::size_t n_samples, std::vector<FollowedSample> &followed)
  {
    if (followed.empty())
      return;
    Run                        &run = model.run;
    ErrorControlledSweepOptions options;
    options.tolerance                           = run.parameters.sweep.tolerance;
    options.maximum_basis                       = static_cast<int>(run.parameters.sweep.maximum_basis);
    const std::vector<OperatingPoint> &all      = model.regime.points;
    std::size_t                        n_onsets = 0, n_missed = 0;
    std::string                        why_stopped;
    run.progress.begin("Onsets");
    for (int s = 0; s < static_cast<int>(followed.size()); ++s)
      {
        std::vector<OperatingPoint> points;
        std::copy_if(all.begin() + static_cast<std::ptrdiff_t>(n_samples), all.end(), std::back_inserter(points),
                     [s](const OperatingPoint &point) { return point.line == s; });
        if (points.empty())
          continue;
        const auto keep = [&](const int i, ChartPoint &&point) {
          model.known.emplace(std::make_pair(s, points[i].friction_coefficient), std::move(point));
        };
        const ErrorControlledSweep found =
          model.reduced ? error_controlled_sweep(*model.reduced, points, {}, options, keep, run.communicator, run.progress) :
                          solve_directly(model, points, keep);
        if (!found.why_stopped.empty())
          why_stopped = found.why_stopped;
        followed[s].n_missed += found.n_left;
        n_missed += found.n_left;
        const std::vector<SquealOnset> onsets = mode_onsets(model, s);
        followed[s].onsets.insert(followed[s].onsets.end(), onsets.begin(), onsets.end());
        n_onsets += onsets.size();
        model.known.clear(); // the vectors of all samples may exceed the memory
      }
    const std::string how = model.reduced ? counted(model.reduced->size(), "vector") : "full order";
    run.progress.finish(text(counted(followed.size(), "sample"), ", ", how, ", ", counted(n_onsets, "onset")));
    if (n_missed > 0)
      run.warn(text(counted(n_missed, "operating point"), " of the followed samples did not meet the tolerance of ", options.tolerance,
                    ": ", why_stopped, "; samples with such points are excluded from the distributions of onsets. Raise ",
                    "Sweep/Tolerance, or raise Sweep/Maximum basis if the basis has reached this limit"));
  }

  void write_onsets(const std::vector<FollowedSample> &followed, const std::string &parameter, Run &run)
  {
    const std::vector<OnsetDistribution> rows = distributions(followed);
    run.count("samples with onsets", rows.front().n_samples);
    run.store_table("sample_onsets", sample_onset_table(followed, parameter));
    run.store_table("mode_onsets", mode_onset_table(followed, parameter));
    if (rows.front().n_samples == 0)
      return;
    run.write_table("onset_distributions", distribution_table(rows, parameter));
  }
} // namespace Squeal
