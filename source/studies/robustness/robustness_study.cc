// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/parameters/design_plan.h>
#include <squeal/studies/designs/design_work.h>
#include <squeal/studies/robustness/robustness.h>
#include <squeal/studies/steps/parameter_usage.h>

#include <map>
#include <numeric>

namespace Squeal
{
  namespace
  {
    /// Size of the first batch of samples, and ratio of each later batch to all previous ones.
    constexpr std::size_t first_set = 32, growth_of_sets = 4;

    constexpr int n_training_samples = 8;

    std::vector<SampledMode> modes_of(const SweepModel &model, const ChartPoint &point)
    {
      const std::vector<int>       in_band = model.in_band(point);
      const std::vector<ModeLabel> labels  = model.labels_in_band(point);
      std::map<std::string, int>   n_of;
      std::vector<SampledMode>     result;
      for (std::size_t i = 0; i < in_band.size(); ++i)
        {
          const int j = in_band[i];
          result.push_back({point.lambda[j], point.errors[j], point.verdicts[j], to_string(labels[i]), false});
          ++n_of[result.back().label];
        }
      for (SampledMode &mode : result)
        mode.is_alone = n_of[mode.label] == 1;
      return result;
    }

    /// Solves the first @p n points of a contact set, the samples. Returns their largest estimated error.
    double solve_contact_set(SweepModel &model, const std::size_t n, const double tolerance, std::vector<std::optional<Sample>> &samples)
    {
      const auto                        begin = model.regime.points.begin();
      const std::vector<OperatingPoint> points(begin, begin + static_cast<std::ptrdiff_t>(n));
      const auto                        keep = [&](const int i, ChartPoint &&point) { samples[points[i].line] = modes_of(model, point); };

      const ErrorControlledSweep found = solve_points(model, points, n_training_samples, tolerance, keep, "Samples");
      if (found.n_left > 0)
        model.run.warn(text(found.n_left, " samples miss the tolerance of ", tolerance, ": ", found.why_stopped,
                            "; they count as undecided. Raise the tolerance"));
      return found.worst_error;
    }

    /// Writes the samples with the largest divergence rates as parameter files of stability runs.
    void write_worst_samples(const SamplePlan &plan, const std::vector<std::optional<Sample>> &samples, Run &run)
    {
      std::vector<std::pair<double, int>> rates;
      for (int s = 0; s < plan.n(); ++s)
        if (samples[s])
          if (const int j = leading_mode(*samples[s]); j >= 0)
            rates.emplace_back(-modal_quantities((*samples[s])[j].lambda).divergence_rate, s);
      std::sort(rates.begin(), rates.end());
      rates.resize(std::min<std::size_t>(rates.size(), run.parameters.robustness.n_worst));
      for (const auto &[rate, s] : rates)
        {
          Parameters worst = run.parameters.system ? system_with_sample(run.parameters, plan, s) : with_sample(run.parameters, plan, s);
          worst.study      = studies().front();
          worst.robustness = {};
          write_parameter_file(worst, text("worst/", s + 1, ".prm"), run);
        }
    }

    void check_bands(const Parameters &parameters)
    {
      const auto &ends = parameters.robustness.frequency_bands;
      if (!ends.empty() && (ends.size() == 1 || std::adjacent_find(ends.begin(), ends.end(), std::greater_equal<>()) != ends.end() ||
                            ends.back() > parameters.discretization.maximum_frequency))
        throw ParameterError(exact_text(ends) + " are not limits of bands below " +
                               exact_text(parameters.discretization.maximum_frequency) + " Hz",
                             "parameter Robustness/Frequency bands", "give two or more in ascending order, up to Band/Maximum frequency");
    }

    void run_samples(const SamplePlan &plan, const SampledSystems &systems, Run &run)
    {
      const auto [samples, followed] = solve_samples(systems, plan.n(), run.parameters.robustness.tolerance, run);
      write_samples(plan, samples, run);
      write_worst_samples(plan, samples, run);
      if (!followed.empty())
        write_onsets(followed, systems.plan.axis.name, run);
      run.finish();
    }
  } // namespace

  std::unique_ptr<SweepModel> sample_model(const SampledSystems &systems, const std::size_t contact_set, Run &run)
  {
    auto result = std::make_unique<SweepModel>(systems.plan, systems.plan.regimes[contact_set], run, systems.middles[contact_set]);
    if (result->reduced)
      result->reduced->estimate_without_cancellation();
    return result;
  }

  ErrorControlledSweep solve_directly(const SweepModel &model, const std::vector<OperatingPoint> &points, const KeepPoint &keep)
  {
    ErrorControlledSweep result{0, 0., 0, ""};
    for (std::size_t i = 0; i < points.size(); ++i)
      try
        {
          ChartPoint found   = model.evaluate_directly(points[i]);
          result.worst_error = std::max(result.worst_error, model.largest_error(found));
          keep(static_cast<int>(i), std::move(found));
        }
      catch (const SolverError &error)
        {
          ++result.n_left;
          result.why_stopped = in_one_line(error);
        }
    return result;
  }

