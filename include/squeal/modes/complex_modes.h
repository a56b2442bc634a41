#pragma once

#include <squeal/contact/coupled_system.h>
#include <squeal/contact/updated_inverse.h>

#include <complex>
#include <memory>
#include <string>
#include <vector>

namespace Squeal
{
  /**
   * Eigenvalues of the coupled system with friction in a band, however they were found: the complex modes, 0 < Im λ ≤ the
   * band's end and |λ| ≤ its radius (band_radius()), ascending in frequency, with coupled displacements φ_c, φᴴ M_c φ = 1; and the real
   * eigenvalues up to the same radius.
   */
  struct ComplexModes
  {
    std::vector<std::complex<double>> lambda;                         ///< [rad/s]
    std::shared_ptr<MultiVector>      real_part, imaginary_part;      ///< φ_c, n × k
    std::shared_ptr<MultiVector> left_real_part, left_imaginary_part; ///< ψ, ψᵀQ(λ) = 0, ψᴴM_cψ = 1; null where the method gives none
    std::vector<double>          residuals;                           ///< ‖Q(λ)φ‖ / ‖Kφ‖ [-]
    std::vector<double>          energy_residuals;                    ///< ε_res, eq. (16) of the paper [-]
    std::vector<double>          estimated_errors;                    ///< |δλ| / |λ| [-]; empty where the method gives none
    int                          n_rigid_body = 0;                    ///< modes with λ = 0
    std::vector<double>          real_values;                         ///< real λ ≠ 0, |λ| ≤ the band's radius, ascending [1/s]
    std::string                  summary;                             ///< how they were found, one phrase
  };

  /// Re xᴴy of corresponding complex vectors, columns 0 ... k-1 the real, k ... 2k-1 the imaginary parts.
  std::vector<double> complex_products(const MultiVector &X, const MultiVector &Y);

  /// Force residuals Q(λ) φ (or Q(λ)ᵀ φ) of complex vectors, kept alike.
  MultiVector force_residuals(const CoupledSystem                     &system,
                              const ParameterValues                   &values,
                              const std::vector<std::complex<double>> &lambda,
                              const MultiVector                       &real_part,
                              const MultiVector                       &imaginary_part,
                              bool                                     left = false);

  /**
   * Normalises right and left modes to φᴴ M_c φ = 1 with the entry of largest
   * modulus real (`eigen/phase.h`), sorts them by frequency, and computes both residuals:
   *
   *   ‖Q(λ)φ‖₂ / ‖K_c φ‖₂  and  ε_res = |R_Uᴴ R_F| / (φᴴ K φ),  R_F = Q(λ)φ,  R_U = K_c⁻¹ R_F
   *
   * (eqs. (14) to (16) of the paper). Where K_c is singular R_U uses the shifted stiffness of @p inverse.
   */
  void finish_modes(const CoupledSystem &system, const ParameterValues &values, const UpdatedInverse &inverse, ComplexModes &modes);
} // namespace Squeal
