// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/coupled_system.h>
#include <squeal/eigen/symmetric_modes.h>
#include <squeal/parameters/materials.h>
#include <squeal/sensitivity/eigenvalue_derivatives.h>

#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace Squeal
{
  /// dK/dp and dM/dp of the uncoupled bodies: sums of matrices with factors.
  struct BodyRates
  {
    using Sum = std::vector<std::pair<double, std::shared_ptr<const SparseMatrix>>>;
    Sum stiffness, mass;

    /// Adds the derivatives of the symmetric terms along a direction of the parameters.
    void add_along(const std::vector<Term> &terms, const ParameterValues &values, const ParameterValues &rates);

    /// Adds the symmetric terms themselves.
    void add(const std::vector<Term> &terms, const ParameterValues &values);
  };

  /**
   * Derivatives of the modal damping C_m = M_c Φ diag(d) Φᵀ M_c, d_j = 2 ζ_j ω_j, including the change of the modes with K_c and M_c.
   *
   * C_m = M_c g(M_c⁻¹ K_c) is a matrix function with g(ω_j²) = d_j for damped modes and zero for all others. With K' and M' between real
   * modes i, j of all frequencies (Yu. L. Daletskii, S. G. Krein, *Integration and differentiation of functions of Hermitian operators*,
   * 1956), β_ij = (ω_i² + ω_j²)/2 and the divided difference g_ij = (d_i − d_j)/(ω_i² − ω_j²), or g'(ω²) for equal frequencies,
   *
   *   φ_iᵀ C_m' φ_j = (φ_iᵀ K' φ_j − β_ij φ_iᵀ M' φ_j) g_ij + (d_i + d_j)/2 φ_iᵀ M' φ_j
   *
   * The formula also holds for multiple eigenvalues. Pairs of undamped modes contribute nothing. Contributions of a damped
   * mode and modes beyond the computed modes are found in a Krylov space of (K_c + s² M_c)⁻¹ M_c, started from the components of the
   * vectors outside the computed modes.
   */
  class ModalDampingDerivatives
  {
  public:
    /**
     * @param undamped stiffness, mass and kernel of the system with the modes Φ; must outlive this object, like inverse and modes
     * @param inverse  (K_c + s² M_c)⁻¹
     * @param modes    all modes in the band and its margin
     * @param n_damped number of damped modes, which are the lowest modes. Throws SolverError if the next mode has the same
     *                 frequency as the last damped mode
     */
    ModalDampingDerivatives(const CoupledSystem     &undamped,
                            const LinearOperator    &inverse,
                            const SymmetricModes    &modes,
                            const DampingParameters &damping,
                            int                      n_damped);

    /// ψ_iᵀ (dC_m/dp) φ_j along each direction, k × k, for coupled vectors. Collective.
    std::vector<ComplexDenseMatrix> along(const std::vector<BodyRates> &directions, const Eigentriples &vectors) const;

    /// d(2 ζ_j ω_j)/dζ for entry @p number of the list of ratios, one value for each damped mode [rad/s].
    std::vector<double> rates_of_ratio(int number) const;

  private:
    /// Φᵀ X Φ for X = Σ factor X_i.
    DenseMatrix between_modes(const BodyRates::Sum &sum) const;

    const CoupledSystem    &system;
    const LinearOperator   &inverse;
    const SymmetricModes   &modes;
    const DampingParameters damping;
    const int               n_damped;
    std::vector<double>     d;              ///< d_j of each computed mode [rad/s]; zero if undamped
    MultiVector             M_modes, apart; ///< M_c Φ, and T_c Φ on the dofs of the bodies
    DenseMatrix             g;              ///< g_ij of computed modes [s/rad]

    mutable std::map<std::shared_ptr<const SparseMatrix>, DenseMatrix> forms; ///< Φᵀ X Φ, computed on demand
  };
} // namespace Squeal
