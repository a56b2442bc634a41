// SPDX-License-Identifier: GPL-3.0-or-later

#include "solutions.h"

#include <squeal/base/tasks.h>
#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/tracking/branches.h>
#include <squeal/tracking/error_controlled_sweep.h>

#include <map>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /// Model with the damping, inverse and real modes that a sweep requires.
  struct Chart
  {
    explicit Chart(const double c_b, const double c_t = 0., const std::vector<PolarPin> &pins = skewed_pins)
      : s(mesh_of(pins), mounted(), operating())
      , damping{{}, {}}
      , inverse(s.coupled, 0., FactorizationLibrary::automatic)
      , real(real_modes(s.coupled))
    {
      if (c_b != 0.)
        damping.radial.assign(s.interface.size(), c_b);
      if (c_t != 0.)
        damping.sliding.assign(s.interface.size(), c_t);
      system = with_values(s.coupled, damping.values());
    }

    ChartModel model() const
    {
      return ChartModel(system, inverse, 0., *real.vectors, omega_max);
    }

    /// Operating point with damping proportional to the friction coefficient.
    OperatingPoint at(const double friction) const
    {
      OperatingPoint point{friction, damping.values()};
      for (auto &[parameter, coefficients] : point.values)
        for (double &c : coefficients)
          c *= friction / 0.8;
      return point;
    }

    std::vector<OperatingPoint> points(const std::vector<double> &friction_coefficients = {0., 0.2, 0.4, 0.6, 0.8}) const
    {
      std::vector<OperatingPoint> result;
      for (const double mu : friction_coefficients)
        result.push_back(at(mu));
      return result;
    }

    std::vector<Complex> in_band(const ChartPoint &point) const
    {
      std::vector<Complex> result;
      for (const Complex &l : point.lambda)
        if (l.imag() <= omega_max)
          result.push_back(l);
      return result;
    }

    Scene          s;
    ContactDamping damping;
    CoupledSystem  system;
    UpdatedInverse inverse;
    SymmetricModes real;
  };

  struct Swept : ErrorControlledSweep
  {
    std::vector<std::optional<ChartPoint>> points;
  };

  Swept sweep(ChartModel &model, const std::vector<OperatingPoint> &points, const ErrorControlledSweepOptions &options)
  {
    Progress progress;
    Swept    result{{}, std::vector<std::optional<ChartPoint>>(points.size())};
    static_cast<ErrorControlledSweep &>(result) = error_controlled_sweep(
      model, points, {static_cast<int>(points.size()) - 1, 0}, options,
      [&](const int i, ChartPoint &&point) { result.points[i] = std::move(point); }, MPI_COMM_WORLD, progress);
    return result;
  }

  /// Reduced model accurate for 0 ≤ μ ≤ 0.3, with the contact damping μ c_b [N s/m].
  struct Predicted : Chart
  {
    explicit Predicted(const double c_b)
      : Chart(0.8 * c_b, 0., symmetric_pins)
      , accurate(model())
    {
      EXPECT_TRUE(sweep(accurate, points({0., 0.1, 0.2, 0.3}), {}).why_stopped.empty());
    }

    std::optional<double> predicted_zero(const ZeroSearch &search) const
    {
      return accurate.predicted_zero(search, at(search.first.point->friction_coefficient), at(search.second.point->friction_coefficient));
    }

    StabilityChart chart(const bool predicts) const
    {
      const ChartOptions options  = {omega_max, 1e-7};
      const auto         modes_at = [&](const std::vector<double> &values) { return evaluate(accurate, points(values), MPI_COMM_WORLD); };
      return stability_chart({0., 0.1, 0.2}, modes_at, options,
                             predicts ? PredictZero([&](const ZeroSearch &search) { return predicted_zero(search); }) : PredictZero());
    }

    ChartModel accurate;
  };
} // namespace

TEST(ErrorControlledSweep, AgreesWithFullOrder)
{
  for (const auto &[c_b, c_t, tolerance] : {std::array<double, 3>{{0., 0., 1e-6}}, {{40., -10., 1e-8}}})
    {
      const Chart                 chart(c_b, c_t);
      const auto                  points = chart.points();
      ErrorControlledSweepOptions options;
      options.tolerance = tolerance;
      ChartModel model  = chart.model();
      const auto result = sweep(model, points, options);
      EXPECT_TRUE(result.why_stopped.empty());
      EXPECT_LE(result.worst_error, tolerance);
      EXPECT_LT(orthonormality_defect(*chart.system.mass, model.reduced().basis()), 1e-12);
      for (const int i : {0, 2, 4})
        {
          ASSERT_TRUE(result.points[i].has_value());
          const auto full = krylov(with_values(chart.system, points[i].values), points[i].friction_coefficient, 1e-11).lambda;
          EXPECT_LT(largest(distances(chart.in_band(*result.points[i]), full)), 2. * tolerance)
            << "c_b " << c_b << ", mu " << points[i].friction_coefficient;
        }
    }
}

