#pragma once

#include <squeal/output/table.h>
#include <squeal/studies/friction_modes.h>

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
   */
  Table complex_table(const FrictionModes &friction, const std::vector<std::optional<WaveShares>> &waves);

  /**
   * The modes that grow, the largest divergence rate first: label, frequency, growth and divergence rate, share. At most
   * @p n_largest rows.
   */
  Table unstable_table(const FrictionModes &friction, std::size_t n_largest);
} // namespace Squeal
