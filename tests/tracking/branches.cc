// SPDX-License-Identifier: GPL-3.0-or-later

#include "flutter.h"

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/eigen/dense_quadratic.h>
#include <squeal/linear_algebra/orthonormal_basis.h>
#include <squeal/tracking/branches.h>
#include <squeal/tracking/mode_links.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

using namespace Squeal;

namespace
{
  using Complex = std::complex<double>;

  constexpr ThresholdMechanism coalescence = ThresholdMechanism::coalescence, zero_growth = ThresholdMechanism::zero_growth;

  /// A family of small systems whose mass matrix is the identity.
  struct Family
  {
    std::function<DenseMatrix(double)> stiffness;
    std::function<DenseMatrix(double)> damping = nullptr;

    double                                                last        = std::numeric_limits<double>::infinity(); ///< largest listed |ω|
    std::function<ComplexDenseMatrix(const ChartPoint &)> corrections = nullptr;
    std::function<void(ChartPoint &)>                     disturb     = nullptr;

    ChartPoint at(const double mu) const
    {
      const DenseMatrix   K = stiffness(mu), C = damping ? damping(mu) : DenseMatrix();
      DenseQuadraticModes modes = dense_quadratic_modes(DenseMatrix::Identity(K.rows(), K.rows()), damping ? &C : nullptr, K, last);
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
      point.corrections = corrections ? corrections(point) : ComplexDenseMatrix::Zero(k, k);
      if (disturb)
        disturb(point);
      return point;
    }

    std::vector<ChartPoint> operator()(const std::vector<double> &friction_coefficients) const
    {
      std::vector<ChartPoint> points;
      for (const double mu : friction_coefficients)
        points.push_back(at(mu));
      return points;
    }

    StabilityChart chart(const std::vector<double> &grid, const ChartOptions &options) const
    {
      return stability_chart(grid, *this, options);
    }
  };

  DenseMatrix diagonal(const std::vector<double> &values)
  {
    return as_column(values).asDiagonal();
  }

  DenseMatrix random(std::mt19937 &generator, const int n_rows, const int n_columns)
  {
    std::normal_distribution<double> normal;
    return DenseMatrix::NullaryExpr(n_rows, n_columns, [&](int, int) { return normal(generator); });
  }

  std::vector<double> uniform_grid(const double first, const double last, const int n_steps)
  {
    std::vector<double> grid;
    for (int i = 0; i <= n_steps; ++i)
      grid.push_back(first + (last - first) * i / n_steps);
    return grid;
  }

  ChartOptions precise(const double largest_circular_frequency = 100., const double tolerance = 1e-12)
  {
    return {largest_circular_frequency, tolerance};
  }

  /// λ of a branch at point k.
  Complex value(const StabilityChart &chart, const int branch, const int k)
  {
    return chart.points[k].lambda.at(chart.branches[branch].modes[k]);
  }

  /// |φᴴφ'| of a branch between the first and the last point.
  double overlap(const StabilityChart &chart, const int branch)
  {
    const std::vector<int> &modes = chart.branches[branch].modes;
    return std::abs(chart.points.front().right.col(modes.front()).dot(chart.points.back().right.col(modes.back())));
  }

  void expect_counts(const StabilityChart &chart)
  {
    EXPECT_EQ(chart.n_doubtful_steps, 0);
    EXPECT_FALSE(chart.counts.empty());
    for (const ChartCount &count : chart.counts)
      EXPECT_EQ(count.n_modes, count.n_expected) << "at " << count.friction_coefficient;
  }

  /// Chart of a family with the expected thresholds: onset and restabilisation of a window, or onsets of different branches.
  StabilityChart expect_thresholds(Family                     family,
                                   const std::vector<double> &grid,
                                   const ThresholdMechanism   mechanism,
                                   const std::vector<double> &friction_coefficients,
                                   const bool                 is_window = false)
  {
    const StabilityChart          chart = family.chart(grid, precise());
    const std::vector<Threshold> &found = chart.thresholds;
    EXPECT_EQ(found.size(), friction_coefficients.size());
    for (std::size_t t = 0; t < std::min(found.size(), friction_coefficients.size()); ++t)
      {
        EXPECT_NEAR(found[t].friction_coefficient, friction_coefficients[t], 1e-10);
        EXPECT_LT(found[t].uncertainty, 1e-10);
        EXPECT_EQ(found[t].mechanism, mechanism);
        EXPECT_EQ(found[t].partner >= 0, mechanism == ThresholdMechanism::coalescence);
        EXPECT_EQ(found[t].event, is_window && t == 1 ? ThresholdEvent::restabilisation : ThresholdEvent::onset);
        EXPECT_EQ(found[t].branch == found[0].branch, is_window || t == 0);
      }
    EXPECT_EQ(chart.branches.size(), chart.points.front().lambda.size());
    expect_counts(chart);
    return chart;
  }