TEST(ErrorControlledSweep, ThreadsChangeNothing)
{
  const Chart                       chart(300.);
  const ChartModel                  model  = chart.model();
  const std::vector<OperatingPoint> points = chart.points();
  const auto                        by     = [&](const unsigned int n) {
    set_task_threads(n);
    auto result = evaluate(model, points, MPI_COMM_WORLD);
    set_task_threads(1);
    return result;
  };
  const std::vector<ChartPoint> one     = by(1);
  const std::vector<ChartPoint> several = by(16);
  ASSERT_EQ(several.size(), one.size());
  for (std::size_t i = 0; i < one.size(); ++i)
    {
      EXPECT_LT(largest(distances(one[i].lambda, several[i].lambda)), 1e-12);
      EXPECT_EQ(several[i].friction_coefficient, points[i].friction_coefficient);
      ASSERT_EQ(several[i].verdicts, one[i].verdicts);
      for (std::size_t j = 0; j < one[i].errors.size(); ++j)
        EXPECT_NEAR(several[i].errors[j], one[i].errors[j], 1e-12 + 1e-9 * one[i].errors[j]);
    }
}

TEST(ErrorControlledSweep, StopsAtWhatItProved)
{
  const Chart                 chart(0.);
  const auto                  points = chart.points();
  ErrorControlledSweepOptions options;
  options.tolerance     = 1e-9;
  options.maximum_basis = static_cast<int>(2 * chart.real.eigenvalues.size());
  ChartModel model      = chart.model();
  const auto result     = sweep(model, points, options);
  EXPECT_NE(result.why_stopped.find("the basis would exceed " + std::to_string(options.maximum_basis) + " vectors"), std::string::npos);
  EXPECT_LE(model.size(), options.maximum_basis);
  ASSERT_TRUE(result.points.front().has_value()); // exact, because the basis contains the real modes
  EXPECT_FALSE(result.points.back().has_value());
  EXPECT_LE(result.worst_error, options.tolerance);

  // The sweep stops because of rounding errors before the basis spans the whole space
  options.tolerance     = 1e-16;
  options.maximum_basis = static_cast<int>(chart.s.coupled.map().n());
  ChartModel rounded    = chart.model();
  const auto stopped    = sweep(rounded, {chart.at(0.8)}, options);
  EXPECT_NE(stopped.why_stopped.find("rounding"), std::string::npos) << stopped.why_stopped;
  EXPECT_LT(rounded.size(), options.maximum_basis);
}

TEST(PredictedZeros, FindTheSameThresholdsWithFewerPoints)
{
  const auto expect_fewer = [](const StabilityChart &predicted, const StabilityChart &plain) {
    ASSERT_EQ(plain.thresholds.size(), predicted.thresholds.size());
    EXPECT_GT(plain.thresholds.size(), 0u);
    for (std::size_t i = 0; i < plain.thresholds.size(); ++i)
      {
        const Threshold &a = plain.thresholds[i], &b = predicted.thresholds[i];
        EXPECT_NEAR(a.friction_coefficient, b.friction_coefficient, 1e-7);
        EXPECT_EQ(a.event, b.event);
        EXPECT_EQ(a.mechanism, b.mechanism);
        EXPECT_EQ(a.branch, b.branch);
      }
    EXPECT_LT(predicted.points.size(), plain.points.size());
  };
  const Predicted damped(40.), scene(0.);
  expect_fewer(scene.chart(true), scene.chart(false));
  expect_fewer(damped.chart(true), damped.chart(false));

  // Without a threshold, no zero is predicted
  const ChartPoint first = scene.accurate.evaluate(scene.at(0.)), second = scene.accurate.evaluate(scene.at(0.001));
  EXPECT_FALSE(scene.predicted_zero({ModeFunction::frequency, omega_max, {&first, {0}}, {&second, {0}}, {}}).has_value());
}
