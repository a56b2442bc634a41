#pragma once

#include <squeal/output/fields.h>
#include <squeal/studies/steps/power_results.h>

#include <string>

namespace Squeal
{
  /// What a mode file says of a complex mode: "A0-4 +, 2353 Hz, divergence rate 0.6798 %, unstable".
  std::string mode_title(const ModeLabel &label, const std::complex<double> &lambda);

  /// How the parameters want modes to be animated.
  AnimationOptions animation_options(const OutputParameters &output);

  /**
   * The fields that the parameters choose, in their format, as steps of the run: complex modes with animations of unstable ones, real
   * coupled modes, component modes; where the energy of growing ones enters; and of each kind a list through which ParaView steps. Files bear the numbers of the rows of
   * `complex_modes.csv`, `real_modes.csv` and `component_modes.csv`.
   */
  void write_mode_shapes(const FrictionlessModes &frictionless, const FrictionModes &friction, const PowerBalances &balances, Run &run);
} // namespace Squeal
