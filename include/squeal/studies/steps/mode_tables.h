#pragma once

#include <squeal/estimates/discretisation_error.h>
#include <squeal/output/table.h>
#include <squeal/parameters/accuracy_goal.h>
#include <squeal/studies/steps/friction_modes.h>

#include <optional>
#include <vector>

namespace Squeal
{
  /// Component modes below ω² = @p largest_eigenvalue: component, contact, label, frequency, residual.
  Table component_table(const FrictionlessModes &modes, double largest_eigenvalue);

  /// Real coupled modes: label, share, frequency, residual.
  Table real_table(const FrictionlessModes &modes);

  /**
   * Complex modes: label, share, frequency, growth and divergence rate, damping ratio, residuals, whether they are
   * unstable, how they travel, and estimates where there are any.
   *
   * @param waves of waves_with_rotation()
   * @param more  columns by the numbers of the modes
   */
  Table complex_table(const FrictionModes &friction, const std::vector<std::optional<WaveShares>> &waves, const Columns<int> &more = {});

  /// Columns that estimated errors of the mesh add to complex_table(): those, whether they are within @p limits, and the verdict.
  Columns<int> mesh_error_columns(const std::vector<DiscretisationError> &errors, const AccuracyLimits &limits);

  /**
   * The modes that grow, the largest divergence rate first: label, frequency, growth and divergence rate, share. At most
   * @p n_largest rows.
   */
  Table unstable_table(const FrictionModes &friction, std::size_t n_largest);
} // namespace Squeal
