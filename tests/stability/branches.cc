#include <squeal/base/exceptions.h>
#include <squeal/eigen/dense_quadratic.h>
#include <squeal/stability/branches.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

using namespace Squeal;

namespace
{
  using Complex = std::complex<double>;

  /// A family of small systems with M = 1.
  struct Family
  {
    std::function<DenseMatrix(double)> stiffness;
    std::function<DenseMatrix(double)> damping = nullptr;

    double                                                            last = std::numeric_limits<double>::infinity(); ///< of the list of modes
    std::function<ComplexDenseMatrix(const ChartPoint &)>             corrections = nullptr;
    std::function<void(ChartPoint &)>                                 disturb     = nullptr;
    int                                                               n_evaluations = 0;

    ChartPoint at(const double mu) const
    {
      const DenseMatrix K = stiffness(mu), C = damping ? damping(mu) : DenseMatrix();
      DenseQuadraticModes modes = dense_quadratic_modes(identity(K.n_rows()), damping ? &C : nullptr, K, last);
      ChartPoint          point;
      point.friction_coefficient = mu;
      point.lambda               = modes.values;
      point.right                = modes.right;
      point.left                 = modes.left;
      const int k                = modes.values.size();
      point.errors.assign(k, 0.);
      point.uncertainties.assign(k, 0.);
      point.verdicts.assign(k, Verdict::stable);
      point.real_values = modes.real_values;
      point.corrections = corrections ? corrections(point) : ComplexDenseMatrix(k, k);
      if (disturb)
        disturb(point);
      return point;
    }

    StabilityChart chart(const std::vector<double> &grid, const ChartOptions &options)
    {
      return stability_chart(
        grid,
        [this](const std::vector<double> &values) {
          std::vector<ChartPoint> points;
          for (const double mu : values)
            points.push_back(at(mu));
          n_evaluations += values.size();
          return points;
        },
        options);
    }
  };

  DenseMatrix matrix(const std::vector<std::vector<double>> &rows)
  {
    DenseMatrix A(rows.size(), rows.front().size());
    for (int i = 0; i < A.n_rows(); ++i)
      for (int j = 0; j < A.n_columns(); ++j)
        A(i, j) = rows[i][j];
    return A;
  }

  std::vector<double> uniform_grid(const double first, const double last, const int n_steps)
  {
    std::vector<double> grid;
    for (int i = 0; i <= n_steps; ++i)
      grid.push_back(first + (last - first) * i / n_steps);
    return grid;
  }

  ChartOptions precise(const double largest_frequency = 100., const double tolerance = 1e-12)
  {
    ChartOptions options;
    options.largest_frequency   = largest_frequency;
    options.threshold_tolerance = tolerance;
    return options;
  }

  /// λ of a branch at point k.
  Complex value(const StabilityChart &chart, const int branch, const int k)
  {
    return chart.points[k].lambda.at(chart.branches[branch].modes[k]);
  }

  /// |φᴴφ'| of a branch at two points.
  double overlap(const StabilityChart &chart, const int branch, const int k, const int l)
  {
    const ComplexDenseMatrix &X = chart.points[k].right, &Y = chart.points[l].right;
    Complex                   sum = 0.;
    for (int i = 0; i < X.n_rows(); ++i)
      sum += std::conj(X(i, chart.branches[branch].modes[k])) * Y(i, chart.branches[branch].modes[l]);
    return std::abs(sum);
  }

  void expect_counts(const StabilityChart &chart)
  {
    for (const ModeCount &count : chart.counts)
      EXPECT_EQ(count.n_modes, count.n_expected) << "at " << count.friction_coefficient;
  }

  void report(const std::string &name, const StabilityChart &chart)
  {
    int n_refined = 0;
    for (const bool refined : chart.is_refinement)
      n_refined += refined;
    std::cout << "    " << name << ": " << n_refined << " refinements of " << chart.points.size() << " points, " << chart.n_doubtful_steps
              << " doubtful\n";
    for (const Threshold &t : chart.thresholds)
      printf("        mu %.15g +- %.2g %s %s branch %d partner %d lambda %g%+gi\n", t.friction_coefficient, t.uncertainty, to_string(t.event).c_str(), to_string(t.mechanism).c_str(), t.branch,
             t.partner, t.lambda.real(), t.lambda.imag());
    for (const BandCrossing &c : chart.crossings)
      printf("        mu %.15g +- %.2g %s %s branch %d\n", c.friction_coefficient, c.uncertainty, c.enters ? "enters" : "leaves", to_string(c.edge).c_str(), c.branch);
  }

