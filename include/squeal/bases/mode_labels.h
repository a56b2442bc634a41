// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/contact/contact_interface.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/model/model.h>

#include <optional>
#include <vector>

#include <string>
#include <tuple>

namespace Squeal
{
  /// What moves in a mode, and how.
  enum class ModeFamily
  {
    unnamed, ///< resembles none of the component modes left for it
    rigid_body,
    axial, ///< of the disc, by dominant kinetic energy
    radial,
    circumferential,
    flexural, ///< of pins, about the axis through their contact faces
    torsional,
    longitudinal,
    body ///< of another body, which gives it its name
  };

  template <>
  inline constexpr EnumName<ModeFamily> enum_table<ModeFamily>[] = {
    {ModeFamily::unnamed, "unnamed"}, {ModeFamily::rigid_body, "RB"},     {ModeFamily::axial, "A"},
    {ModeFamily::radial, "R"},        {ModeFamily::circumferential, "C"}, {ModeFamily::flexural, "F"},
    {ModeFamily::torsional, "T"},     {ModeFamily::longitudinal, "L"},    {ModeFamily::body, ""}};

  /// Which of the two modes of a doublet.
  enum class DoubletSign
  {
    none,
    minus,
    plus ///< the one that grows more, or has the higher frequency
  };

  /// Family, nodal circles, nodal diameters, rank and body: what the two modes of a doublet and the modes of pins that are alike have in common.
  using ModeShape = std::tuple<ModeFamily, int, int, int, std::string>;

  /// Identity of a mode: the component mode that it is, or resembles most.
  struct ModeLabel
  {
    ModeFamily  family          = ModeFamily::unnamed;
    int         nodal_circles   = 0; ///< of a disc mode
    int         nodal_diameters = 0; ///< of a disc mode
    int         rank            = 0; ///< of a mode of pins or another body: 1 for the lowest of its family
    DoubletSign sign            = DoubletSign::none;
    double      participation   = 0.; ///< Σ |ψᵀ M φ|² / φᴴ M φ over the component modes ψ of this shape [-]
    std::string body            = {}; ///< of ModeFamily::body

    ModeShape shape() const
    {
      return {family, nodal_circles, nodal_diameters, rank, body};
    }
  };

  /// Same shape and same sign.
  bool operator==(const ModeLabel &a, const ModeLabel &b);

  /// `A0-4 -`: family, nodal circles, nodal diameters, sign; `F1`: family and rank; `pad_outer 3`: body and rank.
  std::string to_string(const ModeLabel &label);

  /// The same without blanks and signs: `A0-4_minus`.
  std::string file_text(const ModeLabel &label);

  /// The shape alone: `A0-4`.
  std::string shape_text(ModeLabel label);

  /**
   * Gives signs to labels whose shape occurs exactly twice, but for unnamed modes. Plus is the mode that grows, or grows
   * more; where neither grows, the one of the higher frequency. That is the rule for every table of every study.
   *
   * @param labels       of modes in the order of their frequencies
   * @param growth_rates of each mode, zero for one that does not grow [any unit]; empty: none grows
   */
  void mark_doublets(std::vector<ModeLabel> &labels, const std::vector<double> &growth_rates = {});

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
   * Names of modes of all bodies but the disc. Those of a body whose name begins with `pin_`: F flexural, T torsional, L longitudinal about the axis
   * through the centre of each pin's contact nodes along its normal, by the
   * larger energy, numbered in ascending order of frequency: the first two F
   * modes of every pin are F1. Of any other body, by the larger kinetic energy: its name, and its number among those of the body. Modes must
   * come in that order.
   */
  std::vector<ModeLabel> pin_labels(const Model               &model,
                                    const ContactInterface    &interface,
                                    const std::vector<double> &nodal_masses,
                                    const MultiVector         &modes);
} // namespace Squeal