  /// Expects that two charts of a family agree in thresholds, crossings and at the grid points of the first chart.
  void expect_same(const StabilityChart &coarse, const StabilityChart &fine, const double tolerance)
  {
    ASSERT_EQ(coarse.thresholds.size(), fine.thresholds.size());
    for (std::size_t t = 0; t < fine.thresholds.size(); ++t)
      {
        EXPECT_NEAR(coarse.thresholds[t].friction_coefficient, fine.thresholds[t].friction_coefficient, tolerance);
        EXPECT_EQ(coarse.thresholds[t].event, fine.thresholds[t].event);
        EXPECT_EQ(coarse.thresholds[t].mechanism, fine.thresholds[t].mechanism);
        EXPECT_LT(std::abs(coarse.thresholds[t].lambda - fine.thresholds[t].lambda), 1e-5);
      }
    ASSERT_EQ(coarse.crossings.size(), fine.crossings.size());
    for (std::size_t c = 0; c < fine.crossings.size(); ++c)
      {
        const BandCrossing &one = coarse.crossings[c], &other = fine.crossings[c];
        EXPECT_NEAR(one.friction_coefficient, other.friction_coefficient, tolerance);
        EXPECT_EQ(one.branch, other.branch);
        EXPECT_EQ(one.enters, other.enters);
      }

    // Compare branches as sets of curves, because modes of a multiple λ have an arbitrary order at the first point
    const auto curves = [&coarse](const StabilityChart &chart) {
      std::vector<Eigen::VectorXcd> result;
      for (std::size_t b = 0; b < chart.branches.size(); ++b)
        if (chart.branches[b].modes[0] >= 0)
          {
            result.push_back(Eigen::VectorXcd::Zero(coarse.points.size()));
            for (std::size_t k = 0, l = 0; k < coarse.points.size(); ++k)
              if (!coarse.is_refinement[k])
                {
                  while (chart.points[l].friction_coefficient < coarse.points[k].friction_coefficient - 1e-12)
                    ++l;
                  if (chart.branches[b].modes[l] >= 0)
                    result.back()[k] = value(chart, b, l);
                }
          }
      return result;
    };
    const auto first = curves(coarse), second = curves(fine);
    ASSERT_EQ(first.size(), second.size());
    for (const auto &curve : first)
      EXPECT_TRUE(std::any_of(second.begin(), second.end(), [&](const auto &other) { return max_norm(other - curve) < 1e-6; }));
  }

  /// Flutter of flutter.h with unequal damping d1, d2 of the two degrees of freedom.
  struct DampedFlutter : Testing::Flutter
  {
    double d1 = 0., d2 = 0.;

    /// Friction coefficient with a1 (a3 a2 - a1) = a3² a0, from the Hurwitz criterion of λ⁴ + a3 λ³ + a2 λ² + a1 λ + a0.
    double threshold() const
    {
      const double a3 = d1 + d2, a2 = k11 + k22 + d1 * d2, a1 = d1 * k22 + d2 * k11;
      const double a0 = a1 * (a3 * a2 - a1) / (a3 * a3);
      return (k12 - (k11 * k22 - a0) / k12) / k_c;
    }

    Family family() const
    {
      Family result{[f = *this](const double mu) { return f.stiffness(mu); }};
      if (d1 != 0. || d2 != 0.)
        result.damping = [f = *this](double) { return diagonal({f.d1, f.d2}); };
      return result;
    }
  };