  /// N. Hoffmann et al. (2002): (k11 − k22)² + 4 k12 (k12 − μ k_c) = 0 at the coalescence.
  struct Flutter
  {
    double k11 = 3., k22 = 2., k12 = 0.7, k_c = 1.3, d1 = 0., d2 = 0.;

    double coalescence() const
    {
      return ((k11 - k22) * (k11 - k22) / (4. * k12) + k12) / k_c;
    }

    /// a1 (a3 a2 - a1) = a3² a0 (Hurwitz) of λ⁴ + a3 λ³ + a2 λ² + a1 λ + a0.
    double threshold() const
    {
      const double a3 = d1 + d2, a2 = k11 + k22 + d1 * d2, a1 = d1 * k22 + d2 * k11;
      const double a0 = a1 * (a3 * a2 - a1) / (a3 * a3);
      return (k12 - (k11 * k22 - a0) / k12) / k_c;
    }

    Family family() const
    {
      Family result;
      result.stiffness = [f = *this](const double mu) { return matrix({{f.k11, f.k12 - mu * f.k_c}, {f.k12, f.k22}}); };
      if (d1 != 0. || d2 != 0.)
        result.damping = [f = *this](double) { return matrix({{f.d1, 0.}, {0., f.d2}}); };
      return result;
    }
  };
} // namespace



TEST(Branches, CoalescenceInClosedForm)
{
  for (const double k22 : {2., 2.3, 2.7, 3.2, 4.})
    {
      Flutter flutter;
      flutter.k22 = k22;
      Family               family = flutter.family();
      const StabilityChart chart  = family.chart(uniform_grid(0., 2., 10), precise());
      report("flutter", chart);
      ASSERT_EQ(chart.thresholds.size(), 1u);
      const Threshold &threshold = chart.thresholds.front();
      EXPECT_NEAR(threshold.friction_coefficient, flutter.coalescence(), 1e-10);
      EXPECT_LT(threshold.uncertainty, 1e-10);
      EXPECT_EQ(threshold.event, ThresholdEvent::onset);
      EXPECT_EQ(threshold.mechanism, ThresholdMechanism::coalescence);
      EXPECT_LT(std::abs(threshold.lambda - Complex(0., std::sqrt(0.5 * (flutter.k11 + k22)))), 1e-6);
      // The lower branch goes on as the growing one
      EXPECT_LT(value(chart, threshold.branch, 0).imag(), value(chart, threshold.partner, 0).imag());
      EXPECT_GT(value(chart, threshold.branch, chart.points.size() - 1).real(), 0.);
      EXPECT_EQ(chart.n_doubtful_steps, 0);
      expect_counts(chart);
    }
}



TEST(Branches, RestabilisationInClosedForm)
{
  // δ(κ)² = (k11 − k22)² − 4 a b with a b = μ (p − μ): negative between two values of μ
  for (const double gap : {0.5, 1., 1.5})
    for (const double p : {2.5, 3., 4.})
      {
        Family family;
        family.stiffness = [=](const double mu) { return matrix({{10. + gap, mu}, {mu - p, 10.}}); };
        const double         root  = std::sqrt(p * p - gap * gap);
        const StabilityChart chart = family.chart(uniform_grid(-0.1, 4.1, 15), precise());
        report("window", chart);
        ASSERT_EQ(chart.thresholds.size(), 2u);
        EXPECT_NEAR(chart.thresholds[0].friction_coefficient, 0.5 * (p - root), 1e-10);
        EXPECT_NEAR(chart.thresholds[1].friction_coefficient, 0.5 * (p + root), 1e-10);
        EXPECT_EQ(chart.thresholds[0].event, ThresholdEvent::onset);
        EXPECT_EQ(chart.thresholds[1].event, ThresholdEvent::restabilisation);
        EXPECT_EQ(chart.thresholds[0].branch, chart.thresholds[1].branch);
        EXPECT_EQ(chart.branches.size(), 2u);
        EXPECT_EQ(chart.n_doubtful_steps, 0);
      }
}



