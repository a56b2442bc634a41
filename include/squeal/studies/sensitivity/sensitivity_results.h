// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/sensitivity/modal_damping.h>
#include <squeal/studies/sweep/sweep_charts.h>

namespace Squeal
{
  /// Contact before and after a motion of its nodes in the plane of the disc.
  struct ContactMotion
  {
    ContactInterface before, after;                     ///< all pairs of contact nodes
    ContactOperators operators_before, operators_after; ///< operators on the dofs of the model
    double           step;                              ///< change in the parameter from `before` to `after` [unit of the parameter]
  };

  /// A parameter p and its effect on the terms of the bodies and the contact. For the bodies, dQ/dp is the sum of the derivative along
  /// `body_rates` and the terms in `derivative`.
  struct SensitivityParameter
  {
    std::string path;  ///< name, for example "Pin material/Young modulus"
    std::string body;  ///< the only pin or volume that changes; empty: all bodies of the parameter
    std::string unit;  ///< "-" without a unit
    double      value; ///< [unit]

    ParameterValues   body_rates; ///< dq/dp of the parameters q of the bodies' terms
    std::vector<Term> derivative; ///< dX/dp for matrices X that are not products of powers of p; coefficients use body parameters
    double OperationParameters::        *operation    = nullptr; ///< member on which contact damping or friction depends; null: none
    std::shared_ptr<const ContactMotion> contact      = {};      ///< null: contact nodes do not move in the plane of the disc
    int                                  modal_ratio  = -1;      ///< index of the entry in Damping/Modal damping ratio; −1: none
    ParameterValues                      spring_rates = {};      ///< dk/dp of contact stiffnesses k
  };

  /// Continuous parameters of the model except geometry: materials of the disc and of the pins, Young's modulus and density of each pin
  /// individually, mounts, contact stiffnesses, modal damping ratios, friction coefficient, and, if the model depends on them, load,
  /// rotation speed and friction slope. Assembles volumes with perturbed Poisson's ratios and constants of orthotropic materials.
  std::vector<SensitivityParameter> sensitivity_parameters(const Scene &scene, const Parameters &parameters);

  /// Lengths and angles of the built-in geometry: differences of the terms of the bodies on meshes with nodes moved slightly to either side
  /// (sensitivity/mesh_motions.h), as a step of the run. Empty for other geometries, and for Sensitivity/Geometry = none.
  std::vector<SensitivityParameter> geometry_sensitivity_parameters(const Scene &scene, const BodyTerms &bodies, Run &run);

  /// Products for the derivatives of some modes at an operating point, k × k each.
  struct SensitivityProducts
  {
    std::vector<std::complex<double>> lambda;
    ComplexDenseMatrix                D; ///< ψ_iᵀ ((λ_i + λ_j) M + C) φ_j
    std::vector<ComplexDenseMatrix>   N; ///< ψ_iᵀ (∂Q(λ_j)/∂p) φ_j of each parameter
  };

  /// A sweep with the individual terms that are needed for derivatives of its eigenvalues.
  struct SensitivityModel
  {
    static constexpr int main_line = 0; ///< index of the main line of the sweep

    SweepModel                              &sweep; ///< model of the main line
    const BodyTerms                         &bodies;
    const std::vector<SensitivityParameter> &parameters;
    std::optional<ModalDampingDerivatives>   modal_damping = {}; ///< empty without modal damping

    /// damping_rates() at the friction coefficients used so far.
    mutable std::map<double, std::vector<ParameterValues>> known_damping_rates = {};

    /// Products for modes at a point of the main line. Collective.
    SensitivityProducts products(const ChartPoint &point, const std::vector<int> &modes) const;

    /// Contribution of friction and contact damping to ψ_iᵀ (dQ(λ_j)/dp) φ_j when contact nodes move. @p apart: modes on the dofs of the
    /// uncoupled bodies, with left vectors without friction; @p reactions: normal reactions of the modes.
    ComplexDenseMatrix by_moved_contact(const ContactMotion      &motion,
                                        double                    friction_coefficient,
                                        const Eigentriples       &apart,
                                        const ComplexDenseMatrix &reactions) const;

