// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/modes/contour_count.h>
#include <squeal/studies/sweep/sweep_charts.h>
#include <squeal/tracking/mode_links.h>

namespace Squeal
{
  namespace
  {
    /// Sum of all contact damping coefficients [N s/m].
    double damping_of(const OperatingPoint &point)
    {
      double sum = 0.;
      for (const char *name : {SystemParameter::radial_damping, SystemParameter::sliding_damping})
        if (const auto coefficients = point.values.find(name); coefficients != point.values.end())
          for (const double c : coefficients->second)
            sum += std::abs(c);
      return sum;
    }

    /// Training points: ends, middle and quarters of the first and last lines.
    std::vector<int> training(const ContactRegime &regime)
    {
      const auto [first, last] = std::minmax_element(regime.points.begin(), regime.points.end(),
                                                     [](const OperatingPoint &a, const OperatingPoint &b) { return a.line < b.line; });
      std::vector<int> result;
      for (const int line : {first->line, last->line})
        {
          const auto numbers = regime.on_line(line);
          for (const int place : ends_and_quarters(static_cast<int>(numbers.size())))
            if (std::find(result.begin(), result.end(), numbers[place]) == result.end())
              result.push_back(numbers[place]);
        }
      return result;
    }

    /// Throws ParameterError if counts are requested, but is_countable() is false.
    void check_countable(const CoupledSystem &system, const Run &run)
    {
      if (run.parameters.study->has("Sweep/Count modes at") && !run.parameters.sweep.counts.empty() && !is_countable(system))
        throw ParameterError("modes of this system can be counted on a single process only", "parameter Sweep/Count modes at",
                             "run on one process, or leave it empty");
    }

    /// Full-order modes of a point in the band, and their products from the reduced model.
    std::pair<ComplexModes, ModalProducts> modes_in_band(const SweepModel &model, const ChartPoint &point)
    {
      const std::vector<int> numbers = model.in_band(point);
      ComplexModes           result;
      for (const int j : numbers)
        {
          result.lambda.push_back(point.lambda[j]);
          result.energy_residuals.push_back(point.right_residuals[j]);
          result.estimated_errors.push_back(point.errors[j]);
        }

      auto [re, im]         = model.shapes(point, numbers);
      result.real_part      = std::make_shared<MultiVector>(std::move(re));
      result.imaginary_part = std::make_shared<MultiVector>(std::move(im));

      const ReducedModel &reduced = model.reduced->reduced();
      const DenseMatrix   X       = halves(with_rows(point.right(Eigen::placeholders::all, numbers), reduced.size()));
      return {result, {X.transpose() * reduced.stiffness() * X, X.transpose() * reduced.mass() * X}};
    }
  } // namespace

  std::vector<int> ends_and_quarters(const int n)
  {
    std::vector<int> result;
    for (const int i : {n - 1, (n - 1) / 2, (n - 1) / 4, 3 * (n - 1) / 4, 0})
      if (std::find(result.begin(), result.end(), i) == result.end())
        result.push_back(i);
    return result;
  }

  const OperatingPoint &most_damped(const ContactRegime &regime)
  {
    return *std::max_element(regime.points.begin(), regime.points.end(),
                             [](const OperatingPoint &a, const OperatingPoint &b) { return damping_of(a) < damping_of(b); });
  }

  SweepModel::SweepModel(const SweepPlan &plan, const ContactRegime &regime, Run &run, FrictionlessModes frictionless)
    : plan(plan)
    , regime(regime)
    , run(run)
    , largest_circular_frequency(circular_frequency(run.parameters.discretization.maximum_frequency))
    , frictionless(std::move(frictionless))
  {
    start();
  }

  SweepModel::SweepModel(const SweepPlan &plan, const ContactRegime &regime, Run &run)
    : plan(plan)
    , regime(regime)
    , run(run)
    , largest_circular_frequency(circular_frequency(run.parameters.discretization.maximum_frequency))
  {
    if (plan.file)
      {
        const CoupledSystem whole = imported_system(*plan.file, plan.values, plan.axis.name, largest_circular_frequency);
        check_countable(whole, run);
        frictionless = starting_modes(whole, run);
        start();
        return;
      }
    const OperatingPoint     &most      = most_damped(regime);
    const OperationParameters operation = plan.lines[most.line].at(most.friction_coefficient);
    const Linearisation       damped    = linearise(*plan.scene, plan.sliding_state(operation), operation);

    check_countable(damped.coupled, run);
    // Compute real modes and factor without damping
    Linearisation bare         = damped;
    bare.coupled               = undamped(damped.coupled);
    frictionless               = frictionless_modes(bare, run, band_margin);
    frictionless.linearisation = damped;
    add_modal_damping(frictionless, run.parameters);
    start();
  }

