#pragma once

#include <squeal/bases/mode_label.h>
#include <squeal/contact/contact_interface.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/model/model.h>

#include <optional>
#include <vector>

namespace Squeal
{
  /**
   * Names of disc modes from their Fourier content about the axis (section 4.1
   * of the paper): A, R or C for dominant axial, radial or circumferential
   * kinetic energy, then nodal circles m and nodal diameters n: `A0-4`. Of each
   * displacement component the content of a harmonic n is the energy of its
   * least-squares projection on { r^k cos nθ, r^k sin nθ }, k = 0 ... 4, weighted
   * by nodal masses; nodal circles are the sign changes of the radial profile
   * of the dominant harmonic.
   *
   * Each process projects the nodes whose rows it has; all must call.
   *
   * @param modes        n_free × k displacements
   * @param nodal_masses of nodal_masses() [kg]
   */
  std::vector<ModeLabel> disc_labels(const Model &model, const std::vector<double> &nodal_masses, const MultiVector &modes);

  /// Parts of a disc mode that travel about the axis, of the energy of both; 0.5 each in a standing wave [-].
  struct WaveShares
  {
    double positive; ///< along +e_θ
    double negative; ///< along -e_θ
  };

  /**
   * How disc modes travel. Of the component that names the mode (axial, radial or circumferential) the harmonic n of its label is
   * projected as for disc_labels(),
   *
   *   φ = a(r) cos nθ + b(r) sin nθ = ½ (a + ib) e^{-inθ} + ½ (a - ib) e^{inθ}.
   *
   * With u = Re(φ e^{λt}) and ω = Im λ > 0 the first part depends on ωt - nθ and travels along +e_θ with the speed ω/n, the
   * second one along -e_θ. The shares are those of Σ m |a ± ib|² over the nodes. Nothing for modes without such a label: of
   * pins, without nodal diameters, unnamed.
   *
   * @param labels         of the modes
   * @param real_part      n_free × k displacements
   * @param imaginary_part n_free × k
   */
  std::vector<std::optional<WaveShares>> wave_shares(const Model                  &model,
                                                     const std::vector<double>    &nodal_masses,
                                                     const std::vector<ModeLabel> &labels,
                                                     const MultiVector            &real_part,
                                                     const MultiVector            &imaginary_part);

  /**
   * Names of pin modes: F flexural, T torsional, L longitudinal about the axis
   * through the centre of each pin's contact nodes along its normal, by the
   * larger energy, numbered in ascending order of frequency: the first two F
   * modes of every pin are F1. Modes must come in that order.
   */
  std::vector<ModeLabel> pin_labels(const Model               &model,
                                    const ContactInterface    &interface,
                                    const std::vector<double> &nodal_masses,
                                    const MultiVector         &modes);
} // namespace Squeal
