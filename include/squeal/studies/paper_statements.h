#pragma once

#include <squeal/output/table.h>
#include <squeal/studies/stated_modes.h>

#include <vector>

namespace Squeal
{
  /// What a run knows of the subjects of section 4; modes in the order of their frequencies, below 5 kHz.
  struct SectionFour
  {
    std::vector<ComparedMode> component, coupled;
    std::vector<StatedMode>   undamped, damped; ///< complex modes without and with C_b
    GrowthKept                kept;             ///< what the growing ones of both have in common
    unsigned int              n_pins = 0;
  };

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
