// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/coupled_system.h>
#include <squeal/model/model.h>

#include <complex>
#include <vector>

namespace Squeal
{
  /**
   * Where the energy of a mode λ = R + iω comes from and where it goes: what each contact node and each body adds to the divergence
   * rate ξ = R / ω [-]. Positive parts feed the mode, negative ones take from it.
   *
   * Of Re(φ e^{iωt}) the mean energy is W = ¼ (|λ|² φᴴ M φ + φᴴ K φ), and a force f that acts on the velocity λ φ brings the mean power
   * P = ½ Re((λφ)ᴴ f). Multiplying the eigenproblem by λ̄ φᴴ shows that all powers together are 2 R W, as for an energy that grows like e^{2Rt}.
   * P / (2 ω W) is therefore what a force adds to ξ:
   *
   *   friction at a node     ½ μ Re((λ v)* r_n),   v = t·(u_D − u_P): of that the share on the disc has t·u_D, that on the pin −t·u_P
   *   damping at a node      −½ c_b |λ b·(u_D − u_P)|²  and  −½ c_t |λ v|²
   *   damping of a body      −½ Re((λu)ᴴ λ C u) over its dofs; gyroscopic forces bring nothing
   *   modal damping          −½ |λ|² φᴴ C_m φ, which belongs to no single body
   */
  struct PowerBalance
  {
    std::vector<double> into_disc, into_pins;            ///< by friction at each contact node [-]
    std::vector<double> radial_damping, sliding_damping; ///< at each contact node [-]
    std::vector<double> bodies;                          ///< damping of each component, the disc first [-]
    double              modal_damping = 0.;              ///< [-]

    /// By friction and damping at a contact node.
    double at(std::size_t node) const
    {
      return into_disc[node] + into_pins[node] + radial_damping[node] + sliding_damping[node];
    }

    /// ξ but for rounding and for the residual of the mode.
    double sum() const;
  };

  /**
   * @param bodies    M, C and K of the uncoupled bodies
   * @param coupled   the system whose mode it is
   * @param interface the closed pairs, and @p damping their coefficients
   * @param real_part, imaginary_part of φ in coupled coordinates, n × 1; all processes must call
   */
  PowerBalance power_balance(const SecondOrderSystem    &bodies,
                             const Model                &model,
                             const CoupledSystem        &coupled,
                             const ContactInterface     &interface,
                             const ContactDamping       &damping,
                             double                      friction_coefficient,
                             const std::complex<double> &lambda,
                             const MultiVector          &real_part,
                             const MultiVector          &imaginary_part);
} // namespace Squeal
