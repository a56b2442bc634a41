// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/tasks.h>
#include <squeal/studies/robustness/robustness.h>
#include <squeal/studies/steps/parameter_usage.h>
#include <squeal/studies/steps/written_system.h>

#include <boost/serialization/utility.hpp>
#include <boost/serialization/vector.hpp>
#include <deal.II/base/mpi.h>

#include <fstream>
#include <iterator>
#include <map>
#include <numeric>

namespace Squeal
{
  namespace
  {
    /// Size of the first batch of samples, and ratio of each later batch to all previous batches.
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

    constexpr const char *stored_samples = "samples-";

    using StoredSamples = std::vector<std::pair<int, Sample>>; ///< samples with their indices

    /// Reads the samples that an interrupted run has stored.
    void take_known(const Checkpoint &checkpoint, std::vector<std::optional<Sample>> &samples, Run &run)
    {
      StoredSamples known;
      if (run.is_root)
        for (const auto &file : std::filesystem::directory_iterator(checkpoint.folder))
          if (const std::string name = file.path().filename(); name.rfind(stored_samples, 0) == 0)
            for (auto &sample : checkpoint.find<StoredSamples>(name).value_or(StoredSamples()))
              known.push_back(std::move(sample));
      known = dealii::Utilities::MPI::broadcast(run.communicator, known, 0);
      for (auto &[s, sample] : known)
        samples[s] = std::move(sample);
      if (!known.empty())
        run.progress.note(text("  continuing an interrupted study: ", known.size(), " of ", samples.size(), " samples are finished"));
    }

