#include <squeal/base/conventions.h>
#include <squeal/studies/steps/friction_modes.h>
#include <squeal/studies/steps/mode_results.h>
#include <squeal/studies/sweep/sweep_results.h>
#include <squeal/tracking/branches.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    /// Label of the branch that a mode resembles most, at the point of the chart nearest to its own.
    ModeLabel nearest_label(const SweepChart &main, const ChartPoint &point, const int mode)
    {
      const auto &points   = main.chart.points;
      const auto  distance = [&](const ChartPoint &other) { return std::abs(other.friction_coefficient - point.friction_coefficient); };
      const auto  nearest =
        std::min_element(points.begin(), points.end(), [&](const ChartPoint &a, const ChartPoint &b) { return distance(a) < distance(b); });
      const int branch = similar_branch(main.chart, static_cast<int>(nearest - points.begin()), point, mode, false);
      return branch >= 0 ? main.labels[branch] : ModeLabel();
    }

    /// The modes of a line at one of the chosen friction coefficients, which may miss the tolerance.
    ChartPoint modes_at(SweepModel &model, const double mu, const int line = 0)
    {
      const bool       is_new    = model.known.count({line, mu}) == 0;
      const ChartPoint point     = model.evaluate(line, {mu}).front();
      const double     tolerance = model.run.parameters.sweep.tolerance, error = model.reduced->largest_error(point);
      if (is_new && !(error <= tolerance))
        model.run.progress.note(text("  note: at mu = ", mu, line > 0 ? " without radial dissipation" : "",
                                     " the modes miss the tolerance of ", tolerance, ": the estimated error is ", error));
      return point;
    }
  } // namespace

  void append_map_cells(const SweepModel &model, const SweepChart *main, std::vector<MapCell> &cells)
  {
    for (const OperatingPoint &operating : model.regime.points)
      {
        const SweepLine &line = model.plan.lines[operating.line];
        if (line.kind != SweepLine::Kind::map)
          continue;
        cells.push_back(
          {operating.friction_coefficient, line.value, model.plan.scene.interface.size() - model.regime.closed.size(), {}, {}});
        const auto found = model.known.find({operating.line, operating.friction_coefficient});
        if (found == model.known.end())
          continue;
        MapCell          &cell  = cells.back();
        const ChartPoint &point = found->second;
        if (const int mode = leading_mode(point, model.largest_circular_frequency); mode >= 0)
          {
            cell.leading = modal_quantities(point.lambda[mode]);
            if (main)
              cell.label = nearest_label(*main, point, mode);
          }
        for (std::size_t j = 0; j < point.lambda.size(); ++j)
          if (model.is_in_band(point.lambda[j]))
            {
              cell.n_unstable += point.verdicts[j] == Verdict::unstable;
              cell.n_undecided += point.verdicts[j] == Verdict::undecided;
            }
        cell.error = model.reduced->largest_error(point);
      }
  }

  void append_plane_modes(SweepModel &model, std::vector<PlaneMode> &modes)
  {
    for (const double mu : model.run.parameters.sweep.complex_plane())
      for (std::size_t line = 0; line < model.plan.lines.size(); ++line)
        {
          if (model.plan.lines[line].kind == SweepLine::Kind::map || model.plan.closed_at(mu) != model.regime.closed)
            continue;
          const ChartPoint    point = modes_at(model, mu, static_cast<int>(line));
          std::vector<int>    in_band;
          std::vector<double> growth; // zero for a mode that does not grow, as in a run at one friction coefficient
          for (int j = 0; j < static_cast<int>(point.lambda.size()); ++j)
            if (model.is_in_band(point.lambda[j]))
              {
                in_band.push_back(j);
                growth.push_back(point.verdicts[j] == Verdict::unstable ? point.lambda[j].real() : 0.);
              }
          std::vector<ModeLabel> labels = model.labels(point, in_band);
          mark_doublets(labels, growth);
          for (std::size_t k = 0; k < in_band.size(); ++k)
            {
              const int j = in_band[k];
              modes.push_back(
                {mu, model.plan.lines[line].operation.radial_dissipation, point.lambda[j], labels[k], point.errors[j], point.verdicts[j]});
            }
        }
  }

  void append_counts(SweepModel &model, std::vector<CountAt> &counts)
  {
    Run         &run       = model.run;
    const double omega_max = model.largest_circular_frequency;
    for (const double mu : run.parameters.sweep.counts)
      {
        if (model.plan.closed_at(mu) != model.regime.closed)
          continue;
        run.progress.begin("Argument principle");
        const CoupledSystem system  = model.linearisation_at(mu).coupled;
        const auto          options = contour_of_band(system, model.frictionless, omega_max, run.parameters.solvers);
        const ContourCount  count   = count_by_contour(system, {mu}, options, run.progress).front();
        const ChartPoint    point   = modes_at(model, mu);
        const int           n_found = std::count_if(point.lambda.begin(), point.lambda.end(), [&](const std::complex<double> &lambda) {
          return lambda.imag() >= options.lowest_frequency && lambda.imag() <= omega_max &&
                 std::abs(lambda.real()) <= options.largest_growth;
        });
        counts.push_back({mu, n_found, count});
        run.progress.finish(text(count.n_modes, " modes counted, ", n_found, " found at mu = ", mu, ", ", count.n_points, " points"));
        if (count.n_modes != n_found)
          run.progress.note(text("  note: at mu = ", mu, " the sweep has ", n_found, " modes where ", count.n_modes, " were counted"));
      }
  }

  void write_leading_modes(SweepModel &model)
  {
    Run        &run    = model.run;
    const auto &wanted = run.parameters.sweep.mode_shapes;
    if (wanted.empty() || run.parameters.output.fields == FieldSelection::none)
      return;
    const Scene &scene = model.plan.scene;
    FieldWriter  writer(*scene.model, scene.interface, model.regime.closed, run.folder());
    run.progress.begin("Mode shapes");
    int n_written = 0;
    for (const double mu : wanted)
      {
        if (model.plan.closed_at(mu) != model.regime.closed)
          continue;
        const ChartPoint point = modes_at(model, mu);
        const int        mode  = leading_mode(point, model.largest_circular_frequency);
        if (mode < 0 || verdict_of(point.lambda[mode]) != Verdict::unstable)
          {
            run.progress.note(text("  no mode grows at mu = ", mu, ": no mode shape is written"));
            continue;
          }
        const auto [re, im] = model.shapes(point, {mode});
        const auto label    = model.labels(point, {mode}).front();
        const auto name     = text("mu_", mu, "_", file_text(label));
        ModeField  field    = mode_field(model.linearisation_at(mu), name, point.lambda[mode], re, im);
        field.title         = mode_title(label, point.lambda[mode]);
        writer.write_mode(field);
        if (run.parameters.output.animation_frames > 0)
          writer.write_animation(field, animation_options(run.parameters.output));
        ++n_written;
      }
    run.progress.finish(text(n_written, " leading modes"));
  }
} // namespace Squeal
