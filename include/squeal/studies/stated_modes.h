#pragma once

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

  /// Whether a mode is unstable and not negligibly so: its divergence rate is at least 0.01 %.
  bool grows(const StatedMode &mode);

  /**
   * What growing modes have in common that belong to the same system but for its damping: principal angles of the two spans
   * in the M-inner product, and how much of each mode lies in the other span, ‖Pφ‖² / ‖φ‖². Spans do not depend on how modes of
   * nearly the same eigenvalue are told apart, which one-to-one matches by MAC-M do.
   */
  struct GrowthKept
  {
    std::size_t         n_kept = 0;                ///< principal angles of at most 45°
    std::vector<double> share_before, share_after; ///< of each mode, growing or not, in the span of the other growing ones [-]
  };

  /// Both sets belong to the system of @p frictionless but for its damping. All processes must call.
  GrowthKept growth_kept(const FrictionlessModes       &frictionless,
                         const FrictionModes           &before,
                         const std::vector<StatedMode> &stated_before,
                         const FrictionModes           &after,
                         const std::vector<StatedMode> &stated_after);
} // namespace Squeal
