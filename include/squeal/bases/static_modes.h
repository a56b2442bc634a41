// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/bases/component_modes.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/contact/updated_inverse.h>

#include <array>
#include <memory>
#include <optional>

namespace Squeal
{
  /**
   * Static boundary modes of disc and pins on the uncoupled dofs, one column for each contact node (sections 5.1 and 6.1 of the paper).
   * Sets that are returned by reference are computed on first use and stored. The arguments must outlive this object.
   *
   * For a disc with rigid-body motions that its mounts do not resist, inertia relief applies: attachment modes are complete only together
   * with InertiaRelief::rigid_body_modes().
   */
  class StaticModes
  {
  public:
    /// @param largest_circular_frequency end of the band [rad/s], see static_response()
    StaticModes(const Model             &model,
                const ContactInterface  &interface,
                const ContactOperators  &contact,
                const SecondOrderSystem &system,
                const InertiaRelief     &response,
                double                   largest_circular_frequency,
                FactorizationLibrary     library);

    /// Ψ_an^D − Ψ_an^P = K⁻¹ P_nᵀ: responses to unit normal forces, +n on the disc and −n on the pins [m/N], n × n_c.
    const MultiVector &normal_attachment() const;

    /// Ψ_at^D − Ψ_at^P = K⁻¹ P_tᵀ: responses to unit forces along t [m/N], n × n_c.
    const MultiVector &tangential_attachment() const;

    /// Ψ_an^D or Ψ_an^P: responses of one component to unit forces along n; the other component is at rest.
    MultiVector normal_attachment(Component component) const;

    /// Ψ_aμ^D − Ψ_aμ^P = K⁻¹ (P_nᵀ + μ P_tᵀ), eq. (23): responses to unit normal forces with the corresponding friction r_t = μ r_n.
    MultiVector rubbing_attachment(double friction_coefficient) const;

    /**
     * Ψ_cn^D or Ψ_cn^P: responses of one component to a unit displacement n·u = 1 of one of its contact nodes, with n·u = 0 at its other
     * contact nodes and free tangential displacements [-], n × n_c; P_n Ψ_cn^D = I and P_n Ψ_cn^P = −I. If the disc still has rigid-body
     * motions, the responses are M-orthogonal to these motions.
     *
     * Throws SolverError if the stiffness of the component with sliding contact is singular for another reason.
     */
    const MultiVector &constraint(Component component) const;

    const InertiaRelief &response; ///< static response, with the rigid-body motions of the uncoupled disc

  private:
    MultiVector constraint_modes(Component component) const;

    const Model                                        &model;
    const ContactInterface                             &interface;
    const ContactOperators                             &contact;
    const SecondOrderSystem                            &system;
    double                                              largest_circular_frequency;
    FactorizationLibrary                                library;
    mutable std::unique_ptr<MultiVector>                normal, tangential;
    mutable std::array<std::unique_ptr<MultiVector>, 2> constraints;
  };

  /// Right or left eigenvector of a nonsymmetric problem.
  enum class Side
  {
    right,
    left
  };

  /**
   * First-order responses of real coupled modes Φ_R to friction, n × n_R, in coupled coordinates, without the factor μ:
   *
   * right  K_c⁻¹ A V_K Φ_R,    eq. (25), with the static part of the friction forces
   * left   K_c⁻¹ V_Kᵀ Aᵀ Φ_R,  the same for the transposed problem
   *
   * If @p inverse has a shift s, S = K_c + s C_c + s² M_c replaces K_c.
   */
  MultiVector friction_response(const CoupledSystem &system, const UpdatedInverse &inverse, const MultiVector &real_modes, Side side);

  /// First-order responses of real coupled modes Φ_R to damping, K_c⁻¹ (C_c − μ A V_C) Φ_R, n × n_R, at the given friction coefficient or
  /// else at the parameter values of the system. Throws SolverError if there is no damping.
  MultiVector damping_response(const CoupledSystem  &system,
                               const UpdatedInverse &inverse,
                               const MultiVector    &real_modes,
                               std::optional<double> friction_coefficient = {});
} // namespace Squeal
