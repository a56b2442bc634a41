// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/estimates/mode_pairing.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/studies/designs/design_solution.h>

#include <numeric>

namespace Squeal
{
  namespace
  {
    /// Rows of the reference shapes that belong to the bodies in @p chosen.
    DenseMatrix rows_of(const ReferenceModes &reference, const CommonPoints &chosen)
    {
      DenseMatrix  result(3 * chosen.n(), reference.shapes.cols());
      Eigen::Index from = 0, to = 0;
      auto         next = chosen.bodies.begin();
      for (const CommonPoints::Body &body : reference.points.bodies)
        {
          const auto n = static_cast<Eigen::Index>(3 * body.points.size());
          if (next != chosen.bodies.end() && next->name == body.name)
            {
              result.middleRows(to, n) = reference.shapes.middleRows(from, n);
              to += n;
              ++next;
            }
          from += n;
        }
      return result;
    }

    /// Labels of the branches of a chart: names of the reference modes most similar to the first mode of each branch.
    std::vector<ReferenceName> names_of_branches(const SweepModel &model, const SweepChart &chart, const ReferenceModes &reference)
    {
      const std::vector<Branch>      &branches = chart.chart.branches;
      std::vector<ReferenceName>      result(branches.size());
      std::map<int, std::vector<int>> branches_from; // branches by the index of their first point
      for (std::size_t b = 0; b < branches.size(); ++b)
        branches_from[branches[b].begin()].push_back(static_cast<int>(b));
      const Linearisation &linearisation = model.frictionless.linearisation;
      for (const auto &[i, members] : branches_from)
        {
          // Compare all modes of the point, because names are assigned jointly
          const ChartPoint &point = chart.chart.points[i];
          ComplexModes      modes;
          std::vector<int>  all(point.lambda.size());
          std::iota(all.begin(), all.end(), 0);
          auto [re, im]                          = model.shapes(point, all);
          modes.lambda                           = point.lambda;
          modes.real_part                        = std::make_shared<MultiVector>(std::move(re));
          modes.imaginary_part                   = std::make_shared<MultiVector>(std::move(im));
          const std::vector<ReferenceName> names = names_by(reference, *linearisation.scene->model, *linearisation.coupled.kernel, modes);
          for (const int b : members)
            result[b] = names[branches[b].modes[i]];
        }
      return result;
    }

    /// Replaces @p found if @p onset has a smaller friction coefficient, to find the first onset of several charts.
    void keep_first(const std::optional<GrowthOnset> &onset, const std::vector<std::string> &labels, boost::optional<DesignGrowth> &found)
    {
      if (!onset || (found && found->friction_coefficient <= onset->friction_coefficient))
        return;
      const ModalQuantities quantities = modal_quantities(onset->lambda);
      found                            = DesignGrowth{onset->friction_coefficient, onset->uncertainty,         labels[onset->branch],
                           quantities.frequency,        quantities.divergence_rate, 0.};
    }

    boost::optional<double> overlap(const ReferenceName &name)
    {
      return name.in_cluster || name.name.empty() ? boost::optional<double>() : name.overlap;
    }

