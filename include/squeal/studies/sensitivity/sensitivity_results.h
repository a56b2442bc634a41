#pragma once

#include <squeal/studies/sensitivity/sensitivity_model.h>
#include <squeal/studies/sweep/sweep_charts.h>

#include <complex>
#include <string>
#include <vector>

namespace Squeal
{
  /// What of one mode or of several has derivatives.
  enum class Differentiated
  {
    eigenvalue, ///< λ of a simple mode
    pair,       ///< the mean of two that nearly coalesce
    cluster     ///< the mean of several that nothing separates
  };

  template <>
  inline constexpr EnumName<Differentiated> enum_table<Differentiated>[] = {{Differentiated::eigenvalue, "lambda"},
                                                                            {Differentiated::pair, "mean of a coalescing pair"},
                                                                            {Differentiated::cluster, "mean of equal eigenvalues"}};

  /// Derivatives of a mode at the operating friction coefficient.
  struct ModeSensitivity
  {
    std::complex<double>              lambda; ///< [rad/s]
    ModeLabel                         label;
    bool                              is_unstable;
    Differentiated                    kind;
    std::vector<std::complex<double>> derivatives; ///< dλ/dp of each parameter, or of the mean
    std::vector<std::complex<double>> changes; ///< by the last growth of the basis: real and imaginary parts are estimates of the errors
  };

  /**
   * Derivatives of modes at the friction coefficient of the operation: of the growing ones, or the least damped. Grows the basis by their
   * residuals until the derivatives change no more than the tolerance, as a step of the run.
   */
  std::vector<ModeSensitivity> mode_sensitivities(SensitivityModel &model, Run &run);

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
