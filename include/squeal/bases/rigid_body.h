// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/factorization.h>
#include <squeal/system/terms.h>
#include <squeal/contact/coupled_system.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/model/model.h>

#include <optional>

#include <memory>
#include <string>

namespace Squeal
{
  /// ω_max / s for the shift s in K + s² M [-]. The shift limits the amplification of low-frequency motions, and of their rounding errors,
  /// to about 50² relative to a mode at ω_max.
  inline constexpr double band_per_stabilizing_shift = 50.;

  /// Translations along and rotations about x, y and z of one component, n × 6 on the uncoupled dofs; other components are at rest.
  MultiVector rigid_motions(const Model &model, unsigned int component);

  /// The six rigid-body motions of the disc in coupled coordinates, n × 6; pins move only where the contact constraints require it.
  MultiVector rigid_disc_motions(const Model &model, const CoupledSystem &system);

  /// Rigid-body motions of an uncoupled body that its mounts do not resist (up to rounding errors of K), M-orthonormal; empty if mounts
  /// resist all motions, or if the body has clamped nodes.
  std::optional<MultiVector> free_motions(const Model &model, const SecondOrderSystem &system, unsigned int component);

  /// Rigid-body motions, M-orthonormal, split by their effect on the contact nodes.
  struct ContactMotions
  {
    std::optional<MultiVector> pressing; ///< change gaps: move contact nodes along the normals
    std::optional<MultiVector> sliding;  ///< do not change any gap
  };

  /**
   * Splits the M-orthonormal rigid-body motions N = @p motions, n × k, by the singular values of P_n N, P_n = @p normal. A motion is
   * sliding if its normal displacement (root mean square over the contact nodes) is below 10⁻⁸ of the largest displacement, the level of
   * rounding errors. The result is identical on all processes.
   */
  ContactMotions contact_motions(const SparseMatrix &normal, const MultiVector &motions);

  /**
   * Shift s ≥ 0 [rad/s] that makes K_c + s² M_c positive definite and well conditioned: zero if the smallest Rayleigh quotient of K_c and
   * M_c on the rigid-body motions of the disc exceeds (ω_max / 50)², else ω_max / 50.
   */
  double stabilizing_shift(const Model &model, const CoupledSystem &system, double largest_circular_frequency);

  /// Shift for the disc alone; @p system has M and K on the uncoupled dofs.
  double stabilizing_shift(const Model &model, const SecondOrderSystem &system, double largest_circular_frequency);

  /**
   * Solves K u = f for blocks of forces, where K is symmetric positive semidefinite and its kernel N of rigid-body motions is known. If N
   * is not empty, inertia relief applies,
   *
   *   K u = f − M N Nᵀf,   NᵀM u = 0,   NᵀM N = 1,
   *
   * which is solved by a factor of K + s² M and iterative refinement.
   */
  class InertiaRelief
  {
  public:
    /**
     * @param rigid_body N, n × k, M-orthonormal; empty if K is positive definite
     * @param largest_circular_frequency end of the band [rad/s]: sets the shift s
     * @param what       name of the body with stiffness K, for messages
     *
     * Throws SolverError if K (or K + s² M) is not positive definite.
     */
    InertiaRelief(std::shared_ptr<const SparseMatrix> stiffness,
                  std::shared_ptr<const SparseMatrix> mass,
                  const std::optional<MultiVector>   &rigid_body,
                  double                              largest_circular_frequency,
                  FactorizationLibrary                library,
                  std::string                         what);

    /// u for every column of @p forces. Throws SolverError if the refinement fails.
    MultiVector solve(const MultiVector &forces) const;

    /// N; null if K is positive definite.
    const MultiVector *rigid_body_modes() const
    {
      return N.get();
    }

  private:
    std::shared_ptr<const SparseMatrix> K;
    std::unique_ptr<MultiVector>        N, MN;
    std::unique_ptr<Factorization>      factor;
    std::string                         what;
  };

  /**
   * Static responses of the uncoupled bodies, K u = f: f = P_nᵀ or P_tᵀ gives the normal and tangential attachment modes of disc and pins
   * (section 5.1 of the paper). K is block diagonal, so that one factorisation is sufficient for all components.
   *
   * @param largest_circular_frequency end of the band [rad/s], for the shift of a disc that can move freely
   *
   * Throws SolverError if K (or K + s² M) is not positive definite.
   */
  InertiaRelief static_response(const Model             &model,
                                const SecondOrderSystem &system,
                                double                   largest_circular_frequency,
                                FactorizationLibrary     library);

  /// K⁻¹ Pᵀ, n × n_c: responses to opposite unit forces on disc and pin at each contact node, along the direction of P [m/N].
  MultiVector attachment_modes(const InertiaRelief &response, const SparseMatrix &P);
} // namespace Squeal
