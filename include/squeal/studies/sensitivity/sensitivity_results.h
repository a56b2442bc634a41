// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/sensitivity/modal_damping.h>
#include <squeal/studies/sweep/sweep_charts.h>

namespace Squeal
{
  /// The contact before and after a motion of its nodes in the plane of the disc.
  struct ContactMotion
  {
    ContactInterface before, after;                     ///< all pairs
    ContactOperators operators_before, operators_after; ///< on the dofs of the scene
    double           step;                              ///< change of the parameter between them
  };

  /// A parameter p of the parameter file with the direction in which it changes the terms of the bodies and the contact: dQ/dp is the sum
  /// of the derivatives along the rates, and of the terms.
  struct SensitivityParameter
  {
    std::string path;  ///< "Pin material/Young modulus"
    std::string body;  ///< the only pin that changes; empty: all that the parameter sets
    std::string unit;  ///< "-" for none
    double      value; ///< in this unit

    ParameterValues   body_rates; ///< dq/dp of the parameters q of the bodies' terms
    std::vector<Term> derivative; ///< dX/dp where X is not a product of powers of p, with coefficients in the parameters of the bodies
    double OperationParameters::        *operation    = nullptr; ///< on which contact damping, or friction itself, depends; null: none
    std::shared_ptr<const ContactMotion> contact      = {};      ///< null: contact nodes stay where they are but for the axial direction
    int                                  modal_ratio  = -1;      ///< number of the entry of Damping/Modal damping ratio; −1: none
    ParameterValues                      spring_rates = {};      ///< dk/dp of the stiffnesses k of the contact
  };

  /// Every continuous parameter but those of the geometry that the scene depends on: materials of the disc and of the pins, of each pin by
  /// itself Young's modulus and density, mounts, stiffnesses of the contact, ratios of modal damping, friction coefficient, load, rotation speed, friction slope.
  /// Assembles volumes with neighbouring Poisson's ratios and constants of orthotropic materials.
  std::vector<SensitivityParameter> sensitivity_parameters(const Scene &scene, const Parameters &parameters);

  /// Lengths and angles of the built-in geometry: differences of the terms of the bodies on meshes whose nodes have moved a little to either
  /// side (sensitivity/mesh_motions.h), as a step of the run. Empty for other geometries.
  std::vector<SensitivityParameter> geometry_sensitivity_parameters(const Scene &scene, const BodyTerms &bodies, Run &run);

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
    static constexpr int main_line = 0; ///< of the sweep

    SweepModel                              &sweep; ///< of the main line
    const BodyTerms                         &bodies;
    const std::vector<SensitivityParameter> &parameters;
    std::optional<ModalDampingDerivatives>   modal_damping = {}; ///< none without it

    /// damping_rates() at the friction coefficients where they were wanted.
    mutable std::map<double, std::vector<ParameterValues>> known_damping_rates = {};

    /// Products of modes of a point of the main line. All processes must call.
    SensitivityProducts products(const ChartPoint &point, const std::vector<int> &modes) const;

    /// ψ_iᵀ (dQ(λ_j)/dp) φ_j of friction and damping of contact nodes that move, with the vectors on the dofs of the bodies and the reactions.
    ComplexDenseMatrix by_moved_contact(const ContactMotion      &motion,
                                        double                    friction_coefficient,
                                        const Eigentriples       &apart,
                                        const ComplexDenseMatrix &reactions) const;

    /// Rates of the friction coefficient and of the contact damping with respect to a parameter of the operation, by central differences.
    ParameterValues contact_rates(const SensitivityParameter &parameter, double friction_coefficient) const;

    /// dK/dp and dM/dp of the bodies for each parameter, which change the modes of modal damping and the reactions of steady sliding.
    std::vector<BodyRates> body_rates() const;

    /// Rates of the contact damping for each parameter by what it changes of the bodies, on which the reactions of steady sliding depend;
    /// empty where reactions are shares of the load. All processes must call.
    const std::vector<ParameterValues> &damping_rates(double friction_coefficient) const;

    /// Modes of a point of the main line, as the basis grows by them.
    ChartModel::ModesAt modes_at(const ChartPoint &point, const std::vector<int> &modes) const;

    /// Grows the basis by the residuals of groups of modes, one group after the other, as the vectors of one take less memory than those of
    /// all, and forgets what was evaluated; returns why it cannot, or nothing. All processes must call.
    std::string grow(const std::vector<std::vector<ChartModel::ModesAt>> &groups, unsigned int maximum_basis);
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

  /// Derivatives of modes at the friction coefficient of the operation: of the growing ones, or the least damped. Grows the basis by their
  /// residuals until the derivatives change no more than the tolerance, as a step of the run.
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
   * Derivatives of the thresholds of a chart of the main line, with a basis that is grown once by the residuals of their modes, as a step
   * of the run.
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

  /// Modes of the linearised system with left vectors, by the residual iteration to an accuracy that derivatives need, as a step of the run.
  FrictionModes left_and_right_modes(const FrictionlessModes &frictionless, double value, Run &run);

  /// Eigenvalues with their vectors; the modes must have left ones.
  Eigentriples eigentriples(const ComplexModes &modes);

  /// `Study = sensitivity` of a system file: derivatives of λ with respect to each of its parameters.
  void run_sensitivity_of_system(Run &run);
} // namespace Squeal
