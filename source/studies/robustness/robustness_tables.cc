// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/studies/robustness/robustness.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace Squeal
{
  namespace
  {
    using Samples = std::vector<std::optional<Sample>>;

    double divergence_rate(const SampledMode &mode)
    {
      return modal_quantities(mode.lambda).divergence_rate;
    }

    bool is_within(const SampledMode &mode, const double first, const double last)
    {
      const double frequency = modal_quantities(mode.lambda).frequency;
      return frequency >= first && frequency < last;
    }

    /// Probability of squeal in a band.
    struct BandProbability
    {
      double   first, last; ///< [Hz]
      Estimate squeal;
      double   undecided; ///< fraction of samples without results, or with undecided but no unstable modes [-]
    };

    BandProbability band_probability(const SamplePlan &plan, const Samples &samples, const double first, const double last)
    {
      int n_unstable = 0, n_undecided = 0;
      for (int s = 0; s < plan.n_independent; ++s)
        {
          const auto has = [&](const Verdict verdict) {
            return std::any_of(samples[s]->begin(), samples[s]->end(),
                               [&](const SampledMode &mode) { return mode.verdict == verdict && is_within(mode, first, last); });
          };
          if (!samples[s])
            ++n_undecided;
          else if (has(Verdict::unstable))
            ++n_unstable;
          else if (has(Verdict::undecided))
            ++n_undecided;
        }
      return {first, last, probability(n_unstable, plan.n_independent), static_cast<double>(n_undecided) / plan.n_independent};
    }

    std::vector<BandProbability> band_probabilities(const SamplePlan &plan, const Samples &samples, const Parameters &parameters)
    {
      const double                 end    = parameters.discretization.maximum_frequency;
      std::vector<BandProbability> result = {band_probability(plan, samples, 0., std::nextafter(end, 2. * end))};
      result.front().last                 = end;
      const auto &ends                    = parameters.robustness.frequency_bands;
      for (std::size_t i = 1; i < ends.size(); ++i)
        result.push_back(band_probability(plan, samples, ends[i - 1], ends[i]));
      return result;
    }

    Table probability_table(const std::vector<BandProbability> &bands)
    {
      using Row = BandProbability;
      return Table(Columns<Row>{{"from", "Hz", &Row::first, 0},
                                {"to", "Hz", &Row::last, 0},
                                {"probability of squeal", "%", [](const Row &row) { return 100. * row.squeal.value; }, 2},
                                {"lower confidence limit", "%", [](const Row &row) { return 100. * row.squeal.lower; }, 2},
                                {"upper confidence limit", "%", [](const Row &row) { return 100. * row.squeal.upper; }, 2},
                                {"undecided samples", "%", [](const Row &row) { return 100. * row.undecided; }, 2}},
                   bands);
    }

    /// All modes with one label in all independent samples.
    struct NamedMode
    {
      std::string         label;
      std::vector<double> frequencies, growth_rates; ///< ascending
      int                 usual_number = 0;          ///< most frequent number of such modes in a sample
      int                 n_unusual    = 0;          ///< number of samples with another number of such modes
      Estimate            grows{};                   ///< probability that a mode with this label grows
    };

    std::vector<NamedMode> named_modes(const SamplePlan &plan, const Samples &samples)
    {
      std::map<std::string, NamedMode>          modes;
      std::map<std::string, std::map<int, int>> numbers; // number of samples by the number of modes with the label
      std::map<std::string, int>                n_growing;
      int                                       n_known = 0;
      for (int s = 0; s < plan.n_independent; ++s)
        if (samples[s])
          {
            ++n_known;
            std::map<std::string, std::pair<int, bool>> here; // number of modes with each label, and whether any of them grows
            for (const SampledMode &mode : *samples[s])
              {
                const ModalQuantities quantities = modal_quantities(mode.lambda);
                NamedMode            &named      = modes[mode.label];
                named.label                      = mode.label;
                named.frequencies.push_back(quantities.frequency);
                named.growth_rates.push_back(quantities.growth_rate);
                auto &[n, grows] = here[mode.label];
                ++n;
                grows = grows || mode.verdict == Verdict::unstable;
              }
            for (const auto &[label, found] : here)
              {
                ++numbers[label][found.first];
                n_growing[label] += found.second;
              }
          }
      std::vector<NamedMode> result;
      for (auto &[label, mode] : modes)
        {
          std::map<int, int> &samples_by_number = numbers[label];
          int                 n_with            = 0;
          for (const auto &[n, times] : samples_by_number)
            n_with += times;
          if (n_known > n_with)
            samples_by_number[0] = n_known - n_with;
          const auto usual  = std::max_element(samples_by_number.begin(), samples_by_number.end(),
                                               [](const auto &a, const auto &b) { return a.second < b.second; });
          mode.usual_number = usual->first;
          mode.n_unusual    = n_known - usual->second;
          mode.grows        = probability(n_growing[label], plan.n_independent);
          std::sort(mode.frequencies.begin(), mode.frequencies.end());
          std::sort(mode.growth_rates.begin(), mode.growth_rates.end());
          result.push_back(mode);
        }
      std::sort(result.begin(), result.end(),
                [](const NamedMode &a, const NamedMode &b) { return mean(a.frequencies) < mean(b.frequencies); });
      return result;
    }

    Table mode_table(const std::vector<NamedMode> &modes, const int n_samples)
    {
      using Row               = NamedMode;
      const auto percent      = [](auto value) { return [value](const Row &row) { return 100. * value(row); }; };
      const auto growth_at    = [](const double p) { return [p](const Row &row) { return quantile(row.growth_rates, p); }; };
      const auto frequency_at = [](const double p) { return [p](const Row &row) { return quantile(row.frequencies, p); }; };
      return Table(Columns<Row>{{"label", "", &Row::label},
                                {"modes with this label", "-", &Row::usual_number},
                                {"samples with another number of modes", "%",
                                 [n_samples](const Row &row) { return 100. * row.n_unusual / n_samples; }, 1},
                                {"probability of growth", "%", percent([](const Row &row) { return row.grows.value; }), 2},
                                {"lower confidence limit", "%", percent([](const Row &row) { return row.grows.lower; }), 2},
                                {"upper confidence limit", "%", percent([](const Row &row) { return row.grows.upper; }), 2},
                                {"mean frequency", "Hz", [](const Row &row) { return mean(row.frequencies); }, 2},
                                {"standard deviation of frequency", "Hz", [](const Row &row) { return deviation(row.frequencies); }, 2},
                                {"frequency at 5 %", "Hz", frequency_at(0.05), 2},
                                {"frequency at 95 %", "Hz", frequency_at(0.95), 2},
                                {"growth rate at 5 %", "1/s", growth_at(0.05), 3},
                                {"median growth rate", "1/s", growth_at(0.5), 3},
                                {"growth rate at 95 %", "1/s", growth_at(0.95), 3},
                                {"largest growth rate", "1/s", growth_at(1.), 3}},
                   modes);
    }

    /// Sobol' indices of an output with respect to an uncertain number.
    struct IndexRow
    {
      std::string output, number;
      Estimate    first, total;
    };

    /// Indices of the largest divergence rate, and of frequency and growth rate of the modes that occur exactly once in every sample.
    std::vector<IndexRow> indices(const SamplePlan &plan, const Samples &samples, const std::vector<NamedMode> &modes)
    {
      std::vector<IndexRow> result;
      const auto            add = [&](const std::string &name, const std::vector<double> &outputs) {
        const std::ptrdiff_t n = plan.n_independent / 2;
        for (auto first = outputs.begin(); first != outputs.end(); first += n)
          if (const auto [least, largest] = std::minmax_element(first, first + n);
              !(*largest - *least > 1e-12 * std::max(std::abs(*least), std::abs(*largest))))
            return; // indices are undefined without variance
        const SobolIndices found = sobol_indices(plan.values, outputs);
        for (std::size_t j = 0; j < plan.numbers.size(); ++j)
          result.push_back({name, plan.numbers[j].name, found.first[j], found.total[j]});
      };
      if (!plan.has_indices || !std::all_of(samples.begin(), samples.end(), [](const auto &sample) { return sample.has_value(); }))
        return result;

      std::vector<double> rates;
      for (const auto &sample : samples)
        {
          const int j = leading_mode(*sample);
          rates.push_back(j < 0 ? 0. : divergence_rate((*sample)[j]));
        }
      add("largest divergence rate", rates);
      for (const NamedMode &mode : modes)
        {
          std::vector<double> frequencies, growth_rates;
          for (const auto &sample : samples)
            for (const SampledMode &other : *sample)
              if (other.label == mode.label && other.is_alone)
                {
                  const ModalQuantities quantities = modal_quantities(other.lambda);
                  frequencies.push_back(quantities.frequency);
                  growth_rates.push_back(other.verdict == Verdict::neutral ? 0. : quantities.growth_rate);
                }
          if (frequencies.size() == samples.size())
            {
              add("frequency of " + mode.label, frequencies);
              add("growth rate of " + mode.label, growth_rates);
            }
        }
      return result;
    }

    Table index_table(const std::vector<IndexRow> &rows)
    {
      using Row           = IndexRow;
      const auto estimate = [](Estimate Row::*member, double Estimate::*number) {
        return [member, number](const Row &row) { return row.*member.*number; };
      };
      return Table(Columns<Row>{{"quantity", "", &Row::output},
                                {"uncertain parameter", "", &Row::number},
                                {"first-order index", "-", estimate(&Row::first, &Estimate::value)},
                                {"lower limit of the first-order index", "-", estimate(&Row::first, &Estimate::lower)},
                                {"upper limit of the first-order index", "-", estimate(&Row::first, &Estimate::upper)},
                                {"total index", "-", estimate(&Row::total, &Estimate::value)},
                                {"lower limit of the total index", "-", estimate(&Row::total, &Estimate::lower)},
                                {"upper limit of the total index", "-", estimate(&Row::total, &Estimate::upper)}},
                   rows);
    }

    std::string percent(const double part)
    {
      return decimal_text(100. * part, 2) + " %";
    }
  } // namespace

  double largest_error(const Sample &sample)
  {
    double result = 0.;
    for (const SampledMode &mode : sample)
      result = std::max(result, mode.error);
    return result;
  }

  Columns<int> sample_columns(const SamplePlan &plan)
  {
    Columns<int> columns{{"sample", "-", [](const int s) { return s + 1; }}};
    for (std::size_t j = 0; j < plan.numbers.size(); ++j)
      columns.push_back({plan.numbers[j].name, "", [&plan, j](const int s) { return plan.values(s, static_cast<Eigen::Index>(j)); }});
    return columns;
  }

  Table sample_table(const SamplePlan &plan, const Samples &samples)
  {
    using Row            = int;
    Columns<Row> columns = sample_columns(plan);
    const auto   n_of    = [&samples](const Verdict verdict) {
      return [&samples, verdict](const int s) -> Entry {
        if (!samples[s])
          return {};
        return std::count_if(samples[s]->begin(), samples[s]->end(), [&](const SampledMode &m) { return m.verdict == verdict; });
      };
    };
    const auto leading = [&samples](auto value) {
      return [&samples, value](const int s) -> Entry {
        const int j = samples[s] ? leading_mode(*samples[s]) : -1;
        return j < 0 ? Entry() : Entry(value((*samples[s])[j]));
      };
    };
    columns.push_back({"unstable modes", "-", n_of(Verdict::unstable)});
    columns.push_back({"undecided modes", "-", n_of(Verdict::undecided)});
    columns.push_back({"label", "", leading([](const SampledMode &mode) { return mode.label; })});
    columns.push_back({"frequency", "Hz", leading([](const SampledMode &mode) { return modal_quantities(mode.lambda).frequency; })});
    columns.push_back({"growth rate", "1/s", leading([](const SampledMode &mode) { return mode.lambda.real(); })});
    columns.push_back({"divergence rate", "%", leading([](const SampledMode &mode) { return 100. * divergence_rate(mode); })});
    columns.push_back({"largest estimated error of lambda", "-",
                       [&samples](const int s) -> Entry { return samples[s] ? Entry(largest_error(*samples[s])) : Entry(); }, 1, true});
    std::vector<int> all(plan.n());
    std::iota(all.begin(), all.end(), 0);
    return Table(columns, all);
  }

  Table cloud_table(const SamplePlan &plan, const Samples &samples)
  {
    using Row = std::pair<int, const SampledMode *>;
    std::vector<Row> rows;
    for (int s = 0; s < plan.n_independent; ++s)
      if (samples[s])
        for (const SampledMode &mode : *samples[s])
          rows.emplace_back(s + 1, &mode);
    return Table(Columns<Row>{{"sample", "-", [](const Row &row) { return row.first; }},
                              {"label", "", [](const Row &row) { return row.second->label; }},
                              {"frequency", "Hz", [](const Row &row) { return modal_quantities(row.second->lambda).frequency; }},
                              {"growth rate", "1/s", [](const Row &row) { return row.second->lambda.real(); }},
                              {"divergence rate", "%", [](const Row &row) { return 100. * divergence_rate(*row.second); }},
                              {"estimated error of lambda", "-", [](const Row &row) { return row.second->error; }, 1, true},
                              {"verdict", "", [](const Row &row) { return to_string(row.second->verdict); }}},
                 rows);
  }

  int leading_mode(const Sample &sample)
  {
    int result = -1;
    for (std::size_t j = 0; j < sample.size(); ++j)
      if (sample[j].verdict == Verdict::unstable && (result < 0 || divergence_rate(sample[j]) > divergence_rate(sample[result])))
        result = static_cast<int>(j);
    return result;
  }

  void write_samples(const SamplePlan &plan, const Samples &samples, Run &run)
  {
    run.count("samples", plan.n());
    run.count("independent samples", plan.n_independent);
    const std::vector<BandProbability> bands = band_probabilities(plan, samples, run.parameters);
    const std::vector<NamedMode>       modes = named_modes(plan, samples);
    const BandProbability             &all   = bands.front();
    run.progress.note(text("\n  probability of squeal below ", all.last, " Hz: ", percent(all.squeal.value), " (",
                           percent(all.squeal.lower), " to ", percent(all.squeal.upper), " with 95 % confidence, ", plan.n_independent,
                           " samples), undecided samples ", percent(all.undecided)));
    std::vector<NamedMode> growing;
    std::copy_if(modes.begin(), modes.end(), std::back_inserter(growing), [](const NamedMode &mode) { return mode.grows.value > 0.; });
    if (!growing.empty())
      {
        run.screen << "\n  modes that grow in some samples (all modes: mode_distributions.csv)\n\n";
        mode_table(growing, plan.n_independent).print(run.screen);
        run.screen << '\n';
      }
    run.store_table("probabilities", probability_table(bands));
    run.store_table("mode_distributions", mode_table(modes, plan.n_independent));
    run.store_table("samples", sample_table(plan, samples));
    run.store_table("sample_modes", cloud_table(plan, samples));
    const std::vector<IndexRow> rows = indices(plan, samples, modes);
    if (!rows.empty())
      {
        run.store_table("sobol_indices", index_table(rows));
        std::vector<IndexRow> of_rate;
        std::copy_if(rows.begin(), rows.end(), std::back_inserter(of_rate),
                     [](const IndexRow &row) { return row.output == "largest divergence rate"; });
        if (!of_rate.empty())
          {
            run.screen << "  Sobol' indices (all: sobol_indices.csv)\n\n";
            index_table(of_rate).print(run.screen);
            run.screen << '\n';
          }
      }
    if (run.parameters.robustness.has_indices &&
        std::none_of(rows.begin(), rows.end(), [](const IndexRow &row) { return row.output == "largest divergence rate"; }))
      run.progress.note(text("  note: no Sobol' indices of the largest divergence rate: ",
                             plan.has_indices ? "the rate does not vary within a set of samples, or samples have no results" :
                                                "parameters are correlated"));
  }
} // namespace Squeal