TEST(Branches, DampedThresholdInClosedForm)
{
  for (const auto &[d1, d2] : {std::make_pair(0.02, 0.02), {0.04, 0.}, {0., 0.04}, {0.01, 0.03}, {0.001, 0.003}, {0.2, 0.1}, {1e-5, 1e-5}})
    {
      Flutter flutter;
      flutter.d1                  = d1;
      flutter.d2                  = d2;
      Family               family = flutter.family();
      const StabilityChart chart  = family.chart(uniform_grid(0., 2., 10), precise());
      report("damped " + std::to_string(d1) + " " + std::to_string(d2), chart);
      ASSERT_EQ(chart.thresholds.size(), 1u);
      EXPECT_NEAR(chart.thresholds[0].friction_coefficient, flutter.threshold(), 1e-10);
      EXPECT_EQ(chart.thresholds[0].mechanism, ThresholdMechanism::zero_growth);
      EXPECT_EQ(chart.thresholds[0].partner, -1);
      EXPECT_EQ(chart.n_doubtful_steps, 0);
      EXPECT_EQ(chart.branches.size(), 2u);
    }
}



TEST(Branches, CrossingsWithoutInteractionGoStraightThrough)
{
  Family family;
  family.stiffness = [](const double mu) { return matrix({{4. + mu, 0.2, 0.}, {0.2, 5. + mu, 0.}, {0., 0., 6. - mu}}); };
  // The last grid meets a crossing exactly: vectors are arbitrary there
  const double crossing = (6. - (4.5 - std::sqrt(0.29))) / 2.;
  for (const auto &grid : {uniform_grid(0., 2., 4), uniform_grid(0., 2., 37), std::vector<double>{0., crossing, 2.}})
    {
      const StabilityChart chart = family.chart(grid, precise());
      report("crossing", chart);
      EXPECT_TRUE(chart.thresholds.empty());
      EXPECT_EQ(chart.points.size(), grid.size());
      ASSERT_EQ(chart.branches.size(), 3u);
      const int last = chart.points.size() - 1;
      for (int branch = 0; branch < 3; ++branch)
        EXPECT_NEAR(overlap(chart, branch, 0, last), 1., 1e-10);
      EXPECT_EQ(chart.branches[2].modes[last], 0);
      EXPECT_EQ(chart.n_doubtful_steps, 0);
    }
}



TEST(Branches, VeeringsAreRefined)
{
  // Gaps of 1e-1 ... 1e-4: branches keep their order and exchange vectors
  for (const double coupling : {1e-1, 1e-2, 1e-3, 1e-4})
    {
      Family family;
      family.stiffness = [=](const double mu) { return matrix({{4. + mu, coupling}, {coupling, 6. - mu}}); };
      const StabilityChart chart = family.chart(uniform_grid(0., 2., 5), precise());
      report("veering", chart);
      EXPECT_TRUE(chart.thresholds.empty());
      ASSERT_EQ(chart.branches.size(), 2u);
      const int last = chart.points.size() - 1;
      EXPECT_LT(overlap(chart, 0, 0, last), 0.2);
      for (int k = 0; k <= last; ++k)
        EXPECT_LT(value(chart, 0, k).imag(), value(chart, 1, k).imag());
      EXPECT_EQ(chart.n_doubtful_steps, 0);
    }
}



TEST(Branches, NarrowWindowsOfInstabilityAreFound)
{
  // 4 − μ and 6 + μ... meet at μ = 1; coupling of opposite signs makes a window of width 4 c / 2
  for (const double coupling : {1e-1, 1e-3, 1e-5})
    {
      Family family;
      family.stiffness = [=](const double mu) { return matrix({{4. + mu, coupling}, {-coupling, 6. - mu}}); };
      const StabilityChart chart = family.chart(uniform_grid(0., 2., 7), precise());
      report("narrow window", chart);
      ASSERT_EQ(chart.thresholds.size(), 2u);
      EXPECT_NEAR(chart.thresholds[0].friction_coefficient, 1. - coupling, 1e-10);
      EXPECT_NEAR(chart.thresholds[1].friction_coefficient, 1. + coupling, 1e-10);
      EXPECT_EQ(chart.n_doubtful_steps, 0);
    }
}
