#pragma once

#include <squeal/bases/mode_label.h>
#include <squeal/output/table.h>
#include <squeal/stability/branches.h>

#include <vector>

namespace Squeal
{
  /// Every mode of the band at every point of a chart, refined ones included: its branch, λ, residuals, error, verdict and whether λ grows.
  Table branch_table(const StabilityChart &chart, const std::vector<ModeLabel> &labels, double largest_circular_frequency);

  /// Where branches begin or cease to grow.
  Table threshold_table(const StabilityChart &chart, const std::vector<ModeLabel> &labels);

  /// Where branches enter or leave the band.
  Table crossing_table(const StabilityChart &chart, const std::vector<ModeLabel> &labels);

  /// Modes in the band at every point, and how many crossings let expect.
  Table count_table(const StabilityChart &chart);

  /// Points at which the number of modes is not the expected one.
  std::size_t n_incomplete(const StabilityChart &chart);
} // namespace Squeal
