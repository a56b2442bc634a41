// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/studies/designs/design_solution.h>

namespace Squeal
{
  /// Part of the tolerance for the common basis; the rest is for the truncation of the basis of a design [-].
  static constexpr double part_of_common_basis = 0.5;

  std::string family_key(const Parameters &design)
  {
    if (design.needs_steady_sliding() || design.operation.rotating_disc || !design.damping.modal_ratios.empty())
      return "";
    return text_without_coefficients(design);
  }

  DesignFamily::DesignFamily(const std::vector<Parameters> &designs, Run &run)
    : scene(mesh_scene(run))
    , run(run)
  {
    const BodyTerms              bodies = assemble_scene(scene, run);
    std::vector<SweepLine>       lines;
    std::vector<ParameterValues> values;
    for (const Parameters &design : designs)
      {
        lines.push_back({SweepLine::Kind::main, design.operation, 0., design.sweep.friction_coefficients.linear()});
        values.push_back(body_values(*scene.model, design.materials));
      }
    plan = std::make_unique<SweepPlan>(sweep_plan(scene, lines, run));

    // All designs of a family have the same kinds of contact damping
    ContactRegime        &regime = plan->regimes.front();
    const OperatingPoint &most   = most_damped(regime);
    SystemFamily          family =
      system_family(bodies, values, linearise(scene, {}, plan->lines[most.line].at(most.friction_coefficient)), band_margin, run);
    for (OperatingPoint &point : regime.points)
      point.values.insert(family.terms.members[point.line].begin(), family.terms.members[point.line].end());
    for (std::size_t d = 0; d < designs.size(); ++d)
      plan->lines[d].values = family.terms.members[d];
    model                      = std::make_unique<SweepModel>(*plan, regime, run, std::move(family.middle));
    model->sharpens_thresholds = false; // enriching the basis of every design would take a fifth longer
    common                     = std::move(model->reduced);
    common->estimate_without_cancellation();
  }

  std::vector<OperatingPoint> DesignFamily::points_of(const std::size_t design) const
  {
    std::vector<OperatingPoint> result;
    for (const int i : model->regime.on_line(static_cast<int>(design)))
      result.push_back(model->regime.points[i]);
    return result;
  }

  void DesignFamily::solve(ChartModel                        &reduced,
                           const std::vector<OperatingPoint> &points,
                           const double                       part_of_tolerance,
                           const KeepPoint                   &keep)
  {
    // Basis size above which reduced matrices become expensive
    constexpr int               most_vectors = 900;
    ErrorControlledSweepOptions options;
    options.tolerance     = part_of_tolerance * run.parameters.sweep.tolerance;
    options.maximum_basis = most_vectors;
    run.progress.begin("Family");
    const ErrorControlledSweep found = error_controlled_sweep(reduced, points, {}, options, keep, run.communicator, run.progress);
    if (found.n_left > 0)
      throw SolverError(text("the basis of designs on one mesh is not accurate enough: ", found.why_stopped), "designs on one mesh",
                        "raise Sweep/Tolerance");
    run.progress.finish(
      text(counted(points.size(), "operating point"), ", ", counted(reduced.size(), "vector"), ", estimated error ", found.worst_error));
  }

  DesignFamily::Member DesignFamily::solve(const std::size_t design)
  {
    const std::vector<OperatingPoint> points = points_of(design);
    std::vector<OperatingPoint>       some;
    std::vector<ChartPoint>           charts;
    for (const int i : ends_and_quarters(static_cast<int>(points.size())))
      some.push_back(points[i]);
    solve(*common, some, part_of_common_basis, [&](int, ChartPoint &&point) { charts.push_back(std::move(point)); });
    model->restart(common->restricted(charts, run.parameters.sweep.tolerance));
    solve(*model->reduced, points, 1., [&](const int i, ChartPoint &&point) {
      model->known.emplace(std::make_pair(points[i].line, points[i].friction_coefficient), std::move(point));
    });

    run.progress.begin("Mode count");
    CoupledSystem system = with_values(model->frictionless.linearisation.coupled, plan->lines[design].values);
    set_frictionless_matrices(system);
    const double limit     = model->largest_circular_frequency * model->largest_circular_frequency;
    const int    n_counted = count_below(*system.stiffness, *system.mass, limit, "real modes of a design").n_modes;
    run.progress.finish(text(n_counted, " by inertia"));

    std::vector<double> friction_coefficients;
    for (const OperatingPoint &point : points)
      friction_coefficients.push_back(point.friction_coefficient);
    return {*model, follow_branches(*model, static_cast<int>(design), friction_coefficients), n_counted};
  }
} // namespace Squeal