    /// Solves the samples among the first @p n points of a contact set that are not known; returns the number of extensions of the basis.
    int solve_contact_set(SweepModel                         &model,
                          const std::size_t                   n,
                          const int                           n_training,
                          const double                        tolerance,
                          const Checkpoint                   *checkpoint,
                          std::vector<std::optional<Sample>> &samples)
    {
      std::vector<OperatingPoint> points;
      std::copy_if(model.regime.points.begin(), model.regime.points.begin() + static_cast<std::ptrdiff_t>(n), std::back_inserter(points),
                   [&](const OperatingPoint &point) { return !samples[point.line]; });
      if (points.empty())
        return 0;
      // Determine labels in parallel, for several points at a time
      constexpr std::size_t                   n_at_once = 128;
      std::vector<std::pair<int, ChartPoint>> kept;
      const auto                              label = [&] {
        StoredSamples found(kept.size());
        const auto    one = [&](const int k) { found[k] = {points[kept[k].first].line, modes_of(model, kept[k].second)}; };
        if (!kept.empty())
          one(0); // the first call extends the products with the component modes to the latest basis
        run_tasks(static_cast<int>(kept.size()) - 1, [&](const int k) { one(k + 1); });
        if (checkpoint && model.run.is_root && !found.empty())
          checkpoint->keep(text(stored_samples, found.front().first, ".result"), found);
        for (auto &[s, sample] : found)
          samples[s] = std::move(sample);
        kept.clear();
      };
      const auto keep = [&](const int i, ChartPoint &&point) {
        kept.emplace_back(i, std::move(point));
        if (kept.size() == n_at_once)
          label();
      };
      const ErrorControlledSweep result = solve_points(model, points, n_training, tolerance, keep, "Samples");
      label();
      if (result.n_left > 0)
        model.run.warn(text(counted(result.n_left, "sample has", "samples have"), " no results within the tolerance of ", tolerance, ": ",
                            result.why_stopped, "; such samples count as undecided. Remove this cause, or raise the tolerance"));
      return result.n_growths;
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

    /// Checksums of the files of a system.
    std::string system_key(const std::filesystem::path &system)
    {
      const std::filesystem::path        folder = std::filesystem::is_directory(system) ? system : system.parent_path();
      std::map<std::string, std::size_t> files;
      for (const auto &file : std::filesystem::directory_iterator(folder.empty() ? "." : folder))
        if (file.is_regular_file())
          {
            std::ifstream stream(file.path(), std::ios::binary);
            files[file.path().filename()] = std::hash<std::string>()({std::istreambuf_iterator<char>(stream), {}});
          }
      std::string result = "system:";
      for (const auto &[name, checksum] : files)
        result += text(' ', name, ' ', checksum);
      return result;
    }

    void check_bands(const Parameters &parameters)
    {
      const auto &ends = parameters.robustness.frequency_bands;
      if (!ends.empty() && (ends.size() == 1 || std::adjacent_find(ends.begin(), ends.end(), std::greater_equal<>()) != ends.end() ||
                            ends.back() > parameters.discretization.maximum_frequency))
        throw ParameterError("the limits " + exact_text(ends) + " Hz do not define bands up to " +
                               exact_text(parameters.discretization.maximum_frequency) + " Hz",
                             "parameter Robustness/Frequency bands",
                             "give two or more limits in ascending order, none above Band/Maximum frequency");
    }

    /// @param model content of the model, for the key of the checkpoint
    void run_samples(const SamplePlan &plan, const SampledSystems &systems, const std::string &model, Run &run)
    {
      const Checkpoint checkpoint(checkpoint_folder(run.folder().name()), study_key(run, model), run.communicator);
      const bool       writes_model = run.parameters.output.write_system == SystemOutput::reduced;
      KeepModel        keep;
      if (writes_model)
        {
          check_reduced_system(systems);
          keep = [&](const std::size_t contact_set, const SweepModel &of_set, const auto &samples) {
            write_reduced_system(systems, contact_set, plan, samples, of_set);
          };
        }
      const auto [samples, followed] =
        solve_samples(systems, plan.n(), run.parameters.robustness.tolerance, run, writes_model ? nullptr : &checkpoint, keep);
      write_samples(plan, samples, run);
      write_worst_samples(plan, samples, run);
      if (!followed.empty())
        write_onsets(followed, systems.plan.axis.name, run);
      run.finish([&] {
        if (run.is_root)
          std::filesystem::remove_all(checkpoint.folder);
      });
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
    run.progress.finish(text(points.size() - result.n_left, " of ", points.size(), " samples, ", counted(model.reduced->size(), "vector"),
                             ", estimated error ", result.worst_error));
    return result;
  }

  SolvedSamples solve_samples(const SampledSystems &systems,
                              const int             n_samples,
                              const double          tolerance,
                              Run                  &run,
                              const Checkpoint     *checkpoint,
                              const KeepModel      &keep)
  {
    SolvedSamples result{std::vector<std::optional<Sample>>(n_samples), std::vector<FollowedSample>(systems.plan.lines.size())};
    if (checkpoint)
      take_known(*checkpoint, result.samples, run);
    int n_vectors = 0;
    for (std::size_t i = 0; i < systems.plan.regimes.size(); ++i)
      {
        const auto model     = sample_model(systems, i, run);
        int        n_growths = solve_contact_set(*model, systems.n_samples[i], n_training_samples, tolerance, checkpoint, result.samples);
        if (keep && systems.n_samples[i] > 0)
          {
            // Solve all samples with the final basis, to which the estimates of the written model refer
            while (model->reduced && n_growths > 0)
              {
                for (std::size_t k = 0; k < systems.n_samples[i]; ++k)
                  result.samples[systems.plan.regimes[i].points[k].line].reset();
                n_growths = solve_contact_set(*model, systems.n_samples[i], 0, tolerance, nullptr, result.samples);
              }
            keep(i, *model, result.samples);
          }
        follow_samples(*model, systems.n_samples[i], result.followed);
        n_vectors = std::max(n_vectors, model->reduced ? model->reduced->size() : 0);
      }
    double worst = 0.;
    for (const std::optional<Sample> &sample : result.samples)
      if (sample)
        worst = std::max(worst, largest_error(*sample));
    run.count("basis vectors", n_vectors);
    run.measure("largest estimated error of lambda [-]", worst);
    return result;
  }

  /// `Study = robustness`: complex modes for samples of uncertain parameters, from one reduced model for each contact set, with estimated
  /// errors. Reports the probability of squeal and the influence of the parameters.
  static void run_robustness_study(Scene &scene, Run &run)
  {
    check_bands(run.parameters);
    const auto       nominal = [&run](const std::string &name) { return nominal_value(run.parameters, name); };
    const SamplePlan plan    = sample_plan(run.parameters.robustness, nominal, alike_pins(scene, run.parameters));
    write_scene_system(scene, run);
    const BodyTerms bodies = assemble_scene(scene, run);
    run_samples(plan, sampled_scene(scene, bodies, plan, run), model_key(scene), run);
  }

  static void run_robustness_of_system(Run &run)
  {
    check_bands(run.parameters);
    SystemFile       file = read_system(run);
    const SamplePlan plan =
      sample_plan(run.parameters.robustness, [&](const std::string &name) { return value_in(file, name, run.parameters); }, {});
    write_system_again(file, "system/", run);
    run_samples(plan, sampled_file(std::move(file), plan, run), system_key(run.parameters.system.path()), run);
  }

  extern const Study robustness_study = [] {
    const auto of_onsets = [](const Parameters &p) { return unless(p.robustness.n_onsets > 0, "Robustness/Samples with onsets = 0"); };
    Study      study{"robustness", run_robustness_study, {"Robustness/", "Output/Write system"}};
    study.rules = {{"Output/Write system", is_used},
                   {"Operation/Rotation speed", no_sliding_speed},
                   {"Complex modes/", [](const Parameters &) { return "samples are solved with a reduced model"; }},
                   {"Output/", [](const Parameters &) { return "only for runs with the parameter file of a worst sample"; }}};
    for (const char *path : {"Sweep/First friction coefficient", "Sweep/Last friction coefficient", "Sweep/Number of friction coefficients",
                             "Sweep/Tolerance", "Sweep/Maximum basis", "Sweep/Threshold tolerance", "Sweep/Parameter"})
      {
        study.own_parameters.push_back(path);
        study.rules.push_back({path, of_onsets});
      }
    study.check             = [](const Parameters &p) { p.robustness.parsed_correlations(); };
    study.run_of_system     = run_robustness_of_system;
    study.has_reduced_model = true;
    return study;
  }();
} // namespace Squeal
