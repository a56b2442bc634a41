// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/contact/coupled_system.h>
#include <squeal/contact/updated_inverse.h>

#include <complex>
#include <memory>
#include <string>
#include <vector>

namespace Squeal
{
  /// Eigenvalues of the coupled system with friction in a band, from any solver: the complex modes in the Band, ascending in frequency,
  /// with coupled displacements φ_c, φᴴ M_c φ = 1, and the real eigenvalues within the radius of the band.
  struct ComplexModes
  {
    std::vector<std::complex<double>> lambda;                              ///< λ of the complex modes [rad/s]
    std::shared_ptr<MultiVector>      real_part, imaginary_part;           ///< φ_c, n × k
    std::shared_ptr<MultiVector>      left_real_part, left_imaginary_part; ///< ψ, ψᵀQ(λ) = 0, ψᴴM_cψ = 1; null if not computed
    std::vector<double>               residuals;                           ///< ‖Q(λ)φ‖ / ‖Kφ‖ [-]
    std::vector<double>               energy_residuals;                    ///< ε_res, eq. (16) of the paper [-]
    std::vector<double>               estimated_errors; ///< |δλ| / |λ| [-]; empty if the method does not estimate errors
    int                               n_rigid_body = 0; ///< number of rigid-body modes, λ = 0
    std::vector<double>               real_values;      ///< real λ ≠ 0, |λ| ≤ the band's radius, ascending [1/s]
    std::string                       summary;          ///< method and its cost, for messages
  };

  /// Re xᴴy of each pair of complex vectors; columns 0 ... k-1 are real parts, k ... 2k-1 imaginary parts.
  std::vector<double> complex_products(const MultiVector &X, const MultiVector &Y);

  /// Force residuals Q(λ) φ (or Q(λ)ᵀ φ) of complex vectors, stored as for complex_products().
  MultiVector force_residuals(const CoupledSystem                     &system,
                              const ParameterValues                   &values,
                              const std::vector<std::complex<double>> &lambda,
                              const MultiVector                       &real_part,
                              const MultiVector                       &imaginary_part,
                              bool                                     left = false);

  /**
   * Normalises right and left modes to φᴴ M_c φ = 1 with the entry of largest modulus real (fix_phase()), sorts them by frequency, and
   * computes two residuals:
   *
   *   ‖Q(λ)φ‖₂ / ‖K_c φ‖₂  and  ε_res = |R_Uᴴ R_F| / (φᴴ K φ),  R_F = Q(λ)φ,  R_U = K_c⁻¹ R_F
   *
   * (eqs. (14) to (16) of the paper). If K_c is singular, R_U uses the shifted stiffness of @p inverse.
   */
  void finish_modes(const CoupledSystem &system, const ParameterValues &values, const UpdatedInverse &inverse, ComplexModes &modes);

  /// Verdict on the growth of a mode.
  enum class Verdict
  {
    stable, ///< the mode decays
    unstable,
    undecided, ///< the accuracy of λ is insufficient for a verdict
    neutral    ///< the mode neither grows nor decays, up to rounding errors
  };

  template <>
  inline constexpr EnumName<Verdict> enum_table<Verdict>[] = {{Verdict::stable, "stable"},
                                                              {Verdict::unstable, "unstable"},
                                                              {Verdict::undecided, "undecided"},
                                                              {Verdict::neutral, "stable"}};

  /// Divergence rates |ξ| up to this limit are rounding errors of neutral modes [-].
  inline constexpr double negligible_divergence = 1e-8;

  /// Safety factor for estimated errors of λ, which may be too small [-].
  inline constexpr double error_safety = 3.;

  /**
   * Verdict on a mode λ = R + iω, ω ≥ 0, whose estimated error is @p error [rad/s]. With u = 3 error and ε = 10⁻⁸, the mode is
   *
   *   unstable   if R − u > ε ω,
   *   stable     if R + u ≤ ε ω, and neutral if also |R| ≤ ε ω,
   *   undecided  otherwise, and if λ or the error is NaN.
   *
   * An error of zero, as for branches of a sweep, allows only for rounding errors: R = ± ε ω is still neutral.
   *
   * @param growth_needs_coalescence true if the system is undamped and the mode cannot coalesce with another mode within the errors. Since
   * −λ̄ is then also an eigenvalue, R = 0 is exact even if ω is not, and the criterion for `stable` is R ≤ ε ω, without u.
   */
  Verdict verdict_of(const std::complex<double> &lambda, double error = 0., bool growth_needs_coalescence = false);
} // namespace Squeal