    /// Rates of the friction coefficient and contact damping with respect to a parameter of the operation, by central differences.
    ParameterValues contact_rates(const SensitivityParameter &parameter, double friction_coefficient) const;

    /// dK/dp and dM/dp of the bodies for each parameter, which affect modal damping and the reactions of steady sliding.
    std::vector<BodyRates> body_rates() const;

    /// Rates of the contact damping for each parameter through the reactions of steady sliding; empty without steady sliding or contact
    /// damping. Collective.
    const std::vector<ParameterValues> &damping_rates(double friction_coefficient) const;

    /// Modes of a point of the main line, for extending the basis.
    ChartModel::ModesAt modes_at(const ChartPoint &point, const std::vector<int> &modes) const;

    /// Extends the basis by residuals, one group of modes at a time to limit memory, and discards evaluated points. Returns the reason if
    /// not all groups could be added, otherwise an empty text. Collective.
    std::string grow(const std::vector<std::vector<ChartModel::ModesAt>> &groups, unsigned int maximum_basis);
  };

  /// The quantity that is differentiated.
  enum class Differentiated
  {
    eigenvalue, ///< λ of a simple mode
    pair,       ///< mean of two modes that nearly coalesce
    cluster     ///< mean of several inseparable modes
  };

  template <>
  inline constexpr EnumName<Differentiated> enum_table<Differentiated>[] = {{Differentiated::eigenvalue, "lambda"},
                                                                            {Differentiated::pair, "mean of a coalescing pair"},
                                                                            {Differentiated::cluster, "mean of equal eigenvalues"}};

  /// Derivatives of a mode at Operation/Friction coefficient.
  struct ModeSensitivity
  {
    std::complex<double>              lambda; ///< [rad/s]
    ModeLabel                         label;
    bool                              is_unstable;
    Differentiated                    kind;
    std::vector<std::complex<double>> derivatives; ///< dλ/dp for each parameter; λ is the mean for several modes
    std::vector<std::complex<double>> changes;     ///< changes in the derivatives due to the last extension of the basis: error estimates
  };

  /// Derivatives of the growing modes at Operation/Friction coefficient or, if no mode grows, of the least damped modes; at most
  /// Sensitivity/Largest number of modes. Extends the basis by their residuals, a limited number of times, until the derivatives change by
  /// less than the tolerance. A step of the run.
  std::vector<ModeSensitivity> mode_sensitivities(SensitivityModel &model, Run &run);

  /// Derivatives of a threshold.
  struct ThresholdSensitivity
  {
    const Threshold    *threshold;
    std::string         obstacle;    ///< reason why there are no derivatives; otherwise empty
    std::vector<double> derivatives; ///< dμ_c/dp for each parameter; empty with an obstacle
    std::vector<double> errors;      ///< estimated errors
  };

  /**
   * Derivatives of the thresholds of a chart of the main line, as a step of the run. The basis is extended once by the residuals of their
   * modes.
   *
   * At a coalescence μ_c, δ² = (λ_1 − λ_2)² is analytic and zero:
   *
   *   dμ_c/dp = −(∂δ²/∂p) / (∂δ²/∂μ)
   *
   * Both derivatives are extrapolated from three distances on either side of μ_c (value_at_centre()). At a zero of Re λ of one mode,
   *
   *   dμ_c/dp = −Re(∂λ/∂p) / Re(∂λ/∂μ).
   */
  std::vector<ThresholdSensitivity> threshold_sensitivities(SensitivityModel &model, const SweepChart &chart, Run &run);

  /// Modes of the linearised system with left vectors that are sufficiently accurate for derivatives, by residual iteration, as a step of
  /// the run.
  FrictionModes left_and_right_modes(const FrictionlessModes &frictionless, double value, Run &run);

  /// Eigenvalues with right and left vectors; @p modes must have left vectors.
  Eigentriples eigentriples(const ComplexModes &modes);

  /// `Study = sensitivity` for a system file: derivatives of λ with respect to all parameters of the file.
  void run_sensitivity_of_system(Run &run);
} // namespace Squeal
