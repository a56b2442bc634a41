#pragma once

#include <squeal/studies/sensitivity/sensitivity_results.h>

namespace Squeal
{
  /// One row for each mode and parameter.
  Table mode_sensitivity_table(const std::vector<ModeSensitivity> &modes, const std::vector<SensitivityParameter> &parameters);

  /// One row for each threshold and parameter; one for a threshold without derivatives.
  Table threshold_sensitivity_table(const std::vector<ThresholdSensitivity> &thresholds,
                                    const SweepChart                        &chart,
                                    const std::vector<SensitivityParameter> &parameters);

  /// Parameters by how far one per cent of them changes the divergence rate of a mode; at most @p most rows, 0: all. Single pins apart on request.
  Table ranking_table(const ModeSensitivity                   &mode,
                      const std::vector<SensitivityParameter> &parameters,
                      bool                                     with_single_pins,
                      std::size_t                              most);
} // namespace Squeal
