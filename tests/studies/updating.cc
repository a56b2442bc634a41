// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/studies/updating/least_squares.h>
#include <squeal/studies/updating/measured_modes.h>

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <cmath>

using namespace Squeal;

namespace
{
  /// r = A x − b
  Residuals linear_residuals(const DenseMatrix &A, const Eigen::VectorXd &b, const std::vector<double> &x)
  {
    return {A * as_column(x) - b, A};
  }

  const DenseMatrix     design_matrix = (DenseMatrix(3, 2) << 2., 0., 0., 4., 1., 1.).finished();
  const Eigen::VectorXd right_side    = (Eigen::VectorXd(3) << 1., 1., 1.).finished();

  MeasuredMode measured_mode(const MeasuredState state, const std::string &label, const std::string &member = "")
  {
    return {state, label, member, {1., 1.}, {}, "line 2"};
  }

  const std::vector<ComputedMode> computed_modes = {{MeasuredState::coupled, "F1", {0., 30.}, {{0., 1.}}},
                                                    {MeasuredState::coupled, "F1", {0., 10.}, {{0., 3.}}},
                                                    {MeasuredState::coupled, "A0-4 -", {0., 50.}, {{0., 5.}}},
                                                    {MeasuredState::coupled, "A0-4 +", {0., 70.}, {{0., 7.}}},
                                                    {MeasuredState::complex, "A0-4 -", {-3., 4.}, {{1., 2.}}}};
} // namespace

TEST(LeastSquares, FindsTheMinimumOfALinearProblem)
{
  const Fit fit =
    least_squares([](const std::vector<double> &x) { return linear_residuals(design_matrix, right_side, x); }, {0.9, 0.9}, 1e-10, 50);
  const Eigen::VectorXd expected = (design_matrix.transpose() * design_matrix).ldlt().solve(design_matrix.transpose() * right_side);
  EXPECT_TRUE(fit.has_converged) << fit.message;
  for (int i = 0; i < 2; ++i)
    EXPECT_NEAR(fit.x[i], expected[i], 1e-9);
}

TEST(LeastSquares, EndsAtALimitAndAvoidsPointsWithoutResiduals)
{
  // The minimum of (3 x − 6)² + (4 y − 2)² at x = 2 is beyond the limit; the first two evaluations at x > 0.95 fail
  int        n_refused = 0;
  const auto at        = [&](const std::vector<double> &x) -> std::optional<Residuals> {
    if (x[0] > 0.95 && n_refused++ < 2)
      return {};
    return Residuals{Eigen::Vector2d(3. * x[0] - 6., 4. * x[1] - 2.), DenseMatrix(Eigen::Vector2d(3., 4.).asDiagonal())};
  };
  const Fit fit = least_squares(at, {0.2, 0.}, 1e-10, 50);
  EXPECT_TRUE(fit.has_converged) << fit.message;
  EXPECT_NEAR(fit.x[0], 1., 1e-9);
  EXPECT_NEAR(fit.x[1], 0.5, 1e-7);
  const FitStatistics statistics = fit_statistics(fit.residuals, fit.x, false);
  EXPECT_EQ(statistics.is_at_limit, (std::vector<bool>{true, false}));
  EXPECT_FALSE(statistics.deviations[0]);
  ASSERT_TRUE(statistics.deviations[1]);
  EXPECT_NEAR(*statistics.deviations[1], 0.25, 1e-12);
}

TEST(FitStatistics, AreThoseOfTheNormalEquations)
{
  DenseMatrix J = DenseMatrix::Random(6, 3);
  J *= 10.;
  const Eigen::VectorXd r = Eigen::VectorXd::Random(6);
  for (const bool is_relative : {false, true})
    {
      const double        scale      = is_relative ? r.squaredNorm() / 3. : 1.;
      const DenseMatrix   covariance = scale * (J.transpose() * J).inverse();
      const FitStatistics statistics = fit_statistics({r, J}, {0.3, 0.5, 0.7}, is_relative);
      EXPECT_TRUE(statistics.undetermined.empty());
      for (int i = 0; i < 3; ++i)
        {
          EXPECT_NEAR(*statistics.deviations[i], std::sqrt(covariance(i, i)), 1e-10);
          for (int j = 0; j < 3; ++j)
            EXPECT_NEAR(statistics.correlations(i, j), covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j)), 1e-10);
        }
    }
}