  void SweepModel::start()
  {
    if (!frictionless.linearisation.coupled.stiffness)
      {
        run.progress.note("  no definite part: every value is solved at full order, and modes are numbered as at the first value");
        return;
      }
    run.progress.begin("Reduced model");
    reduced = std::make_unique<ChartModel>(frictionless.linearisation.coupled, *frictionless.inverse, frictionless.shift,
                                           *frictionless.real.vectors, largest_circular_frequency);
    if (const auto &discretization = run.parameters.discretization; plan.file || discretization.maximum_rate > 0.)
      reduced->leave_out_faster_decay(discretization.band().rate);
    run.progress.finish(counted(reduced->size(), "vector") + " initially");
  }

  void SweepModel::restart(std::unique_ptr<ChartModel> model)
  {
    reduced = std::move(model);
    known.clear();
    reference_products.clear();
  }

  std::vector<ChartPoint> SweepModel::evaluate(const int line, const std::vector<double> &friction_coefficients)
  {
    std::vector<OperatingPoint> missing;
    for (const double mu : friction_coefficients)
      if (known.count({line, mu}) == 0)
        missing.push_back(plan.point(line, mu, regime.closed));
    const auto keep = [&](const int i, ChartPoint &&found) {
      known.emplace(std::make_pair(line, missing[i].friction_coefficient), std::move(found));
    };
    if (reduced)
      Squeal::evaluate(*reduced, missing, run.communicator, keep);
    else
      for (std::size_t i = 0; i < missing.size(); ++i)
        keep(static_cast<int>(i), evaluate_directly(missing[i]));
    std::vector<ChartPoint> result;
    for (const double mu : friction_coefficients)
      result.push_back(known.at({line, mu}));
    return result;
  }

  std::pair<MultiVector, MultiVector> SweepModel::shapes(const ChartPoint &point, const std::vector<int> &modes) const
  {
    if (!reduced)
      {
        const RowMap            &map = frictionless.linearisation.coupled.map();
        const ComplexDenseMatrix X   = point.right(Eigen::placeholders::all, modes);
        return {distribute(X.real(), map), distribute(X.imag(), map)};
      }
    const ComplexDenseMatrix X = with_rows(point.right(Eigen::placeholders::all, modes), reduced->size());
    const MultiVector       &T = reduced->reduced().basis();
    return {T * DenseMatrix(X.real()), T * DenseMatrix(X.imag())};
  }

  std::vector<ShapeShares> SweepModel::shape_shares(const ChartPoint &point, const std::vector<int> &modes) const
  {
    const ReducedModel &model = reduced->reduced();
    // Compute products for new vectors only: once modes have been labelled, the basis is extended, but not replaced
    const int n_known = reference_products.empty() ? 0 : static_cast<int>(reference_products.front().cols());
    if (n_known < model.size())
      {
        const auto added = frictionless.reference_products(view(model.basis(), n_known, model.size() - n_known));
        reference_products.resize(added.size());
        for (std::size_t i = 0; i < added.size(); ++i)
          reference_products[i] = append_columns(reference_products[i], added[i]);
      }
    return Squeal::shape_shares(frictionless.references(), reference_products, model.mass(),
                                halves(with_rows(point.right(Eigen::placeholders::all, modes), model.size())));
  }

  std::vector<ModeLabel> SweepModel::labels(const ChartPoint &point, const std::vector<int> &modes) const
  {
    return reduced ? identify(frictionless.references(), shape_shares(point, modes)) : labels_by_number(point, modes);
  }

  std::vector<int> SweepModel::in_band(const ChartPoint &point) const
  {
    std::vector<int> result;
    for (std::size_t j = 0; j < point.lambda.size(); ++j)
      if (is_in_band(point.lambda[j]))
        result.push_back(static_cast<int>(j));
    return result;
  }

