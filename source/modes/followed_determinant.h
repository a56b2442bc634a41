// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense_eigenproblems.h>
#include <squeal/linear_algebra/dense_lu.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_determinant.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <optional>
#include <tuple>
#include <vector>

namespace Squeal
{
  /// An attempted step to another point of the contour.
  struct Step
  {
    double size;               ///< size of the step: acceptable up to 1, approximately proportional to the length
    double phase;              ///< change of the determinant's phase [rad]
    double largest_phase = 0.; ///< largest change of phase of a factor of the determinant [rad]
  };

  /// A determinant whose phase is followed along the contour.
  class FollowedDeterminant
  {
  public:
    virtual ~FollowedDeterminant() = default;

    virtual void start(std::complex<double> lambda)   = 0;
    virtual Step attempt(std::complex<double> lambda) = 0;

    /// Moves to the point of the last attempt.
    virtual void accept() = 0;

    /// Upper limit of the next step in addition to Step::size [rad/s].
    virtual double longest_step(const std::complex<double>) const
    {
      return std::numeric_limits<double>::infinity();
    }

    int n_points = 0;
  };

  /// Limit for ‖F‖_F of a step. Within the step, F may be larger but must be below 1 [-].
  constexpr double largest_change = 0.5;

  /// Follows the determinant of a small matrix.
  class FollowedDense : public FollowedDeterminant
  {
  public:
    /// The matrix A at a point, with the coefficients of an error bound.
    struct Sample
    {
      ComplexDenseMatrix                matrix;
      std::vector<std::complex<double>> scaling;     ///< diagonal B; empty: I
      double                            offset = 0.; ///< the error is bounded by offset + factor ‖A⁻¹ B‖
      double                            factor = 0.;
    };
    using Function = std::function<Sample(std::complex<double>)>;

    /// @param poles poles ω of the matrix on the positive imaginary axis; steps are limited near them
    FollowedDense(Function function, std::vector<double> poles, const double largest_phase_step, MPI_Comm comm)
      : function(std::move(function))
      , poles(std::move(poles))
      , largest_phase_step(largest_phase_step)
      , comm(comm)
    {}

    void start(const std::complex<double> lambda) override
    {
      ++n_points;
      set_next(function(lambda));
      accept();
    }

    Step attempt(const std::complex<double> lambda) override
    {
      ++n_points;
      Sample             sample = function(lambda);
      ComplexDenseMatrix F      = sample.matrix;
      F                         = current.factors->solve(F);
      F.diagonal().array() -= 1.;
      const std::complex<double> trace = F.trace();
      // Balance only finite matrices, because LAPACK does not accept NaN
      const double norm         = F.norm();
      const auto [size, phase]  = agreed_pair(std::isfinite(norm) ? std::min(norm, balanced(F).norm()) : norm, trace.imag());
      constexpr double infinity = std::numeric_limits<double>::infinity();
      Step             step{std::isfinite(size) ? size / largest_change : infinity, 0.};
      if (step.size > 1.)
        return step;

      set_next(std::move(sample));
      step.phase = next.argument - current.argument;
      step.phase += 2. * M_PI * std::round((phase - step.phase) / (2. * M_PI));
      step.largest_phase = std::abs(step.phase);
      // Reject the step if phase and trace differ by more than the bound, because one of the two has a large rounding error
      if (!(std::abs(step.phase - phase) <= -std::log(1. - size) - size + 1e-6))
        return {infinity, 0.};
      step.size = std::max(step.size, step.largest_phase / largest_phase_step);
      return step;
    }

    void accept() override
    {
      current = std::move(next);
      error   = std::max(error, current.error);
    }

    double longest_step(const std::complex<double> lambda) const override
    {
      double distance = std::numeric_limits<double>::infinity(); // distance to the nearest pole ±iω
      for (const double omega : poles)
        distance = std::min(distance, std::hypot(lambda.real(), std::abs(lambda.imag()) - omega));
      return 0.5 * distance;
    }

    double error = 0.; ///< largest error bound of all accepted points

  private:
    struct Point
    {
      std::optional<ComplexLU> factors;
      double                   argument = 0., error = 0.;
    };

    void set_next(Sample sample)
    {
      next.factors.emplace(sample.matrix);
      double norm = std::sqrt(sample.matrix.rows()) * next.factors->inverse_norm();
      if (!sample.scaling.empty() && std::isfinite(norm))
        norm = next.factors->solve(as_column(sample.scaling).asDiagonal()).norm();
      std::tie(next.argument, next.error) = agreed_pair(next.factors->log_determinant().imag(), sample.offset + sample.factor * norm);
    }

    /// Values of process 0, so that all processes take identical steps in spite of rounding errors.
    std::pair<double, double> agreed_pair(const double first, const double second) const
    {
      const std::vector<double> values = agreed(comm, {{first, second}, {}}).values;
      return {values[0], values[1]};
    }

    const Function            function;
    const std::vector<double> poles;
    const double              largest_phase_step;
    MPI_Comm                  comm;
    Point                     current, next;
  };

  /// Follows det Q by sparse LU.
  class FollowedSparse : public FollowedDeterminant
  {
  public:
    FollowedSparse(const SparseDeterminant &determinant, const double largest_phase_step)
      : determinant(determinant)
      , largest_phase_step(largest_phase_step)
    {}

    void start(const std::complex<double> lambda) override
    {
      ++n_points;
      current = {lambda, determinant.logarithm(lambda)};
    }

    Step attempt(const std::complex<double> lambda) override
    {
      n_points += 2;
      const std::complex<double> middle = determinant.logarithm(0.5 * (current.lambda + lambda));
      next                              = {lambda, determinant.logarithm(lambda)};
      const std::complex<double> first = change(current.logarithm, middle), second = change(middle, next.logarithm);
      const double               largest = std::max(std::abs(first), std::abs(second));
      return {std::isfinite(largest) ? largest / largest_phase_step : std::numeric_limits<double>::infinity(), first.imag() + second.imag(),
              std::max(std::abs(first.imag()), std::abs(second.imag()))};
    }

    void accept() override
    {
      current = next;
    }

  private:
    struct Point
    {
      std::complex<double> lambda, logarithm;
    };

    static std::complex<double> change(const std::complex<double> from, const std::complex<double> to)
    {
      return {to.real() - from.real(), std::remainder(to.imag() - from.imag(), 2. * M_PI)};
    }

    const SparseDeterminant &determinant;
    const double             largest_phase_step;
    Point                    current, next;
  };
} // namespace Squeal
