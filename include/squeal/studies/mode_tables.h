#pragma once

#include <squeal/bases/component_modes.h>
#include <squeal/output/table.h>
#include <squeal/sliding/steady_sliding.h>
#include <squeal/stability/complex_modes.h>
#include <squeal/studies/friction_modes.h>
#include <squeal/studies/frictionless_modes.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Component modes below ω² = @p largest_eigenvalue: component, contact, label, frequency, residual.
  Table component_table(const FrictionlessModes &modes, double largest_eigenvalue);

  /// Real coupled modes: label, share, frequency, residual.
  Table real_table(const FrictionlessModes &modes);

  /**
   * Complex modes: label, share, frequency, growth and divergence rate, damping ratio, residuals, whether they are
   * unstable, and estimates where there are any.
   */
  Table complex_table(const FrictionModes &friction);

  /**
   * The modes that grow, the largest divergence rate first: label, frequency, growth and divergence rate, share. At most
   * @p n_largest rows.
   */
  Table unstable_table(const FrictionModes &friction, std::size_t n_largest);

  /// Real eigenvalues, fastest growth first: growth rate, kind.
  Table real_eigenvalue_table(std::vector<double> values);

  /// The state of contact, one row for each pin.
  Table pin_table(const std::vector<PinContact> &pins);

  /// How well a steady sliding state fulfils its equations, and what is known of its uniqueness.
  Table sliding_table(const SlidingState &state, const std::vector<PinContact> &pins);
} // namespace Squeal
