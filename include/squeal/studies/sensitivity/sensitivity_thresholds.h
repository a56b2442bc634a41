#pragma once

#include <squeal/studies/sensitivity/sensitivity_model.h>
#include <squeal/studies/sweep/sweep_charts.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Derivatives of a threshold.
  struct ThresholdSensitivity
  {
    const Threshold    *threshold;
    std::string         obstacle;    ///< why there are none; empty
    std::vector<double> derivatives; ///< dμ_c/dp of each parameter; empty with an obstacle
    std::vector<double> errors;      ///< estimated
  };

  /**
   * Derivatives of the thresholds of a chart of the main line, with a basis that is grown once by the residuals of their modes, as a step of the run.
   *
   * At a coalescence δ² = (λ_1 − λ_2)² is analytic and zero:
   *
   *   dμ_c/dp = −(∂δ²/∂p) / (∂δ²/∂μ)
   *
   * with values at μ_c from three distances on either side (value_at_centre()); where one mode ceases to decay
   *
   *   dμ_c/dp = −Re(∂λ/∂p) / Re(∂λ/∂μ).
   */
  std::vector<ThresholdSensitivity> threshold_sensitivities(SensitivityModel &model, const SweepChart &chart, Run &run);
} // namespace Squeal
