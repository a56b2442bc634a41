// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/studies/sensitivity/sensitivity_results.h>
#include <squeal/tracking/mode_links.h>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// First step of μ around a coalescence, relative to the distance from the next threshold of either branch [-]. It is so small that δ²
    /// is nearly linear.
    constexpr double first_distance = 0.03;

    /// Maximum number of attempts to follow the modes, each with a tenth of the previous step.
    constexpr int most_attempts = 3;

    /// Modes of a point that continue given modes of another point; empty if they cannot be identified.
    std::optional<std::vector<int>> followed(const ChartPoint       &from,
                                             const std::vector<int> &modes,
                                             const ChartPoint       &to,
                                             const double            omega_max)
    {
      const ModeLinks  links = link_modes(from, to, omega_max);
      std::vector<int> result;
      std::vector<int> rest = modes;
      for (const ModeBlock &block : links.blocks)
        if (std::any_of(block.first.begin(), block.first.end(),
                        [&](const int j) { return std::find(modes.begin(), modes.end(), j) != modes.end(); }))
          {
            // A block that also contains other modes does not identify the continuation
            for (const int j : block.first)
              if (const auto found = std::find(rest.begin(), rest.end(), j); found != rest.end())
                rest.erase(found);
              else
                return {};
            result.insert(result.end(), block.second.begin(), block.second.end());
          }
      if (!rest.empty() || result.size() != modes.size())
        return {};
      return result;
    }

    /// Index of the point closest to a friction coefficient, among points at which all given branches have modes; −1: none.
    int nearest_point(const StabilityChart &chart, const double friction_coefficient, const std::vector<int> &branches)
    {
      int result = -1;
      for (int i = 0; i < static_cast<int>(chart.points.size()); ++i)
        if (std::all_of(branches.begin(), branches.end(), [&](const int b) { return chart.branches[b].modes[i] >= 0; }) &&
            (result < 0 || std::abs(chart.points[i].friction_coefficient - friction_coefficient) <
                             std::abs(chart.points[result].friction_coefficient - friction_coefficient)))
          result = i;
      return result;
    }

    /// A friction coefficient at which a threshold is evaluated, with the modes there.
    struct ThresholdSample
    {
      double           friction_coefficient;
      std::vector<int> modes;
    };

    class ThresholdDerivatives
    {
    public:
      ThresholdDerivatives(SensitivityModel &model, const StabilityChart &chart, const Threshold &threshold)
        : model(model)
        , chart(chart)
        , threshold(threshold)
        , branches(threshold.partner >= 0 ? std::vector<int>{threshold.branch, threshold.partner} : std::vector<int>{threshold.branch})
        , step(first_distance * room())
      {}

      /// Derivatives with the present basis. Collective.
      ThresholdSensitivity find()
      {
        result = {&threshold, "", {}, {}};
        if (threshold.friction_coefficient <= chart.points.front().friction_coefficient)
          result.obstacle = "the threshold is at the first friction coefficient of the sweep";
        else if (threshold.mechanism == ThresholdMechanism::zero_growth)
          at_zero_growth();
        else
          for (int attempt = 0; attempt < most_attempts; ++attempt, step *= 0.1)
            {
              result.obstacle.clear();
              at_coalescence();
              if (result.obstacle.empty())
                break;
            }
        return result;
      }

      /// Modes of the last evaluation.
      std::vector<ThresholdSample> samples;

    private:
      /// Distance from the next threshold of either branch or from the nearest end of the chart.
      double room() const
      {
        const double mu     = threshold.friction_coefficient;
        double       result = std::min(mu - chart.points.front().friction_coefficient, chart.points.back().friction_coefficient - mu);
        for (const Threshold &other : chart.thresholds)
          for (const int b : branches)
            if (&other != &threshold && (other.branch == b || other.partner == b))
              result = std::min(result, std::abs(other.friction_coefficient - mu));
        return std::max(result, 0.);
      }

      /// Point at a friction coefficient; stores its modes on the branches. Null if these modes cannot be identified.
      const ChartPoint *sample(const double mu)
      {
        const int        i = nearest_point(chart, mu, branches);
        std::vector<int> from;
        for (const int b : branches)
          from.push_back(chart.branches[b].modes[i]);
        model.sweep.evaluate(SensitivityModel::main_line, {mu});
        const ChartPoint &there = model.sweep.known.at({SensitivityModel::main_line, mu});
        const auto        to    = followed(chart.points[i], from, there, model.sweep.largest_circular_frequency);
        if (!to)
          {
            result.obstacle = "the modes cannot be identified near the threshold";
            return nullptr;
          }
        samples.push_back({mu, *to});
        return &there;
      }

      int friction() const
      {
        const auto &all = model.parameters;
        return static_cast<int>(
          std::find_if(all.begin(), all.end(),
                       [](const SensitivityParameter &p) { return p.operation == &OperationParameters::friction_coefficient; }) -
          all.begin());
      }

      void at_zero_growth()
      {
        samples.clear();
        const ChartPoint *point = sample(threshold.friction_coefficient);
        if (point == nullptr)
          return;
        const int                 mode     = samples.back().modes.front();
        const SensitivityProducts products = model.products(*point, {mode});
        std::vector<double>       rates;
        for (const ComplexDenseMatrix &N : products.N)
          rates.push_back(eigenvalue_derivative(N, products.D, 0).real());
        for (const double rate : rates)
          result.derivatives.push_back(-rate / rates[friction()]);
        result.errors.assign(rates.size(), 0.);
      }

      void at_coalescence()
      {
        const double mu = threshold.friction_coefficient;
        samples.clear();
        if (!(step > 3. * threshold.uncertainty))
          {
            result.obstacle = "another threshold of these modes, or an end of the sweep, is too close";
            return;
          }
        std::vector<std::array<Complex, 3>> means(model.parameters.size(), std::array<Complex, 3>{});
        for (int distance = 1; distance <= 3; ++distance)
          for (const int side : {-1, 1})
            {
              const ChartPoint *point = sample(mu + side * distance * step);
              if (point == nullptr)
                return;
              const SensitivityProducts products = model.products(*point, samples.back().modes);
              for (std::size_t p = 0; p < means.size(); ++p)
                means[p][distance - 1] += 0.5 * squared_difference_derivative(products.N[p], products.D, products.lambda);
            }
        const ValueAtCentre slope = value_at_centre(means[friction()]);
        for (const auto &mean : means)
          {
            const ValueAtCentre value = value_at_centre(mean);
            const double        rate  = -(value.value / slope.value).real();
            result.derivatives.push_back(rate);
            result.errors.push_back((value.error + std::abs(rate) * slope.error) / std::abs(slope.value));
          }
      }

      SensitivityModel      &model;
      const StabilityChart  &chart;
      const Threshold       &threshold;
      const std::vector<int> branches;
      double                 step; ///< step of the friction coefficient
      ThresholdSensitivity   result;
    };
  } // namespace

  std::vector<ThresholdSensitivity> threshold_sensitivities(SensitivityModel &model, const SweepChart &chart, Run &run)
  {
    SweepModel                       &sweep = model.sweep;
    std::vector<ThresholdDerivatives> thresholds;
    for (const Threshold &threshold : chart.chart.thresholds)
      thresholds.emplace_back(model, chart.chart, threshold);
    const auto find = [&](const char *what) {
      std::vector<ThresholdSensitivity> result;
      for (ThresholdDerivatives &threshold : thresholds)
        {
          run.progress.update(text(what, result.size() + 1, " of ", thresholds.size()));
          result.push_back(threshold.find());
        }
      return result;
    };

    run.progress.begin("Derivatives of thresholds");
    std::vector<ThresholdSensitivity>             result = find("threshold ");
    std::vector<std::vector<ChartModel::ModesAt>> groups;
    for (const ThresholdDerivatives &threshold : thresholds)
      if (!threshold.samples.empty())
        {
          groups.emplace_back();
          for (const ThresholdSample &sample : threshold.samples)
            groups.back().push_back(
              model.modes_at(sweep.known.at({SensitivityModel::main_line, sample.friction_coefficient}), sample.modes));
        }
    if (!groups.empty())
      {
        const std::string why_not = model.grow(groups, run.parameters.sweep.maximum_basis);
        if (!why_not.empty())
          run.warn("derivatives of thresholds are computed without extending the basis of the sweep: " + why_not +
                   "; raise Sweep/Maximum basis if it limits the basis");
        else
          {
            std::vector<ThresholdSensitivity> now = find("again threshold ");
            for (std::size_t t = 0; t < now.size(); ++t)
              for (std::size_t p = 0; p < std::min(now[t].derivatives.size(), result[t].derivatives.size()); ++p)
                now[t].errors[p] += std::abs(now[t].derivatives[p] - result[t].derivatives[p]);
            result = std::move(now);
          }
      }
    const auto n = std::count_if(result.begin(), result.end(), [](const ThresholdSensitivity &t) { return t.obstacle.empty(); });
    run.progress.finish(text(n, " of ", result.size(), " thresholds, ", counted(sweep.reduced->size(), "vector")));
    return result;
  }
} // namespace Squeal
