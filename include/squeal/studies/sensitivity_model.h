#pragma once

#include <squeal/sensitivity/eigenvalue_derivatives.h>
#include <squeal/sensitivity/term_products.h>
#include <squeal/studies/sensitivity_parameters.h>
#include <squeal/studies/sweep_charts.h>
#include <squeal/studies/sweep_model.h>

#include <complex>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// Products from which the derivatives of some modes at an operating point follow, k × k each.
  struct SensitivityProducts
  {
    std::vector<std::complex<double>> lambda;
    ComplexDenseMatrix                D; ///< ψ_iᵀ ((λ_i + λ_j) M + C) φ_j
    std::vector<ComplexDenseMatrix>   N; ///< ψ_iᵀ (∂Q(λ_j)/∂p) φ_j of each parameter
  };

  /// A sweep with its terms kept apart, as far as the derivatives of its eigenvalues need.
  struct SensitivityModel
  {
    SweepModel                              &sweep; ///< of the main line
    const BodyTerms                         &bodies;
    const std::vector<SensitivityParameter> &parameters;

    /// Products of modes of a point of the main line. All processes must call.
    SensitivityProducts products(const ChartPoint &point, const std::vector<int> &modes) const;

    /// ψ_iᵀ (dQ(λ_j)/dp) φ_j of friction and damping of contact nodes that move, with the vectors on the dofs of the bodies and the reactions.
    ComplexDenseMatrix by_moved_contact(const ContactMotion      &motion,
                                        double                    friction_coefficient,
                                        const Eigentriples       &apart,
                                        const ComplexDenseMatrix &reactions) const;

    /// Rates of the friction coefficient and of the contact damping with respect to a parameter of the operation, by central differences.
    ParameterValues contact_rates(const SensitivityParameter &parameter, double friction_coefficient) const;
  };

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

  /// Derivatives of a threshold.
  struct ThresholdSensitivity
  {
    const Threshold    *threshold;
    std::string         obstacle;    ///< why there are none; empty
    std::vector<double> derivatives; ///< dμ_c/dp of each parameter; empty with an obstacle
    std::vector<double> errors;      ///< estimated
  };

  /**
   * Derivatives of modes at the friction coefficient of the operation: of the growing ones, or the least damped. Grows the basis by their
   * residuals until the derivatives change no more than the tolerance, as a step of the run.
   */
  std::vector<ModeSensitivity> mode_sensitivities(SensitivityModel &model, Run &run);

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