  /// Modes that do not interact, each given by its λ(μ); listed values have a known error [rad/s].
  Family given_modes(const std::vector<std::function<Complex(double)>> &lambda, const Complex error = 0.)
  {
    const auto entries = [lambda](const double mu, double (*const entry)(const Complex &)) {
      std::vector<double> result;
      for (const auto &mode : lambda)
        result.push_back(entry(mode(mu)));
      return diagonal(result);
    };
    Family result;
    result.stiffness = [=](const double mu) { return entries(mu, [](const Complex &l) { return std::norm(l); }); };
    result.damping   = [=](const double mu) { return entries(mu, [](const Complex &l) { return -2. * l.real(); }); };
    result.disturb   = [error](ChartPoint &point) {
      for (std::size_t j = 0; j < point.lambda.size(); ++j)
        {
          point.lambda[j] += error;
          point.uncertainties[j] = std::abs(error);
          point.errors[j]        = std::abs(error) / std::abs(point.lambda[j]);
          point.verdicts[j]      = verdict_of(point.lambda[j], std::abs(error));
        }
    };
    return result;
  }

  /// λ(μ) with a constant frequency and ξ = slope (μ − begin).
  std::function<Complex(double)> growing(const double omega, const double slope, const double begin)
  {
    return [=](const double mu) { return Complex(omega * slope * (mu - begin), omega); };
  }

  /// Onsets of growth and of divergence rates above weak_divergence, in the band up to 10 rad/s.
  std::vector<std::optional<GrowthOnset>> onsets(const Family &modes, const StabilityChart &chart, const double before = 0.)
  {
    const std::vector<std::optional<GrowthOnset>> result = {first_onset(chart, 10., before),
                                                            onset_beyond(weak_divergence, chart, modes, precise(10., 1e-10), before)};
    // The overall onset is the earliest onset of all branches
    std::vector<std::optional<GrowthOnset>> of_branches(2);
    for (int b = 0; b < static_cast<int>(chart.branches.size()); ++b)
      {
        const std::optional<GrowthOnset> found[] = {onset_of(b, chart, 10., before),
                                                    onset_beyond(weak_divergence, chart, modes, precise(10., 1e-10), before, b)};
        for (const int i : {0, 1})
          if (found[i] && (!of_branches[i] || found[i]->friction_coefficient < of_branches[i]->friction_coefficient))
            of_branches[i] = found[i];
      }
    for (const int i : {0, 1})
      {
        EXPECT_EQ(of_branches[i].has_value(), result[i].has_value());
        if (of_branches[i] && result[i])
          {
            EXPECT_NEAR(of_branches[i]->friction_coefficient, result[i]->friction_coefficient, 1e-9);
          }
      }
    return result;
  }
} // namespace

TEST(Branches, ThresholdsInClosedForm)
{
  for (const double k22 : {2., 2.3, 2.7, 3.2, 4.})
    {
      DampedFlutter flutter;
      flutter.k22      = k22;
      const auto chart = expect_thresholds(flutter.family(), uniform_grid(0., 2., 10), coalescence, {flutter.coalescence()});
      ASSERT_EQ(chart.thresholds.size(), 1u);
      const Threshold &threshold = chart.thresholds.front();
      EXPECT_LT(std::abs(threshold.lambda - Complex(0., std::sqrt(0.5 * (flutter.k11 + k22)))), 1e-6);
      // The lower branch grows
      EXPECT_LT(value(chart, threshold.branch, 0).imag(), value(chart, threshold.partner, 0).imag());
      EXPECT_GT(value(chart, threshold.branch, chart.points.size() - 1).real(), 0.);
    }
  for (const auto &[d1, d2] : {std::make_pair(0.02, 0.02), {0.04, 0.}, {0., 0.04}, {0.01, 0.03}, {0.001, 0.003}, {0.2, 0.1}, {1e-5, 1e-5}})
    {
      const DampedFlutter flutter{{}, d1, d2};
      expect_thresholds(flutter.family(), uniform_grid(0., 2., 10), zero_growth, {flutter.threshold()});
    }
}

