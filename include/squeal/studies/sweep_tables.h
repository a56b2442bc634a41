#pragma once

#include <squeal/output/table.h>
#include <squeal/studies/sweep_results.h>

#include <vector>

namespace Squeal
{
  /// Every mode of the band at every point of a chart, refined ones included: its branch, λ, residuals, error, verdict and whether λ grows.
  Table branch_table(const SweepChart &line, double largest_circular_frequency);

  /// Where branches begin or cease to grow.
  Table threshold_table(const SweepChart &line);

  /// Where branches enter or leave the band.
  Table crossing_table(const SweepChart &line);

  /// Modes in the band at every point, and how many the crossings imply.
  Table count_table(const StabilityChart &chart);

  /// Stability over the friction coefficient and the load or speed.
  Table map_table(std::vector<MapCell> cells, MapParameter parameter);

  /// Numbers of modes beside those of the argument principle.
  Table argument_table(const std::vector<CountAt> &counts);

  /// Contact sets along the lines: where they change.
  Table contact_table(const SweepPlan &plan, std::size_t n_pairs);
} // namespace Squeal