    /// Adds the results of a chart to its design. If the contact set changes, each chart covers a part of the friction coefficients.
    void take_over(SweepModel           &model,
                   const SweepChart     &sweep,
                   const ReferenceModes &reference,
                   double               &largest_friction_coefficient,
                   DesignResult         &result)
    {
      const StabilityChart            &chart = sweep.chart;
      const std::vector<ReferenceName> names = names_of_branches(model, sweep, reference);
      std::vector<std::string>         labels;
      for (std::size_t b = 0; b < names.size(); ++b)
        labels.push_back(names[b].name.empty() ? to_string(sweep.labels[b]) : names[b].name);

      keep_first(sweep.onset, labels, result.onset);
      keep_first(sweep.weak_onset, labels, result.weak_onset);
      for (const Threshold &threshold : chart.thresholds)
        {
          const int b = threshold.branch;
          result.thresholds.push_back(
            {threshold.friction_coefficient, threshold.uncertainty, to_string(threshold.event), to_string(threshold.mechanism), labels[b],
             overlap(names[b]), threshold.partner >= 0 ? labels[threshold.partner] : "", modal_quantities(threshold.lambda).frequency});
        }
      for (std::size_t b = 0; b < chart.branches.size(); ++b)
        {
          DesignMode mode;
          mode.label     = labels[b];
          mode.own_label = to_string(sweep.labels[b]);
          mode.overlap   = overlap(names[b]);
          bool is_seen = false, grows = false;
          for (std::size_t i = 0; i < chart.points.size(); ++i)
            if (const int j = chart.branches[b].modes[i]; j >= 0 && model.is_in_band(chart.points[i].lambda[j]))
              {
                const ChartPoint     &point      = chart.points[i];
                const ModalQuantities quantities = modal_quantities(point.lambda[j]);
                if (!is_seen)
                  mode.first_frequency = quantities.frequency;
                is_seen                        = true;
                mode.last_friction_coefficient = point.friction_coefficient;
                mode.last_frequency            = quantities.frequency;
                mode.last_growth_rate          = quantities.growth_rate;
                mode.last_divergence_rate      = quantities.divergence_rate;
                mode.last_error                = point.errors[j];
                mode.verdict                   = to_string(point.verdicts[j]);
                mode.largest_divergence_rate   = std::max(mode.largest_divergence_rate, quantities.divergence_rate);
                grows                          = grows || point.verdicts[j] == Verdict::unstable;
                // Skip refinement points, which lie near coalescences, where errors of λ are large and not representative
                if (!chart.is_refinement[i])
                  {
                    result.largest_error    = std::max(result.largest_error, point.errors[j]);
                    result.largest_residual = std::max({result.largest_residual, point.right_residuals[j], point.left_residuals[j]});
                  }
                if (point.verdicts[j] == Verdict::unstable && (!result.worst || quantities.divergence_rate > result.worst->divergence_rate))
                  result.worst = DesignGrowth{
                    point.friction_coefficient, 0., labels[b], quantities.frequency, quantities.divergence_rate, point.errors[j]};
              }
          if (!is_seen)
            continue;
          for (const Threshold &threshold : chart.thresholds)
            if (threshold.branch == static_cast<int>(b) && threshold.event == ThresholdEvent::onset && !mode.onset)
              mode.onset = threshold.friction_coefficient;
          result.n_growing += grows;
          result.modes.push_back(mode);
        }
      result.n_doubtful += chart.n_doubtful_steps;
      for (const ChartCount &count : chart.counts)
        result.is_complete = result.is_complete && count.n_modes == count.n_expected;
      const ChartPoint &last = chart.points.back();
      if (last.friction_coefficient < largest_friction_coefficient)
        return;
      largest_friction_coefficient = last.friction_coefficient;
      result.n_unstable            = model.n_of(last, Verdict::unstable);
      result.n_undecided           = model.n_of(last, Verdict::undecided);
    }

    /// Compares the number of modes in the band at the first friction coefficient with the number of real modes by inertia; @p n_counted
    /// includes rigid-body modes.
    void compare_counts(const SweepModel &model, const SweepChart &sweep, const int n_counted, DesignResult &result)
    {
      const ChartCount &first = sweep.chart.counts.front();
      result.n_modes          = first.n_modes + first.n_overdamped;
      result.n_counted        = n_counted - model.frictionless.real.n_rigid_body;
      // Compare only without damping and friction, which may move modes across the end of the band
      if (first.friction_coefficient == 0. && !model.frictionless.linearisation.coupled.has_damping())
        result.is_complete = result.is_complete && result.n_modes == result.n_counted;
    }
    DesignResult begun_result(const Scene &scene)
    {
      DesignResult result;
      result.outcome     = DesignOutcome::solved;
      result.is_complete = true;
      result.n_dofs      = scene.model->free_map().n();
      return result;
    }

    void sort_thresholds(DesignResult &result)
    {
      std::stable_sort(result.thresholds.begin(), result.thresholds.end(),
                       [](const DesignThreshold &a, const DesignThreshold &b) { return a.friction_coefficient < b.friction_coefficient; });
    }
  } // namespace

