#pragma once

#include <squeal/output/table.h>
#include <squeal/studies/paper_table.h>

#include <optional>
#include <vector>

namespace Squeal
{
  /// A complex mode as the statements of the paper speak of it.
  struct StatedMode : ComparedMode
  {
    bool                      unstable = false;
    std::optional<WaveShares> waves    = {}; ///< of disc modes, with regard to the rotation
  };

  std::vector<StatedMode> stated_modes(const FrictionModes &friction, const std::vector<std::optional<WaveShares>> &waves);

  /// What a run knows of the subjects of section 4; modes in the order of their frequencies, below 5 kHz.
  struct SectionFour
  {
    std::vector<ComparedMode> component, coupled;
    std::vector<StatedMode>   undamped, damped; ///< complex modes without and with C_b
    std::vector<int>          becomes;          ///< which mode with C_b each one without becomes; see followed_modes()
    unsigned int              n_pins = 0;
  };

  /**
   * Which mode of @p to each of @p from becomes: one of its own for each, so that the sum of
   *
   *   MAC-M = |φᴴ M φ̂|² / (φᴴ M φ  φ̂ᴴ M φ̂),      eq. (18) of the paper,
   *
   * is largest. Both sets belong to the system of @p frictionless but for its damping and have equally many modes.
   */
  std::vector<int> followed_modes(const FrictionlessModes &frictionless, const FrictionModes &from, const FrictionModes &to);

  /**
   * Section 4 of the paper statement by statement: its words, shortened, its number, the number here, and whether the
   * statement holds, holds less or does not hold, by a rule that stands beside it. Numbers of the paper are those that it prints, or
   * follow from two that it prints. Modes whose divergence rates are below 0.01 % count as neutral, as `negligible` ones do in Table 1.
   * Statements on modes that the run does not have are left out.
   *
   * @param with_rules whether columns tell the rules and the modes of which a statement speaks
   */
  Table statements(const SectionFour &results, bool with_rules = true);
} // namespace Squeal
