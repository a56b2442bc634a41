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
  /// dK/dp and dM/dp of the uncoupled bodies: sums of matrices with their factors.
  struct BodyRates
  {
    using Sum = std::vector<std::pair<double, std::shared_ptr<const SparseMatrix>>>;
    Sum stiffness, mass;

    /// Adds the derivatives of the symmetric terms along a direction of their parameters.
    void add_along(const std::vector<Term> &terms, const ParameterValues &values, const ParameterValues &rates);

    /// Adds the symmetric terms themselves.
    void add(const std::vector<Term> &terms, const ParameterValues &values);
  };

  /**
   * Derivatives of the modal damping C_m = M_c Φ diag(d) Φᵀ M_c, d_j = 2 ζ_j ω_j, whose modes change with K_c and M_c.
   *
   * C_m = M_c g(M_c⁻¹ K_c) is a function of matrices, with g(ω_j²) = d_j for damped modes and zero for all others. With K' and M'
   * between real modes i, j of all frequencies (Yu. L. Daletskii, S. G. Krein, *Integration and differentiation of functions of
   * Hermitian operators*, 1956), β_ij = (ω_i² + ω_j²)/2 and the divided difference g_ij = (d_i − d_j)/(ω_i² − ω_j²), g'(ω²) where both
   * are equal,
   *
   *   φ_iᵀ C_m' φ_j = (φ_iᵀ K' φ_j − β_ij φ_iᵀ M' φ_j) g_ij + (d_i + d_j)/2 φ_iᵀ M' φ_j
   *
   * Equal frequencies need no care, since g is smooth, nor do pairs of undamped modes, which vanish. Those of a damped mode and one beyond the
   * modes that are known are found in a Krylov space of (K_c + s² M_c)⁻¹ M_c from what the vectors have outside of the known ones.
   */
  class ModalDampingDerivatives
  {
  public:
    /**
     * @param undamped system of which Φ are modes: its stiffness, mass and kernel. Must outlive this object, as inverse and modes must
     * @param inverse  (K_c + s² M_c)⁻¹
     * @param modes    all in the band and its margin
     * @param n_damped the first so many are damped. Throws SolverError if they end between modes of equal frequency
     */
    ModalDampingDerivatives(const CoupledSystem     &undamped,
                            const LinearOperator    &inverse,
                            const SymmetricModes    &modes,
                            const DampingParameters &damping,
                            int                      n_damped);

    /// ψ_iᵀ (dC_m/dp) φ_j along each direction, k × k, of coupled vectors. All processes must call.
    std::vector<ComplexDenseMatrix> along(const std::vector<BodyRates> &directions, const Eigentriples &vectors) const;

    /// d(2 ζ_j ω_j)/dζ of the entry @p number of the list of ratios, one for each damped mode [rad/s].
    std::vector<double> rates_of_ratio(int number) const;

  private:
    /// Φᵀ X Φ of Σ X.
    DenseMatrix between_modes(const BodyRates::Sum &sum) const;

    const CoupledSystem    &system;
    const LinearOperator   &inverse;
    const SymmetricModes   &modes;
    const DampingParameters damping;
    const int               n_damped;
    std::vector<double>     d;              ///< of each known mode [rad/s]; zero if it is not damped
    MultiVector             M_modes, apart; ///< M_c Φ, and T_c Φ on the dofs of the bodies
    DenseMatrix             g;              ///< g_ij of known modes [s/rad]

    mutable std::map<std::shared_ptr<const SparseMatrix>, DenseMatrix> forms; ///< Φᵀ X Φ, as they are wanted
  };
} // namespace Squeal
