#include "solutions.h"

#include <squeal/base/tasks.h>
#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/tracking/error_controlled_sweep.h>

#include <map>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /// A scene with all that a sweep needs.
  struct Chart
  {
    explicit Chart(const double c_b, const double c_t = 0.)
      : s(mesh_of(skewed_pins), mounted(), operating())
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
      return ChartModel(system, inverse, 0., *real.vectors, omega_max, 0.05);
    }

    /// Damping in proportion to the friction coefficient.
    OperatingPoint at(const double friction, const int line = 0) const
    {
      OperatingPoint point{friction, damping.values(), line};
      for (auto &[parameter, coefficients] : point.values)
        for (double &c : coefficients)
          c *= friction / 0.8;
      return point;
    }

    std::vector<OperatingPoint> points() const
    {
      std::vector<OperatingPoint> result;
      for (int i = 0; i <= 8; ++i)
        result.push_back(at(0.1 * i));
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

  /// Keeps everything in memory; may give up after some results, as if the run were killed.
  struct MemoryStore : ChartStore
  {
    struct Killed
    {};

    std::optional<ChartPoint> find(const OperatingPoint &point) const override
    {
      const auto found = results.find({point.line, point.friction_coefficient});
      return found == results.end() ? std::optional<ChartPoint>() : found->second;
    }
    void keep(const OperatingPoint &point, const ChartPoint &result) override
    {
      if (n_left-- == 0)
        throw Killed();
      EXPECT_TRUE(results.emplace(std::make_pair(point.line, point.friction_coefficient), result).second) << "computed twice";
    }
    std::vector<MultiVector> basis() const override
    {
      return blocks;
    }
    void keep(const MultiVector &block) override
    {
      blocks.push_back(block);
    }

    std::map<std::pair<int, double>, ChartPoint> results;
    std::vector<MultiVector>                     blocks;
    int                                          n_left = 1000000;
  };

  ErrorControlledSweep sweep(ChartModel                        &model,
                             const std::vector<OperatingPoint> &points,
                             const ErrorControlledSweepOptions &options,
                             ChartStore                        *store = nullptr)
  {
    Progress progress;
    return error_controlled_sweep(model, points, {static_cast<int>(points.size()) - 1, 0}, options, store, MPI_COMM_WORLD, progress);
  }
} // namespace

TEST(ErrorControlledSweep, AgreesWithFullOrder)
{
  for (const auto &[c_b, c_t] : {std::make_pair(0., 0.), {40., 0.}, {40., -10.}})
    {
      const Chart                         chart(c_b, c_t);
      const auto                          points = chart.points();
      std::map<int, std::vector<Complex>> full;
      for (const int i : {0, 2, 4, 6, 8})
        full[i] = krylov(with_values(chart.system, points[i].values), points[i].friction_coefficient, 1e-11).lambda;
      for (const double tolerance : {1e-6, 1e-8})
        {
          ErrorControlledSweepOptions options;
          options.tolerance = tolerance;
          ChartModel model  = chart.model();
          const auto result = sweep(model, points, options);
          EXPECT_TRUE(result.why_stopped.empty());
          EXPECT_LE(result.worst_error, tolerance);
          EXPECT_LT(orthonormality_defect(*chart.system.mass, model.reduced().basis()), 1e-12);
          for (const auto &[i, lambda] : full)
            {
              ASSERT_TRUE(result.points[i].has_value());
              EXPECT_LT(largest(distances(chart.in_band(*result.points[i]), lambda)), 2. * tolerance)
                << "c_b " << c_b << ", mu " << points[i].friction_coefficient;
            }
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
    std::vector<int> order;
    auto             result = evaluate(model, points, MPI_COMM_WORLD, [&](const int i, const ChartPoint &) { order.push_back(i); });
    set_task_threads(1);
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
    EXPECT_EQ(order.size(), points.size());
    return result;
  };
  const std::vector<ChartPoint> one = by(1);
  for (const unsigned int n : {2, 4, 16})
    {
      const std::vector<ChartPoint> several = by(n);
      ASSERT_EQ(several.size(), one.size());
      for (std::size_t i = 0; i < one.size(); ++i)
        {
          ASSERT_GT(one[i].lambda.size(), 0u);
          ASSERT_EQ(several[i].lambda.size(), one[i].lambda.size());
          EXPECT_EQ(several[i].friction_coefficient, points[i].friction_coefficient);
          for (std::size_t j = 0; j < one[i].lambda.size(); ++j)
            {
              EXPECT_LT(std::abs(several[i].lambda[j] - one[i].lambda[j]), 1e-12 * std::abs(one[i].lambda[j]));
              EXPECT_NEAR(several[i].errors[j], one[i].errors[j], 1e-12 + 1e-9 * one[i].errors[j]);
              EXPECT_EQ(several[i].verdicts[j], one[i].verdicts[j]);
            }
        }
    }
}

TEST(ErrorControlledSweep, GoesOnAsIfNotInterrupted)
{
  const Chart                 chart(40.);
  const auto                  points = chart.points();
  ErrorControlledSweepOptions options;
  MemoryStore                 whole;
  ChartModel                  model  = chart.model();
  const auto                  result = sweep(model, points, options, &whole);
  for (const int n_before : {0, 1, 4, 8})
    {
      MemoryStore store;
      store.n_left      = n_before;
      ChartModel killed = chart.model();
      EXPECT_THROW(sweep(killed, points, options, &store), MemoryStore::Killed);
      EXPECT_EQ(store.results.size(), static_cast<std::size_t>(n_before));
      store.n_left       = 1000000;
      ChartModel resumed = chart.model();
      const auto again   = sweep(resumed, points, options, &store); // the store refuses a second result of a point
      EXPECT_EQ(resumed.size(), model.size());
      for (std::size_t i = 0; i < points.size(); ++i)
        {
          ASSERT_TRUE(again.points[i] && result.points[i]);
          // The same to the last bit, but where sums over processes differ in rounding from run to run
          if (chart.s.model.free_map().n_processes() == 1)
            {
              EXPECT_EQ(again.points[i]->lambda, result.points[i]->lambda) << "point " << i;
              EXPECT_EQ(again.points[i]->errors, result.points[i]->errors) << "point " << i;
            }
          else
            EXPECT_LT(largest(distances(again.points[i]->lambda, result.points[i]->lambda)), 1e-11) << "point " << i;
        }
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
  ASSERT_TRUE(result.points.front().has_value()); // real modes without friction
  EXPECT_FALSE(result.points.back().has_value());
  EXPECT_LE(result.worst_error, options.tolerance);
  EXPECT_THROW(sweep(model, {}, options), std::exception);
}

// Errors that rounding makes up do not fall, however large the basis gets
TEST(ErrorControlledSweep, StopsWhereRoundingMakesUpTheError)
{
  const Chart                       chart(0.);
  const std::vector<OperatingPoint> points = {chart.at(0.8)};
  ErrorControlledSweepOptions       options;
  options.tolerance     = 1e-16;
  options.maximum_basis = static_cast<int>(chart.s.coupled.map().n());
  ChartModel model      = chart.model();
  const auto result     = sweep(model, points, options);
  // Larger bases do not halve the error, or the residuals leave no direction: not until the basis takes all of the space
  EXPECT_NE(result.why_stopped.find("rounding"), std::string::npos) << result.why_stopped;
  EXPECT_LT(model.size(), options.maximum_basis);
}
