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
  /// Family of a mode: the body that moves most, and its type of motion.
  enum class ModeFamily
  {
    unnamed, ///< similar to none of the component modes that are still available
    rigid_body,
    axial, ///< disc modes: direction of the dominant kinetic energy
    radial,
    circumferential,
    flexural, ///< pin modes: type of motion relative to the axis through the contact face
    torsional,
    longitudinal,
    body ///< mode of another body, named after the body
  };

  template <>
  inline constexpr EnumName<ModeFamily> enum_table<ModeFamily>[] = {
    {ModeFamily::unnamed, "unnamed"}, {ModeFamily::rigid_body, "RB"},     {ModeFamily::axial, "A"},
    {ModeFamily::radial, "R"},        {ModeFamily::circumferential, "C"}, {ModeFamily::flexural, "F"},
    {ModeFamily::torsional, "T"},     {ModeFamily::longitudinal, "L"},    {ModeFamily::body, ""}};

  /// Member of a doublet.
  enum class DoubletSign
  {
    none,
    minus,
    plus ///< faster growth or higher frequency
  };

  /// Family, nodal circles, nodal diameters, rank and body: common to both modes of a doublet, or to the same mode of identical pins.
  using ModeShape = std::tuple<ModeFamily, int, int, int, std::string>;

  /// Label of a mode, usually of the component mode that it resembles most.
  struct ModeLabel
  {
    ModeFamily  family          = ModeFamily::unnamed;
    int         nodal_circles   = 0; ///< for disc modes
    int         nodal_diameters = 0; ///< for disc modes
    int         rank            = 0; ///< modes of pins or other bodies: 1 for the lowest mode of the family
    DoubletSign sign            = DoubletSign::none;
    double      participation   = 0.; ///< Σ |ψᵀ M φ|² / φᴴ M φ over the component modes ψ of this shape [-]
    std::string body            = {}; ///< name of the body, for ModeFamily::body only

    ModeShape shape() const
    {
      return {family, nodal_circles, nodal_diameters, rank, body};
    }
  };

  /// True for labels of equal shape and sign.
  bool operator==(const ModeLabel &a, const ModeLabel &b);

  /// `A0-4 -`: family, nodal circles, nodal diameters, sign; `F1`: family and rank; `pad_outer 3`: body and rank.
  std::string to_string(const ModeLabel &label);

  /// Label without blanks and signs, for file names: `A0-4_minus`.
  std::string file_text(const ModeLabel &label);

  /// Text of the shape without sign: `A0-4`.
  std::string shape_text(ModeLabel label);

  /**
   * Assigns signs to labels whose shape occurs exactly twice, except unnamed modes. The sign is plus for the mode that grows or grows
   * faster or, if neither grows, for the mode with the higher frequency.
   *
   * @param labels       labels of modes in ascending order of frequency
   * @param growth_rates one for each mode, zero if the mode does not grow [any unit]; empty: no mode grows
   */
  void mark_doublets(std::vector<ModeLabel> &labels, const std::vector<double> &growth_rates = {});

  /**
   * Labels disc modes by their Fourier content about the axis (section 4.1 of the paper): A, R or C for dominant axial, radial or
   * circumferential kinetic energy, then nodal circles m and nodal diameters n: `A0-4`. The content of harmonic n in a displacement
   * component is the energy of its least-squares projection on { r^k cos nθ, r^k sin nθ }, k = 0 ... 4, weighted by nodal masses; nodal
   * circles are the sign changes of the radial profile of the dominant harmonic.
   *
   * Each process projects the nodes whose rows it owns. Collective.
   *
   * @param modes        n_free × k displacements
   * @param nodal_masses see nodal_masses() [kg]
   */
  std::vector<ModeLabel> disc_labels(const Model &model, const std::vector<double> &nodal_masses, const MultiVector &modes);

  /// Energy fractions of the two travelling waves of a disc mode; 0.5 each for a standing wave [-].
  struct WaveShares
  {
    double positive; ///< share of the wave along +e_θ
    double negative; ///< share of the wave along -e_θ
  };

  /**
   * Travelling waves in disc modes. Harmonic n of the label of a mode is projected as in disc_labels(), from the displacement component of
   * its family (axial, radial or circumferential):
   *
   *   φ = a(r) cos nθ + b(r) sin nθ = ½ (a + ib) e^{-inθ} + ½ (a - ib) e^{inθ}.
   *
   * With u = Re(φ e^{λt}) and ω = Im λ > 0, the first part depends on ωt - nθ and travels along +e_θ with the angular speed ω/n, the second
   * part along -e_θ. The shares are the fractions of Σ m |a ± ib|² over the nodes. Empty for pin modes, unnamed modes and modes without
   * nodal diameters.
   *
   * @param labels         labels of the modes
   * @param real_part      n_free × k displacements
   * @param imaginary_part n_free × k
   */
  std::vector<std::optional<WaveShares>> wave_shares(const Model                  &model,
                                                     const std::vector<double>    &nodal_masses,
                                                     const std::vector<ModeLabel> &labels,
                                                     const MultiVector            &real_part,
                                                     const MultiVector            &imaginary_part);

  /**
   * Labels modes of all bodies except the disc. Modes of bodies `pin_*` are F (flexural), T (torsional) or L (longitudinal), after the
   * motion with the largest energy. The axis of a pin is the mean normal through the centre of its contact nodes. Each family is numbered
   * in ascending order of frequency: with n pins, the first 2n F modes are F1, and the first n T modes are T1. Modes of other bodies have
   * the name of the body with the largest kinetic energy, and their number among its modes. Modes must be in ascending order of frequency.
   */
  std::vector<ModeLabel> pin_labels(const Model               &model,
                                    const ContactInterface    &interface,
                                    const std::vector<double> &nodal_masses,
                                    const MultiVector         &modes);
} // namespace Squeal
