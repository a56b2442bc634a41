// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// Weighted residuals r and their derivatives J = dr/dx.
  struct Residuals
  {
    Eigen::VectorXd r; ///< m [-]
    DenseMatrix     J; ///< m × n [-]
  };

  /// Residuals at a point of the unit cube; empty if they cannot be computed.
  using ResidualsAt = std::function<std::optional<Residuals>(const std::vector<double> &x)>;

  struct Fit
  {
    std::vector<double> x; ///< best point found, n values
    Residuals           residuals;
    bool                has_converged;
    int                 n_iterations;
    std::string         message; ///< from Ceres, for error messages
  };

  /**
   * Finds a local minimum of ½ |r(x)|² in the unit cube with the Levenberg–Marquardt trust-region method of Ceres. If the residuals at a
   * point cannot be computed, the step counts as failed and is shortened.
   *
   * @param start     starting point, at which residuals must exist
   * @param tolerance limit of |Δx| / |x|; its square is the limit of the relative change in |r|²
   */
  Fit least_squares(const ResidualsAt &residuals_at, const std::vector<double> &start, double tolerance, int maximum_iterations);

  /// Uncertainty of fitted parameters.
  struct FitStatistics
  {
    std::vector<bool>                     is_at_limit;
    std::vector<std::optional<double>>    deviations;   ///< standard deviation of x; empty at a limit or if undetermined
    DenseMatrix                           correlations; ///< n × n; zero for parameters without a deviation
    std::vector<std::vector<std::size_t>> undetermined; ///< groups of parameters that the data do not determine individually
  };

  /**
   * Covariance s² (JᵀJ)⁻¹ of the parameters that are not at a limit, from the singular value decomposition J = U S Vᵀ.
   *
   * A direction of V is undetermined if s / S_k >= 1, that is, if its standard deviation is at least as large as the ranges, or if
   * S_k <= 1e-7 S_1. A parameter is undetermined if its component in these directions exceeds 1 %.
   *
   * @param residuals   at the minimum x
   * @param is_relative true: weights are known up to a common factor, s² = |r|² / (m − n) with n free parameters, and deviations exist
   *                    only if m > n; false: s = 1
   */
  FitStatistics fit_statistics(const Residuals &residuals, const std::vector<double> &x, bool is_relative);
} // namespace Squeal