TEST(FitStatistics, NamesWhatTheDataDoNotDetermine)
{
  // x0 and x2 are collinear, x3 has no effect, x1 is determined, and the deviation of x4 exceeds its range
  DenseMatrix J(6, 5);
  J.setZero();
  J.col(0) << 0., 10., 10., 10., 10., 10.;
  J.col(1) << 0., -20., 3., 40., -5., 6.;
  J.col(2)              = -2. * J.col(0);
  J(0, 4)               = 0.3;
  const auto statistics = fit_statistics({Eigen::VectorXd::Zero(6), J}, std::vector<double>(5, 0.5), false);
  EXPECT_EQ(statistics.undetermined, (std::vector<std::vector<std::size_t>>{{0, 2}, {3}, {4}}));
  EXPECT_TRUE(statistics.deviations[1]);
  for (const int i : {0, 2, 3, 4})
    EXPECT_FALSE(statistics.deviations[i]);
  // Fewer data than parameters
  const FitStatistics few = fit_statistics({Eigen::VectorXd::Zero(1), J.topRows(1)}, std::vector<double>(5, 0.5), true);
  EXPECT_FALSE(few.undetermined.empty());
}

TEST(MeasuredModes, HaveTheirCounterparts)
{
  const Counterpart mean = counterpart_of(measured_mode(MeasuredState::coupled, "F1"), {}, computed_modes);
  EXPECT_NEAR(mean.frequency, 20. / (2. * M_PI), 1e-12);
  EXPECT_NEAR(mean.frequency_rates.front(), 2. / (2. * M_PI), 1e-12);
  EXPECT_NEAR(counterpart_of(measured_mode(MeasuredState::coupled, "F1", "lowest"), {}, computed_modes).frequency, 10. / (2. * M_PI),
              1e-12);
  EXPECT_NEAR(counterpart_of(measured_mode(MeasuredState::coupled, "F1", "highest"), {}, computed_modes).frequency, 30. / (2. * M_PI),
              1e-12);
  EXPECT_NEAR(counterpart_of(measured_mode(MeasuredState::coupled, "F1", "2"), {}, computed_modes).frequency, 30. / (2. * M_PI), 1e-12);
  EXPECT_NEAR(counterpart_of(measured_mode(MeasuredState::coupled, "A0-4"), {}, computed_modes).frequency, 60. / (2. * M_PI), 1e-12);
  EXPECT_NEAR(counterpart_of(measured_mode(MeasuredState::coupled, "A0-4 +"), {}, computed_modes).frequency, 70. / (2. * M_PI), 1e-12);

  // Derivative of ζ = 3/5 for λ = −3 + 4i and λ' = 1 + 2i: −(16 · 1 + 3 · 4 · 2)/125
  const Counterpart damped = counterpart_of(measured_mode(MeasuredState::complex, "A0-4 -"), {}, computed_modes);
  EXPECT_NEAR(damped.damping_ratio, 0.6, 1e-12);
  const auto ratio = [](const double t) {
    const std::complex<double> lambda(-3. + t, 4. + 2. * t);
    return -lambda.real() / std::abs(lambda);
  };
  EXPECT_NEAR(damped.damping_ratio_rates.front(), (ratio(1e-5) - ratio(-1e-5)) / 2e-5, 1e-9);

  EXPECT_THROW(counterpart_of(measured_mode(MeasuredState::coupled, "F1", "3"), {}, computed_modes), SolverError);
  EXPECT_THROW(counterpart_of(measured_mode(MeasuredState::component, "F1"), {}, computed_modes), SolverError);
}