TEST(Branches, WindowsOfInstabilityAreFound)
{
  // 4 + μ and 6 − μ are equal at μ = 1; with coupling c and −c, modes grow while |μ − 1| < c
  for (const double c : {1e-1, 1e-3, 1e-5})
    {
      const auto K = [c](const double mu) { return DenseMatrix{{4. + mu, c}, {-c, 6. - mu}}; };
      expect_thresholds({K}, uniform_grid(0., 2., 7), coalescence, {1. - c, 1. + c}, true);
    }
  // A window that the coarse grid misses: κ = 5 ± i s, s² = (μ − 0.43) (0.57 − μ), unstable for s² > 5 d²
  for (const int n_steps : {5, 20})
    for (const double d : {0., 0.001, 0.01})
      {
        Family family{[](const double mu) { return DenseMatrix{{5., 1.}, {(mu - 0.43) * (mu - 0.57), 5.}}; }};
        if (d > 0.)
          family.damping = [d](double) { return diagonal({d, d}); };
        const double half = std::sqrt(0.07 * 0.07 - 5. * d * d);
        expect_thresholds(family, uniform_grid(0., 1., n_steps), d > 0. ? zero_growth : coalescence, {0.5 - half, 0.5 + half}, true);
      }
}

TEST(Branches, GrowthAtOnce)
{
  // κ = 5 ± iμ grows from μ = 0; a second pair, split by 0.1, grows later
  const auto pairs = [](const double mu) { return DenseMatrix{{5., mu, 0., 0.}, {-mu, 5., 0., 0.}, {0., 0., 7., mu}, {0., 0., -mu, 7.1}}; };
  const auto chart = expect_thresholds({pairs}, uniform_grid(0., 1., 10), coalescence, {0., 0.05});
  EXPECT_EQ(chart.thresholds.at(0).friction_coefficient, 0.);
  // C = μ diag(0.2 − μ, −1, 1) / 100: one mode grows above 0.2, one from μ = 0, and one decays
  const auto K = [](double) { return diagonal({1., 2., 3.}); };
  const auto C = [](const double mu) { return diagonal({-0.01 * mu * (mu - 0.2), -0.01 * mu, 0.01 * mu}); };
  for (const int n_steps : {3, 10})
    {
      const auto damped = expect_thresholds({K, C}, uniform_grid(0., 1., n_steps), zero_growth, {0., 0.2});
      EXPECT_EQ(damped.thresholds.at(0).friction_coefficient, 0.);
      EXPECT_EQ(damped.thresholds.at(0).branch, 1);
      EXPECT_EQ(damped.thresholds.at(1).branch, 0);
    }
}

TEST(Branches, CrossingsWithoutInteractionGoStraightThrough)
{
  Family family{[](const double mu) { return DenseMatrix{{4. + mu, 0.2, 0.}, {0.2, 5. + mu, 0.}, {0., 0., 6. - mu}}; }};
  // The last grid contains a crossing, where vectors are arbitrary
  const double crossing = (6. - (4.5 - std::sqrt(0.29))) / 2.;
  for (const auto &grid : {uniform_grid(0., 2., 4), uniform_grid(0., 2., 37), std::vector<double>{0., crossing, 2.}})
    {
      const StabilityChart chart = expect_thresholds(family, grid, coalescence, {});
      EXPECT_EQ(chart.points.size(), grid.size()); // the chart is not refined
      for (int branch = 0; branch < 3; ++branch)
        EXPECT_NEAR(overlap(chart, branch), 1., 1e-10);
      EXPECT_EQ(chart.branches.at(2).modes.back(), 0);
    }
}

TEST(Branches, VeeringsAreRefined)
{
  // Branches remain ordered and exchange vectors while |μ − 1| is of the order of the coupling
  for (const double coupling : {1e-1, 1e-4})
    {
      const auto K     = [=](const double mu) { return DenseMatrix{{4. + mu, coupling}, {coupling, 6. - mu}}; };
      const auto chart = expect_thresholds({K}, uniform_grid(0., 2., 5), coalescence, {});
      EXPECT_LT(overlap(chart, 0), 0.2);
      for (std::size_t k = 0; k < chart.points.size(); ++k)
        EXPECT_LT(value(chart, 0, k).imag(), value(chart, 1, k).imag());
    }
}