  ReferenceModes reference_modes(const FrictionlessModes &modes, const MaterialParameters &materials)
  {
    const Linearisation &linearisation = modes.linearisation;
    const Model         &model         = *linearisation.scene->model;
    constexpr int        of_rule       = 0; // this rule has points at the centres of cells
    ReferenceModes       result{body_frames(model), common_points(model, materials, of_rule), {}, {}, {}};
    const auto           E = displacements_at(result.points, model, Directions::cylindrical);
    result.shapes          = gather(*E * (*linearisation.coupled.kernel * *modes.real.vectors));
    for (std::size_t j = 0; j < modes.labels.size(); ++j)
      {
        result.lambda.emplace_back(0., std::sqrt(std::max(0., modes.real.eigenvalues[j])));
        result.names.push_back(to_string(modes.labels[j]));
      }
    return result;
  }

  std::vector<ReferenceName> names_by(const ReferenceModes &reference,
                                      const Model          &model,
                                      const SparseMatrix   &kernel,
                                      const ComplexModes   &modes)
  {
    const CommonPoints         points = carried_over(reference.points, reference.frames, body_frames(model));
    const auto                 E      = displacements_at(points, model, Directions::cylindrical);
    const ModesAtPoints        here   = at_points(*E, kernel, modes);
    const MultiVector          shapes = scatter(rows_of(reference, points), here.real_part.map());
    const ModesAtPoints        there  = {reference.lambda, shapes, MultiVector(shapes.map(), shapes.n_columns())};
    std::vector<ReferenceName> result;
    for (const PairedMode &mode : pair_modes(there, here).fine)
      result.push_back({mode.partner >= 0 ? reference.names[mode.partner] : "", mode.overlap, mode.in_cluster});
    return result;
  }

  Parameters sweep_of(const Parameters &design)
  {
    Parameters       result   = design;
    SweepParameters &sweep    = result.sweep;
    sweep.compare_dissipation = false;
    sweep.map_parameter       = MapParameter::none;
    sweep.mode_shapes         = {};
    sweep.planes              = {};
    sweep.counts              = {};
    result.output             = {};
    result.designs            = {};
    return result;
  }

  DesignResult solve_member(DesignFamily &family, const std::size_t design, const ReferenceModes &reference)
  {
    const Stopwatch            stopwatch;
    const DesignFamily::Member member     = family.solve(design);
    double                     largest_mu = 0.;
    DesignResult               result     = begun_result(family.scene);
    take_over(member.model, member.chart, reference, largest_mu, result);
    compare_counts(member.model, member.chart, member.n_counted, result);
    sort_thresholds(result);
    result.seconds = stopwatch.cost().seconds;
    return result;
  }

  DesignResult solve_design(const Parameters &parameters, const ReferenceModes &reference, Run &run)
  {
    const Stopwatch  stopwatch;
    const Parameters sweep = sweep_of(parameters);
    Progress         silent;
    Run              part(sweep, run, silent);
    Scene            scene = mesh_scene(part);
    assemble_scene(scene, part);

    const SweepPlan                      plan = sweep_plan(scene, part);
    std::vector<std::vector<SweepChart>> charts(plan.lines.size());
    double                               largest_friction_coefficient = 0.; // maximum over all charts so far
    DesignResult                         result                       = begun_result(scene);
    for (const ContactRegime &regime : plan.regimes)
      {
        SweepModel model(plan, regime, part);
        evaluate_points(model);
        if (model.known.size() < regime.points.size())
          throw SolverError(text("estimated errors exceed Sweep/Tolerance at ", regime.points.size() - model.known.size(), " of ",
                                 counted(regime.points.size(), "friction coefficient")),
                            "sweep of the design", "raise Sweep/Tolerance, or Sweep/Maximum basis if it limits the basis");
        const std::size_t before = charts[0].size();
        follow_branches(model, charts);
        for (std::size_t s = before; s < charts[0].size(); ++s)
          {
            take_over(model, charts[0][s], reference, largest_friction_coefficient, result);
            if (s == 0)
              {
                const double limit = model.largest_circular_frequency * model.largest_circular_frequency;
                compare_counts(model, charts[0][s], static_cast<int>(n_in_band(model.frictionless.real.eigenvalues, limit)), result);
              }
          }
      }
    sort_thresholds(result);
    result.seconds = stopwatch.cost().seconds;
    return result;
  }
} // namespace Squeal
