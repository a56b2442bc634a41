// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/sensitivity/eigenvalue_derivatives.h>
#include <squeal/sensitivity/modal_damping.h>
#include <squeal/studies/steps/imported_modes.h>
#include <squeal/studies/updating/measured_modes.h>

#include <functional>

namespace Squeal
{
  /// A fitted parameter and its range.
  struct FittedParameter
  {
    std::string name; ///< name as in Designs/Variables
    double      start, lower, upper;

    /// Value at the fraction x of the range.
    double at(const double x) const
    {
      return x >= 1. ? upper : lower + x * (upper - lower);
    }
  };

  /// Fitted parameters, from Designs/Variables. Throws ParameterError if a parameter has no range or starts outside its range.
  ///
  /// @param current value of a parameter in the model, by its name
  std::vector<FittedParameter> fitted_parameters(const DesignParameters                           &designs,
                                                 const std::function<double(const std::string &)> &current);

  /// Derivatives of the equations with respect to a parameter.
  struct EquationRates
  {
    ParameterValues   bodies;  ///< rates of the parameters in the terms of the bodies
    std::vector<Term> terms;   ///< dX/dp of matrices X that depend on p
    ParameterValues   contact; ///< rates of the friction coefficient and contact damping
  };

  /// dλ/dp = i dω/dp of each mode without friction and damping with respect to each parameter, ω' = φᵀ (K' − ω² M') φ / 2ω; zero for ω = 0.
  /// In a cluster of equal ω, every mode has the mean derivative. Collective.
  ///
  /// @param squares ω² [rad²/s²]
  /// @param shapes  φ, mass-normalised
  std::vector<std::vector<std::complex<double>>> real_mode_derivatives(const std::vector<double>    &squares,
                                                                       const MultiVector            &shapes,
                                                                       const std::vector<BodyRates> &rates);

  /// dλ/dp of complex modes from D and the N of each parameter, see eigenvalue_derivative(). In a cluster, every mode has the mean
  /// derivative.
  std::vector<std::vector<std::complex<double>>> complex_mode_derivatives(const std::vector<std::complex<double>> &lambda,
                                                                          const std::vector<ComplexDenseMatrix>   &N,
                                                                          const ComplexDenseMatrix                &D);

  /// Responses of the sensors to mode shapes, n_s × k; no rows without sensors. Collective.
  ///
  /// @param rows Sensors::rows(); null without sensors
  ComplexDenseMatrix at_sensors(const std::shared_ptr<const SparseMatrix> &rows, const MultiVector &re, const MultiVector *im = nullptr);

  /// Modes of all measured states and their derivatives, at given values of the fitted parameters. Collective.
  using ModesAtValues = std::function<std::vector<ComputedMode>(const std::vector<double> &values)>;

  /// Modes of a meshed model, which is remeshed and reassembled when its matrices change. All arguments must outlive the function. Throws
  /// ParameterError if a parameter cannot be fitted.
  ModesAtValues modes_of_scene(Scene &scene, const std::vector<FittedParameter> &parameters, const MeasuredModes &measured, Run &run);

  /// Modes of a system file. All arguments must outlive the function. Throws ParameterError if component modes are measured.
  ModesAtValues modes_of_file(const SystemFile                   &file,
                              const std::vector<FittedParameter> &parameters,
                              const MeasuredModes                &measured,
                              Run                                &run);
} // namespace Squeal
