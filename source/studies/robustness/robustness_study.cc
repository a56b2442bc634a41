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
    /// Number of training samples, and size of the next set relative to all samples before it: growing sets avoid evaluating many
    /// samples with a basis that is still too small.
    constexpr int n_training = 8, growth_of_sets = 4;

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

    /// Samples of a system without a definite part, each at full order. Returns their largest estimated error.
    double solve_directly(SweepModel &model, std::vector<std::optional<Sample>> &samples)
    {
      Run &run = model.run;
      run.progress.begin("Samples");
      const auto &points = model.regime.points;
      double      worst  = 0.;
      std::size_t n_lost = 0;
      std::string reason;
      for (const OperatingPoint &point : points)
        try
          {
            const ChartPoint found = model.evaluate_directly(point);
            worst                  = std::max(worst, model.largest_error(found));
            samples[point.line]    = modes_of(model, found);
          }
        catch (const SolverError &error)
          {
            ++n_lost;
            reason = in_one_line(error);
          }
      run.progress.finish(text(points.size() - n_lost, " of ", points.size(), " samples at full order, estimated error ", worst));
      if (n_lost > 0)
        run.warn(text(n_lost, " samples could not be solved and count as undecided: ", reason));
      return worst;
    }

    /// The samples of a contact set by one basis, which grows for sets of them that are each larger than the one before.
    /// Returns their largest estimated error.
    double solve_contact_set(SweepModel &model, const double tolerance, std::vector<std::optional<Sample>> &samples)
    {
      Run                               &run    = model.run;
      const std::vector<OperatingPoint> &points = model.regime.points;
      ErrorControlledSweepOptions        options;
      options.tolerance = tolerance;
      model.reduced->estimate_without_cancellation();
      if (options.tolerance >= single_precision_tolerance)
        model.reduced->estimate_in_single_precision();
      run.progress.begin("Samples");
      std::size_t      n_left = 0;
      double           worst  = 0.;
      std::string      why_stopped;
      std::vector<int> training(std::min<std::size_t>(n_training, points.size()));
      std::iota(training.begin(), training.end(), 0);
      for (std::size_t first = 0, size = growth_of_sets * n_training; first < points.size();)
        {
          size                                    = std::min(size, points.size() - first);
          const auto                        begin = points.begin() + static_cast<std::ptrdiff_t>(first);
          const std::vector<OperatingPoint> set(begin, begin + static_cast<std::ptrdiff_t>(size));
          const auto                        keep = [&](const int i, ChartPoint &&point) { samples[set[i].line] = modes_of(model, point); };

          const ErrorControlledSweep found =
            error_controlled_sweep(*model.reduced, set, training, options, keep, run.communicator, run.progress);
          n_left += found.n_left;
          worst = std::max(worst, found.worst_error);
          if (!found.why_stopped.empty())
            why_stopped = found.why_stopped;
          training.clear();
          first += size;
          size = growth_of_sets * first;
        }
      run.progress.finish(
        text(points.size() - n_left, " of ", points.size(), " samples, ", model.reduced->size(), " vectors, estimated error ", worst));
      if (n_left > 0)
        run.warn(text(n_left, " samples miss the tolerance of ", options.tolerance, ": ", why_stopped,
                      "; they count as undecided. Raise the tolerance"));
      return worst;
    }

    /// The samples with the largest divergence rates as parameter files of stability runs.
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
          Parameters worst;
          if (run.parameters.system)
            {
              worst = run.parameters;
              for (std::size_t j = 0; j < plan.numbers.size(); ++j)
                worst.system.values[plan.numbers[j].parameter] = plan.values(s, static_cast<Eigen::Index>(j));
              worst.system.file = std::filesystem::absolute(worst.system.path()).string();
            }
          else
            worst = with_sample(run.parameters, plan, s);
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
        throw ParameterError(exact_text(ends) + " are not limits of bands within that of the modes, which ends at " +
                               exact_text(parameters.discretization.maximum_frequency) + " Hz",
                             "parameter Robustness/Frequency bands", "give two or more in ascending order, up to Band/Maximum frequency");
    }

    void run_samples(const SamplePlan &plan, const SampledSystems &systems, Run &run)
    {
      const std::vector<std::optional<Sample>> samples = solve_samples(systems, plan.n(), run.parameters.robustness.tolerance, run);
      write_samples(plan, samples, run);
      write_worst_samples(plan, samples, run);
      run.finish();
    }
  } // namespace

  std::vector<std::optional<Sample>> solve_samples(const SampledSystems &systems, const int n_samples, const double tolerance, Run &run)
  {
    std::vector<std::optional<Sample>> result(n_samples);
    double                             worst     = 0.;
    int                                n_vectors = 0;
    for (std::size_t i = 0; i < systems.plan.regimes.size(); ++i)
      {
        SweepModel model(systems.plan, systems.plan.regimes[i], run, systems.middles[i]);
        worst     = std::max(worst, model.reduced ? solve_contact_set(model, tolerance, result) : solve_directly(model, result));
        n_vectors = std::max(n_vectors, model.reduced ? model.reduced->size() : 0);
      }
    run.count("basis vectors", n_vectors);
    run.measure("largest estimated error of lambda [-]", worst);
    return result;
  }

  /// `Study = robustness`: complex modes of samples of uncertain parameters by one reduced model, with estimated errors at every sample; how
  /// probable squeal is, and which parameters matter.
  static void run_robustness_study(Scene &scene, Run &run)
  {
    check_bands(run.parameters);
    const auto current = [&run](const std::string &name) {
      const std::string value = current_value(run.parameters, name);
      if (const auto number = parse_number(value))
        return *number;
      throw ParameterError("the value of " + in_quotes(name) + " is " + in_quotes(value) + ", not a number",
                           "parameter Robustness/Distributions", "name the k-th number of it: Section/Name[k]");
    };
    std::vector<std::string> pins;
    for (const std::string &volume : scene.model->volume_names())
      if (!is_of_disc(volume) && !run.parameters.materials.has_own(volume))
        pins.push_back(volume);
    const SamplePlan plan   = sample_plan(run.parameters.robustness, current, pins);
    const BodyTerms  bodies = assemble_scene(scene, run);
    run_samples(plan, sampled_scene(scene, bodies, plan, run), run);
  }

  static void run_robustness_of_system(Run &run)
  {
    check_bands(run.parameters);
    SystemFile       file = read_system(run);
    const SamplePlan plan = sample_plan(run.parameters.robustness, [&](const std::string &name) { return value_in(file, name, run); }, {});
    run_samples(plan, sampled_file(std::move(file), plan, run), run);
  }

  extern const Study robustness_study = [] {
    Study study{"robustness", run_robustness_study, {"Robustness/"}};
    study.rules = {
      {"Operation/Rotation speed", no_sliding_speed},
      {"Complex modes/", [](const Parameters &) { return "samples are solved by a reduced model"; }},
      {"Output/", [](const Parameters &) { return "the study writes no mode shapes; parameter files of its worst samples do"; }}};
    study.check         = [](const Parameters &p) { p.robustness.parsed_correlations(); };
    study.run_of_system = run_robustness_of_system;
    return study;
  }();
} // namespace Squeal
