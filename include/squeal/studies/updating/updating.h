#pragma once

#include <squeal/sensitivity/eigenvalue_derivatives.h>
#include <squeal/sensitivity/modal_damping.h>
#include <squeal/studies/steps/imported_modes.h>
#include <squeal/studies/updating/measured_modes.h>

#include <functional>

namespace Squeal
{
  /// A parameter that is fitted within a range.
  struct FittedParameter
  {
    std::string name; ///< as in Designs/Variables
    double      start, lower, upper;

    /// The value at a part x of the range.
    double at(const double x) const
    {
      return x >= 1. ? upper : lower + x * (upper - lower);
    }
  };

  /// The parameters that Designs/Variables names. Throws ParameterError if one has no range, or starts outside of it.
  ///
  /// @param current value that a parameter has, by its name
  std::vector<FittedParameter> fitted_parameters(const DesignParameters                           &designs,
                                                 const std::function<double(const std::string &)> &current);

  /// How the equations change with a parameter, per unit of it.
  struct EquationRates
  {
    ParameterValues   bodies;  ///< of parameters of the bodies' terms
    std::vector<Term> terms;   ///< dX/dp where matrices X change
    ParameterValues   contact; ///< of friction coefficient and damping of the contact
  };

  /// dλ/dp = i dω/dp of modes without friction and damping, ω' = φᵀ (K' − ω² M') φ / 2ω, for each mode and parameter; zero for ω = 0, and in
  /// a cluster of equal ω the mean. All processes must call.
  ///
  /// @param squares ω² [rad²/s²]
  /// @param shapes  φ, orthonormal in the mass
  std::vector<std::vector<std::complex<double>>> real_mode_derivatives(const std::vector<double>    &squares,
                                                                       const MultiVector            &shapes,
                                                                       const std::vector<BodyRates> &rates);

  /// dλ/dp of modes with left vectors from N of each parameter and D, see eigenvalue_derivative(); in a cluster the mean.
  std::vector<std::vector<std::complex<double>>> complex_mode_derivatives(const std::vector<std::complex<double>> &lambda,
                                                                          const std::vector<ComplexDenseMatrix>   &N,
                                                                          const ComplexDenseMatrix                &D);

  /// Modes at values of the fitted parameters, with derivatives, of the states that are measured. All processes must call.
  using ModesAtValues = std::function<std::vector<ComputedMode>(const std::vector<double> &values)>;

  /// Those of a scene, which is meshed and assembled again where matrices change. All arguments must outlive the function. Throws ParameterError
  /// where a parameter cannot be fitted.
  ModesAtValues modes_of_scene(Scene &scene, const std::vector<FittedParameter> &parameters, const MeasuredModes &measured, Run &run);

  /// Those of a system file.
  ModesAtValues modes_of_file(const SystemFile                   &file,
                              const std::vector<FittedParameter> &parameters,
                              const MeasuredModes                &measured,
                              Run                                &run);
} // namespace Squeal
