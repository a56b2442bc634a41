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

  /// Residuals at a point of the unit cube; nothing where there are none.
  using ResidualsAt = std::function<std::optional<Residuals>(const std::vector<double> &x)>;

  struct Fit
  {
    std::vector<double> x; ///< best point found, n
    Residuals           residuals;
    bool                has_converged;
    int                 n_iterations;
    std::string         message; ///< of the method, for an error
  };

  /**
   * A local minimum of ½ |r(x)|² in the unit cube by Ceres' trust-region method of Levenberg and Marquardt. Points without residuals count
   * as failed steps, after which shorter ones are tried.
   *
   * @param start with residuals
   * @param tolerance the fit ends when |Δx| is smaller, or when |r|² changes by no more than the square of this part
   */
  Fit least_squares(const ResidualsAt &residuals_at, const std::vector<double> &start, double tolerance, int maximum_iterations);

  /// What residuals tell about the parameters of a fit.
  struct FitStatistics
  {
    std::vector<bool>                     is_at_limit;
    std::vector<std::optional<double>>    deviations;   ///< standard deviation of x; none at a limit or if undetermined
    DenseMatrix                           correlations; ///< n × n; zero of parameters without a deviation
    std::vector<double>                   singular_values;
    std::vector<std::vector<std::size_t>> undetermined; ///< groups of parameters of which the data determine some combinations only
  };

  /**
   * Covariance s² (JᵀJ)⁻¹ of the parameters that are not at a limit, by the singular value decomposition J = U S Vᵀ.
   *
   * Directions of V with s / S_k > 1, whose deviation exceeds the ranges, or with S_k up to 1e-7 of the largest, are undetermined, and so are
   * parameters of which they contain more than 1 %.
   *
   * @param residuals   at the minimum x
   * @param is_relative the weights are known up to a common factor: s² = |r|² / (m − n); else s = 1. Without redundant data there are no
   *                    deviations then
   */
  FitStatistics fit_statistics(const Residuals &residuals, const std::vector<double> &x, bool is_relative);
} // namespace Squeal
