#include "solutions.h"

#include <squeal/tracking/branches.h>
#include <squeal/tracking/error_controlled_sweep.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /// A model that is accurate everywhere, with contact damping c_b [N s/m] in proportion to the friction coefficient.
  struct Predicted
  {
    explicit Predicted(const double c_b)
      : s(mesh_of(symmetric_pins), mounted(), operating())
      , c_b(c_b)
      , system(with_values(s.coupled, at(0.8).values))
      , inverse(s.coupled, 0., FactorizationLibrary::automatic)
      , real(real_modes(s.coupled))
      , model(system, inverse, 0., *real.vectors, omega_max, 0.05)
    {
      std::vector<OperatingPoint> points;
      for (const double mu : grid())
        points.push_back(at(mu));
      Progress   progress;
      const auto sweep =
        error_controlled_sweep(model, points, {0, static_cast<int>(points.size()) - 1}, {}, nullptr, MPI_COMM_WORLD, progress);
      EXPECT_TRUE(sweep.why_stopped.empty());
    }

    OperatingPoint at(const double mu) const
    {
      OperatingPoint point{mu, {}, 0};
      if (c_b != 0.)
        point.values[SystemParameter::radial_damping].assign(s.interface.size(), c_b * mu);
      return point;
    }

    static std::vector<double> grid()
    {
      std::vector<double> result;
      for (int i = 0; i <= 16; ++i)
        result.push_back(0.05 * i);
      return result;
    }

    /// The chart, with or without predictions; @p n_refinements receives how many points it took.
    StabilityChart chart(const bool predicts, int &n_refinements) const
    {
      n_refinements       = -static_cast<int>(grid().size());
      const auto evaluate = [&](const std::vector<double> &friction_coefficients) {
        std::vector<OperatingPoint> points;
        for (const double mu : friction_coefficients)
          points.push_back(at(mu));
        n_refinements += static_cast<int>(points.size());
        return Squeal::evaluate(model, points, MPI_COMM_WORLD);
      };
      const auto predict = [&](const ZeroSearch &search) {
        return model.predicted_zero(search, at(search.first.point->friction_coefficient), at(search.second.point->friction_coefficient));
      };
      ChartOptions options;
      options.largest_circular_frequency = omega_max;
      options.threshold_tolerance        = 1e-7;
      return stability_chart(grid(), evaluate, options, predicts ? PredictZero(predict) : PredictZero());
    }

    Scene          s;
    double         c_b;
    CoupledSystem  system;
    UpdatedInverse inverse;
    SymmetricModes real;
    ChartModel     model;
  };
} // namespace

TEST(PredictedZeros, FindTheSameThresholdsWithFewerPoints)
{
  for (const double c_b : {0., 40.})
    {
      const Predicted scene(c_b);
      int             n_plain = 0, n_predicted = 0;
      const auto      plain = scene.chart(false, n_plain), predicted = scene.chart(true, n_predicted);
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
      EXPECT_LT(n_predicted, n_plain);
    }
}

// The span of the modes at both ends knows λ there and its slope: what is left is of fourth order in the step
TEST(PredictedZeros, ConvergeWithTheStep)
{
  const Predicted scene(0.);
  int             n     = 0;
  const auto      chart = scene.chart(false, n);
  const auto      onset = std::find_if(chart.thresholds.begin(), chart.thresholds.end(), [](const Threshold &t) {
    return t.mechanism == ThresholdMechanism::coalescence && t.friction_coefficient > 0.1;
  });
  ASSERT_NE(onset, chart.thresholds.end());
  std::vector<double> errors;
  for (const double step : {0.08, 0.04})
    {
      // Not in the middle, where errors would cancel
      const double     a = onset->friction_coefficient - 0.4 * step, b = a + step;
      const ChartPoint first = scene.model.evaluate(scene.at(a)), second = scene.model.evaluate(scene.at(b));
      const auto       pair = [&](const ChartPoint &point) {
        std::vector<int> order(point.lambda.size());
        std::iota(order.begin(), order.end(), 0);
        std::sort(order.begin(), order.end(), [&](const int i, const int j) {
          return std::abs(point.lambda[i] - onset->lambda) < std::abs(point.lambda[j] - onset->lambda);
        });
        return std::vector<int>{order[0], order[1]};
      };
      ZeroSearch search{ModeFunction::discriminant, 0., {&first, pair(first)}, {&second, pair(second)}, {}};
      const auto zero = scene.model.predicted_zero(search, scene.at(a), scene.at(b));
      ASSERT_TRUE(zero.has_value());
      errors.push_back(std::abs(*zero - onset->friction_coefficient));

      // The modes at the next points bring it closer
      const ChartPoint before = scene.model.evaluate(scene.at(a - step)), behind = scene.model.evaluate(scene.at(b + step));
      search.beyond    = {{&before, pair(before)}, {&behind, pair(behind)}};
      const auto again = scene.model.predicted_zero(search, scene.at(a), scene.at(b));
      ASSERT_TRUE(again.has_value());
      EXPECT_LT(std::abs(*again - onset->friction_coefficient), 0.2 * errors.back() + 1e-7);
    }
  EXPECT_LT(errors[0], 1e-4);
  EXPECT_LT(errors[1], errors[0] / 6. + 1e-7);

  // No sign changes where there is no threshold
  const ChartPoint first = scene.model.evaluate(scene.at(0.)), second = scene.model.evaluate(scene.at(0.001));
  EXPECT_FALSE(
    scene.model.predicted_zero({ModeFunction::frequency, omega_max, {&first, {0}}, {&second, {0}}, {}}, scene.at(0.), scene.at(0.001))
      .has_value());
}