TEST(Branches, MultipleModesAreFollowedAcrossOthers)
{
  // A twelvefold λ² = −5 with randomly mixed vectors at each point. Two modes cross it; the second also veers with a third mode.
  std::mt19937 generator(7);
  Family       family{[](const double mu) {
    DenseMatrix K             = 5. * DenseMatrix::Identity(15, 15);
    K.bottomRightCorner(3, 3) = DenseMatrix{{4. + 2. * mu, 0., 0.}, {0., 6. - 2. * mu, 0.1}, {0., 0.1, 5.4}};
    return K;
  }};
  family.disturb = [&](ChartPoint &point) {
    std::vector<int> multiple;
    for (std::size_t j = 0; j < point.lambda.size(); ++j)
      if (std::abs(point.lambda[j] - Complex(0., std::sqrt(5.))) < 1e-9)
        multiple.push_back(j);
    const int n = multiple.size();
    for (auto *vectors : {&point.right, &point.left})
      (*vectors)(Eigen::placeholders::all, multiple) =
        (*vectors)(Eigen::placeholders::all, multiple) * orthonormal_columns(random(generator, n, n));
  };
  // One of the grids contains the crossing of the twelve modes with a thirteenth
  for (const int n_steps : {3, 10, 33})
    {
      const StabilityChart chart = expect_thresholds(family, uniform_grid(0., 1., n_steps), coalescence, {});
      for (std::size_t k = 0; k < chart.points.size(); ++k)
        {
          int n_multiple = 0, n_rising = 0;
          for (int branch = 0; branch < 15; ++branch)
            {
              const double first = value(chart, branch, 0).imag(), omega = value(chart, branch, k).imag();
              n_multiple += std::abs(first - std::sqrt(5.)) < 1e-9 && std::abs(omega - std::sqrt(5.)) < 1e-9;
              n_rising += std::abs(first - 2.) < 1e-9 && std::abs(omega - std::sqrt(4. + 2. * chart.points[k].friction_coefficient)) < 1e-9;
            }
          EXPECT_EQ(n_multiple, 12);
          EXPECT_EQ(n_rising, 1);
        }
    }
}

TEST(Branches, BandCrossingsInClosedForm)
{
  // ω = √(8 + 2μ) leaves the band ω < 3, and √(10.2 − 2μ) enters it. A fourth mode is listed only near μ = 0.5, below ω = 3.15.
  Family family{[](const double mu) { return diagonal({8. + 2. * mu, 10.2 - 2. * mu, 4., 9.9 + 4. * (mu - 0.5) * (mu - 0.5)}); }};
  family.last = 3.15;
  // The first mode is overdamped for 0.7 < μ < 1.3, where c = 2.09 − (μ − 1)² > 2 √k = 2
  Family overdamped{[](double) { return diagonal({1., 9.}); }};
  overdamped.damping = [](const double mu) { return diagonal({2.09 - (mu - 1.) * (mu - 1.), 0.1}); };
  for (const bool real : {false, true})
    {
      const StabilityChart chart =
        real ? overdamped.chart(uniform_grid(0., 2., 10), precise()) : family.chart(uniform_grid(0., 1., 10), precise(3.));
      ASSERT_EQ(chart.crossings.size(), 2u);
      EXPECT_NEAR(chart.crossings[0].friction_coefficient, real ? 0.7 : 0.5, 1e-10);
      EXPECT_NEAR(chart.crossings[1].friction_coefficient, real ? 1.3 : 0.6, 1e-10);
      for (const int k : {0, 1})
        {
          EXPECT_EQ(chart.crossings[k].enters, k == 1);
          EXPECT_EQ(chart.crossings[k].edge, real ? BandEdge::real_axis : BandEdge::end_of_band);
        }
      EXPECT_EQ(chart.counts.front().n_modes, 2);
      EXPECT_TRUE(chart.thresholds.empty());
      expect_counts(chart);
    }
}

