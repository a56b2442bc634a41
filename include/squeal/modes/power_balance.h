// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/coupled_system.h>
#include <squeal/model/model.h>

#include <complex>
#include <vector>

namespace Squeal
{
  /**
   * Energy balance of a mode λ = R + iω: contribution of each contact node and body to the divergence rate ξ = R / ω [-]. Positive
   * contributions feed energy into the mode, negative contributions dissipate energy.
   *
   * The motion Re(φ e^{iωt}) has the mean energy W = ¼ (|λ|² φᴴ M φ + φᴴ K φ), and a force f has the mean power P = ½ Re((λφ)ᴴ f).
   * Multiplying the eigenproblem by λ̄ φᴴ shows that the sum of all powers is 2 R W, as for an energy that grows as e^{2Rt}. The
   * contribution of a force to ξ is therefore P / (2 ω W):
   *
   *   friction at a node     ½ μ Re((λ v)* r_n),   v = f t·(u_D − u_P); f t·u_D gives the disc's part, −f t·u_P the pin's part
   *   damping at a node      −½ c_b |λ b·(u_D − u_P)|²  and  −½ c_t |λ v|²
   *   damping of a body      −½ Re((λu)ᴴ λ C u) over its dofs; gyroscopic forces do no work
   *   modal damping          −½ |λ|² φᴴ C_m φ, not attributed to a body
   */
  struct PowerBalance
  {
    std::vector<double> into_disc, into_pins;            ///< contribution of friction at each contact node [-]
    std::vector<double> radial_damping, sliding_damping; ///< contribution of damping at each contact node [-]
    std::vector<double> bodies;                          ///< contribution of damping in each component, the disc first [-]
    double              modal_damping = 0.;              ///< [-]

    /// Contribution of friction and damping at a contact node [-].
    double at(std::size_t node) const
    {
      return into_disc[node] + into_pins[node] + radial_damping[node] + sliding_damping[node];
    }

    /// Sum of all contributions: ξ up to rounding and the residual of the mode.
    double sum() const;
  };

  /**
   * @param bodies    M, C and K of the uncoupled bodies
   * @param coupled   system of the mode
   * @param interface closed contact nodes, with the coefficients @p damping
   * @param real_part, imaginary_part φ in coupled coordinates, n × 1
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