  ErrorControlledSweep solve_points(SweepModel                        &model,
                                    const std::vector<OperatingPoint> &points,
                                    const int                          n_training,
                                    const double                       tolerance,
                                    const KeepPoint                   &keep,
                                    const std::string                 &name)
  {
    Run                        &run = model.run;
    ErrorControlledSweepOptions options;
    options.tolerance = tolerance;
    ErrorControlledSweep result{0, 0., 0, ""};
    run.progress.begin(name);
    if (!model.reduced)
      {
        result = solve_directly(model, points, keep);
        run.progress.finish(
          text(points.size() - result.n_left, " of ", points.size(), " samples at full order, estimated error ", result.worst_error));
        return result;
      }
    std::vector<int> training(std::min<std::size_t>(n_training, points.size()));
    std::iota(training.begin(), training.end(), 0);
    for (std::size_t first = 0, size = first_set; first < points.size();)
      {
        size                                    = std::min(size, points.size() - first);
        const auto                        begin = points.begin() + static_cast<std::ptrdiff_t>(first);
        const std::vector<OperatingPoint> set(begin, begin + static_cast<std::ptrdiff_t>(size));
        const auto keep_of_set = [&](const int i, ChartPoint &&point) { keep(static_cast<int>(first) + i, std::move(point)); };

        const ErrorControlledSweep found =
          error_controlled_sweep(*model.reduced, set, training, options, keep_of_set, run.communicator, run.progress);
        result.n_left += found.n_left;
        result.n_growths += found.n_growths;
        result.worst_error = std::max(result.worst_error, found.worst_error);
        if (!found.why_stopped.empty())
          result.why_stopped = found.why_stopped;
        training.clear();
        first += size;
        size = growth_of_sets * first;
      }
    run.progress.finish(text(points.size() - result.n_left, " of ", points.size(), " samples, ", model.reduced->size(),
                             " vectors, estimated error ", result.worst_error));
    return result;
  }

  SolvedSamples solve_samples(const SampledSystems &systems, const int n_samples, const double tolerance, Run &run)
  {
    SolvedSamples result{std::vector<std::optional<Sample>>(n_samples), std::vector<FollowedSample>(systems.plan.lines.size())};
    double        worst     = 0.;
    int           n_vectors = 0;
    for (std::size_t i = 0; i < systems.plan.regimes.size(); ++i)
      {
        const auto model = sample_model(systems, i, run);
        worst            = std::max(worst, solve_contact_set(*model, systems.n_samples[i], tolerance, result.samples));
        follow_samples(*model, systems.n_samples[i], result.followed);
        n_vectors = std::max(n_vectors, model->reduced ? model->reduced->size() : 0);
      }
    run.count("basis vectors", n_vectors);
    run.measure("largest estimated error of lambda [-]", worst);
    return result;
  }

  /// `Study = robustness`: complex modes of samples of uncertain parameters by one reduced model, with estimated errors at every sample;
  /// gives the probability of squeal and the influence of the parameters.
  static void run_robustness_study(Scene &scene, Run &run)
  {
    check_bands(run.parameters);
    const auto       nominal = [&run](const std::string &name) { return nominal_value(run.parameters, name); };
    const SamplePlan plan    = sample_plan(run.parameters.robustness, nominal, alike_pins(scene, run.parameters));
    const BodyTerms  bodies  = assemble_scene(scene, run);
    run_samples(plan, sampled_scene(scene, bodies, plan, run), run);
  }

  static void run_robustness_of_system(Run &run)
  {
    check_bands(run.parameters);
    SystemFile       file = read_system(run);
    const SamplePlan plan =
      sample_plan(run.parameters.robustness, [&](const std::string &name) { return value_in(file, name, run.parameters); }, {});
    run_samples(plan, sampled_file(std::move(file), plan, run), run);
  }

  extern const Study robustness_study = [] {
    const auto of_onsets = [](const Parameters &p) { return unless(p.robustness.n_onsets > 0, "Robustness/Samples with onsets = 0"); };
    Study      study{"robustness", run_robustness_study, {"Robustness/"}};
    study.rules = {
      {"Operation/Rotation speed", no_sliding_speed},
      {"Complex modes/", [](const Parameters &) { return "samples are solved by a reduced model"; }},
      {"Output/", [](const Parameters &) { return "the study writes no mode shapes; parameter files of its worst samples do"; }}};
    for (const char *path : {"Sweep/First friction coefficient", "Sweep/Last friction coefficient", "Sweep/Number of friction coefficients",
                             "Sweep/Tolerance", "Sweep/Maximum basis", "Sweep/Threshold tolerance", "Sweep/Parameter"})
      {
        study.own_parameters.push_back(path);
        study.rules.push_back({path, of_onsets});
      }
    study.check         = [](const Parameters &p) { p.robustness.parsed_correlations(); };
    study.run_of_system = run_robustness_of_system;
    return study;
  }();
} // namespace Squeal