TEST(Branches, UncertaintyCoversThePerturbation)
{
  // The first-order change of λ due to δK is D = ψᵀ δK φ / (−ψᵀQ'φ)
  for (const double size : {1e-6, 1e-3})
    for (const bool damped : {false, true})
      {
        const double        d2 = damped ? 0.04 : 0.;
        const DampedFlutter flutter{{}, 0., d2}, perturbed{{1.3, 0., 0., 3. + 0.8 * size, 2. - 0.5 * size, 0.7 + 0.3 * size}, 0., d2};
        Family              family = flutter.family();
        const DenseMatrix   change = perturbed.stiffness(0.) - flutter.stiffness(0.), C = diagonal({0., d2});
        family.corrections = [&](const ChartPoint &point) {
          ComplexDenseMatrix D = point.left.transpose() * change * point.right;
          for (int i = 0; i < D.rows(); ++i)
            D.row(i) /= -(point.left.col(i).transpose() * (2. * point.lambda[i] * point.right.col(i) + C * point.right.col(i))).value();
          return D;
        };
        family.disturb = [&](ChartPoint &point) {
          for (std::size_t j = 0; j < point.lambda.size(); ++j)
            point.uncertainties[j] = std::abs(point.corrections(j, j));
        };
        const StabilityChart chart = family.chart(uniform_grid(0., 2., 10), precise());
        ASSERT_EQ(chart.thresholds.size(), 1u);
        const double error =
          std::abs(chart.thresholds[0].friction_coefficient - (damped ? perturbed.threshold() : perturbed.coalescence()));
        const double bound = chart.thresholds[0].uncertainty;
        EXPECT_LT(error, bound);
        EXPECT_LT(bound, 20. * error);
      }
}

TEST(Branches, ManyModes)
{
  // K = diag(squares) + μ U Vᵀ with U Vᵀ of rank three, in a random orthonormal basis
  struct Spectrum
  {
    std::string         name;
    std::vector<double> squares, weights, damping; ///< values for each mode; weights are the entries in U and V
    double              band, last;
  };
  std::mt19937                     generator(11);
  std::normal_distribution<double> normal;
  Spectrum                         spread{"spread", {}, {}, {}, 3.9, 4.2}, pins{"pins and disc", {}, {}, {}, 10., 1e9};
  for (int i = 0; i < 40; ++i)
    {
      spread.squares.push_back(std::pow(1. + 0.1 * (i + 0.3 * normal(generator)), 2));
      spread.weights.push_back(0.5);
    }
  spread.squares[20] = spread.squares[19] = spread.squares[18];
  // 12 pin modes within 1 %, a disc doublet among them, and above them six equal and two single modes
  for (int i = 0; i < 22; ++i)
    {
      pins.squares.push_back(i < 12 ? 25. * (1. + 0.02 * i / 12.) : i < 14 ? 25.2 : i < 20 ? 30. : 30. + i);
      pins.weights.push_back(i < 12 ? 0.1 : i < 14 || i >= 20 ? 0.3 : 1e-3);
    }
  Spectrum damped_pins = pins;
  damped_pins.damping.assign(22, 2e-3);
  std::fill_n(damped_pins.damping.begin(), 12, 1e-3);
  for (const Spectrum &c : {spread, pins, damped_pins})
    {
      const bool is_damped = !c.damping.empty();
      SCOPED_TRACE(c.name + (is_damped ? ", damped" : ""));
      const int         n     = c.squares.size();
      const DenseMatrix basis = orthonormal_columns(random(generator, n, n)), W = diagonal(c.weights);
      const DenseMatrix UV = W * random(generator, n, 3) * random(generator, 3, n) * W;
      Family            family{[&](const double mu) -> DenseMatrix { return basis.transpose() * (diagonal(c.squares) + mu * UV) * basis; }};
      if (is_damped)
        family.damping = [&](double) -> DenseMatrix { return basis.transpose() * diagonal(c.damping) * basis; };
      family.last                 = c.last;
      const StabilityChart coarse = family.chart(uniform_grid(0., 1., 20), precise(c.band, 1e-8));
      const StabilityChart fine   = family.chart(uniform_grid(0., 1., 80), precise(c.band, 1e-8));
      expect_counts(coarse);
      expect_counts(fine);
      EXPECT_GT(coarse.thresholds.size(), 2u);
      expect_same(coarse, fine, 2e-8);
    }
}

