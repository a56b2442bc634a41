#pragma once

#include <squeal/base/enum_table.h>

#include <string>
#include <tuple>
#include <vector>

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
    longitudinal
  };

  template <>
  inline constexpr EnumName<ModeFamily> enum_table<ModeFamily>[] = {
    {ModeFamily::unnamed, "unnamed"},   {ModeFamily::rigid_body, "RB"}, {ModeFamily::axial, "A"},     {ModeFamily::radial, "R"},
    {ModeFamily::circumferential, "C"}, {ModeFamily::flexural, "F"},    {ModeFamily::torsional, "T"}, {ModeFamily::longitudinal, "L"}};

  /// Which of the two modes of a doublet.
  enum class DoubletSign
  {
    none,
    minus,
    plus ///< the one that grows more, or has the higher frequency
  };

  /// Family, nodal circles, nodal diameters and rank: what the two modes of a doublet and the modes of pins that are alike have in common.
  using ModeShape = std::tuple<ModeFamily, int, int, int>;

  /// Identity of a mode: the component mode that it is, or resembles most.
  struct ModeLabel
  {
    ModeFamily  family          = ModeFamily::unnamed;
    int         nodal_circles   = 0; ///< of a disc mode
    int         nodal_diameters = 0; ///< of a disc mode
    int         rank            = 0; ///< of a pin mode: 1 for the lowest of its family
    DoubletSign sign            = DoubletSign::none;
    double      participation   = 0.; ///< Σ |ψᵀ M φ|² / φᴴ M φ over the component modes ψ of this shape [-]

    ModeShape shape() const
    {
      return {family, nodal_circles, nodal_diameters, rank};
    }

    bool is_of_pins() const
    {
      return rank > 0;
    }
  };

  /// Same shape and same sign.
  bool operator==(const ModeLabel &a, const ModeLabel &b);

  /// `A0-4 -`: family, nodal circles, nodal diameters, sign; `F1`: family and rank.
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
} // namespace Squeal
