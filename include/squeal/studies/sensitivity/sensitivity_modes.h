#pragma once

#include <squeal/studies/sensitivity/sensitivity_model.h>

#include <complex>
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
} // namespace Squeal