TEST(Branches, WhatIsLeftOfAnUnfinishedSearch)
{
  ChartOptions options        = precise();
  options.maximum_refinements = 0;
  const StabilityChart chart  = DampedFlutter().family().chart(uniform_grid(0., 2., 10), options);
  ASSERT_EQ(chart.thresholds.size(), 1u);
  EXPECT_NEAR(chart.thresholds[0].friction_coefficient, 0.9, 1e-12);
  EXPECT_NEAR(chart.thresholds[0].uncertainty, 0.1, 1e-12);
}

TEST(Branches, Refusals)
{
  Family family = DampedFlutter().family();
  EXPECT_THROW(family.chart({0.2, 0.2}, precise()), Error);
  EXPECT_THROW(family.chart({0.1, 0.2}, ChartOptions()), Error);
}

TEST(GrowthOnset, LiesBetweenTheValuesOfTheChart)
{
  // At 0.6, the second mode grows faster, but the first mode reaches both levels at smaller μ
  const Family         modes = given_modes({growing(5., 1e-3, 0.33), growing(7., 4e-3, 0.41)});
  const StabilityChart chart = modes.chart({0., 0.3, 0.6}, precise(10., 1e-10));
  const auto           found = onsets(modes, chart);
  for (const int level : {0, 1})
    {
      ASSERT_TRUE(found[level]);
      EXPECT_NEAR(found[level]->friction_coefficient, level == 0 ? 0.33 : 0.43, 1e-9);
      EXPECT_LT(found[level]->uncertainty, 1e-8);
      EXPECT_NEAR(found[level]->lambda.imag(), 5., 1e-12);
      EXPECT_NEAR(value(chart, found[level]->branch, 0).imag(), 5., 1e-12);
    }
  ASSERT_FALSE(chart.thresholds.empty());
  EXPECT_EQ(found[0]->friction_coefficient, chart.thresholds.front().friction_coefficient);
}

TEST(GrowthOnset, UncertaintyCoversTheErrorOfLambda)
{
  for (const double error : {-1e-6, 1e-5})
    {
      const Family modes = given_modes({growing(5., 1e-3, 0.33)}, error);
      const auto   weak  = onsets(modes, modes.chart({0., 0.3, 0.6}, precise(10., 1e-10)))[1];
      ASSERT_TRUE(weak);
      EXPECT_GT(std::abs(weak->friction_coefficient - 0.43), 1e-5);
      EXPECT_LE(std::abs(weak->friction_coefficient - 0.43), weak->uncertainty);
      EXPECT_LT(weak->uncertainty, 0.01);
    }
}

TEST(GrowthOnset, GrowthAtTheFirstValueBeganBefore)
{
  const Family modes = given_modes({growing(5., 1e-3, 0.2)});
  for (const auto &onset : onsets(modes, modes.chart({0.5, 0.6}, precise(10., 1e-10)), 0.1))
    {
      ASSERT_TRUE(onset);
      EXPECT_EQ(onset->friction_coefficient, 0.5);
      EXPECT_NEAR(onset->uncertainty, 0.4, 1e-15);
    }
}

TEST(GrowthOnset, ModesThatEnterTheBandCountFromThereOn)
{
  // One mode grows for μ > 0.05 and enters the band at 0.25; the other grows above the band
  const auto   entering = [](const double mu) { return Complex(0.1 * (mu - 0.05), 12. - 8. * mu); };
  const Family modes    = given_modes({entering, growing(13., 1e-2, 0.01)});
  for (const auto &onset : onsets(modes, modes.chart({0., 0.2, 0.4, 0.6}, precise(10., 1e-10))))
    {
      ASSERT_TRUE(onset);
      EXPECT_NEAR(onset->friction_coefficient, 0.25, 1e-9);
      EXPECT_NEAR(onset->lambda.imag(), 10., 2.);
    }
}

TEST(GrowthOnset, NothingWhereGrowthIsUndecidedOrWeak)
{
  const std::vector<double> grid      = {0., 0.3, 0.6};
  const Family              undecided = given_modes({growing(5., 1e-3, 0.33)}, 1e-2), weak = given_modes({growing(5., 1e-4, 0.33)});
  EXPECT_FALSE(onsets(undecided, undecided.chart(grid, precise(10., 1e-10)))[0]);
  const auto found = onsets(weak, weak.chart(grid, precise(10., 1e-10)));
  EXPECT_TRUE(found[0]);
  EXPECT_FALSE(found[1]);
}