  double SweepModel::largest_error(const ChartPoint &point) const
  {
    if (reduced)
      return reduced->largest_error(point);
    double result = 0.;
    for (const int j : in_band(point))
      result = std::max(result, point.errors[j]);
    return result;
  }

  int SweepModel::n_of(const ChartPoint &point, const Verdict verdict) const
  {
    const std::vector<int> modes = in_band(point);
    return std::count_if(modes.begin(), modes.end(), [&](const int j) { return point.verdicts[j] == verdict; });
  }

  std::vector<ModeLabel> SweepModel::labels_in_band(const ChartPoint &point) const
  {
    const std::vector<int> modes  = in_band(point);
    std::vector<ModeLabel> result = labels(point, modes);
    std::vector<double>    growth;
    for (const int j : modes)
      growth.push_back(point.verdicts[j] == Verdict::unstable ? point.lambda[j].real() : 0.);
    mark_doublets(result, growth);
    return result;
  }

  Linearisation SweepModel::linearisation_at(const double friction_coefficient) const
  {
    Linearisation result = frictionless.linearisation;
    result.coupled       = with_values(result.coupled, plan.point(0, friction_coefficient, regime.closed).values);
    return result;
  }

  /// Evaluates all points at full order, as a step of the run.
  static void evaluate_points_directly(SweepModel &model)
  {
    Run &run = model.run;
    run.progress.begin("Sweep");
    double worst = 0.;
    for (const OperatingPoint &point : model.regime.points)
      worst = std::max(worst, model.largest_error(model.evaluate(point.line, {point.friction_coefficient}).front()));
    run.progress.finish(text(counted(model.known.size(), "operating point"), " at full order, estimated error ", worst));
    run.measure("largest estimated error of lambda [-]", worst);
  }

  void evaluate_again(SweepModel &model)
  {
    std::map<int, std::vector<double>> of_line;
    for (const auto &[place, point] : model.known)
      of_line[place.first].push_back(place.second);
    model.known.clear();
    for (const auto &[line, friction_coefficients] : of_line)
      model.evaluate(line, friction_coefficients);
    model.sharpens_thresholds = false;
  }

  void evaluate_points(SweepModel &model)
  {
    if (!model.reduced)
      return evaluate_points_directly(model);
    Run                               &run    = model.run;
    const std::vector<OperatingPoint> &points = model.regime.points;
    ErrorControlledSweepOptions        options;
    options.tolerance     = run.parameters.sweep.tolerance;
    options.maximum_basis = static_cast<int>(run.parameters.sweep.maximum_basis);
    run.progress.begin("Sweep");
    int                        last  = -1;
    const ErrorControlledSweep sweep = error_controlled_sweep(
      *model.reduced, points, training(model.regime), options,
      [&](const int i, ChartPoint &&point) {
        last = std::max(last, i);
        model.known.emplace(std::make_pair(points[i].line, points[i].friction_coefficient), std::move(point));
      },
      run.communicator, run.progress);
    run.progress.finish(text(model.known.size(), " of ", points.size(), " operating points, ", counted(model.reduced->size(), "vector"),
                             ", estimated error ", sweep.worst_error));
    run.count("basis vectors", model.reduced->size());
    run.measure("largest estimated error of lambda [-]", sweep.worst_error);
    // Report conditioning at the last value, where eigenvalues are usually most ill-conditioned. Twice the tolerance allows for rounding
    // errors in addition to errors of the basis
    if (last >= 0)
      {
        const auto [modes, products] = modes_in_band(model, model.known.at({points[last].line, points[last].friction_coefficient}));
        const CoupledSystem &coupled = model.frictionless.linearisation.coupled;
        record_conditioning(coupled, modes,
                            estimate_conditioning(coupled, *model.frictionless.inverse, model.frictionless.shift, modes, products),
                            2. * options.tolerance, run);
      }
    if (!sweep.why_stopped.empty())
      run.progress.note(text("  note: omitted operating points: ", points.size() - model.known.size(),
                             ", because estimated errors exceed the tolerance of ", options.tolerance, ": ", sweep.why_stopped,
                             ". Raise Sweep/Tolerance, or Sweep/Maximum basis if it limits the basis"));
  }
} // namespace Squeal
