// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/conventions.h>
#include <squeal/output/table.h>
#include <squeal/parameters/design_plan.h>
#include <squeal/studies/steps/friction_modes.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// A design in a search, in the unit cube: fractions of the ranges of its variables.
  using SearchPoint = std::vector<double>;

  /// Variables of Designs/Variables. Throws ParameterError unless every variable has a range.
  std::vector<DesignVariable> search_variables(const DesignParameters &designs);

  /// Divergence rate assumed for a design without a result, larger than usual divergence rates [-].
  inline constexpr double penalty_rate = 1.;

  /// Indices of the starting points of a search, smallest values first.
  std::vector<std::size_t> starts_of_search(const std::vector<double> &values);

  /// Minimises @p value with a method of NLopt. Returns the reason for termination; empty if @p value returned nothing.
  std::string minimise(const SearchParameters                                          &parameters,
                       const SearchPoint                                               &start,
                       const std::function<std::optional<double>(const SearchPoint &)> &value);

  /// Full-order modes of a design at one friction coefficient.
  struct FullOrder
  {
    std::optional<double> friction_coefficient; ///< empty for a system file without a friction coefficient
    std::size_t           n_modes, n_unstable;
    ModalQuantities       leading; ///< mode with the largest divergence rate
    std::string           label;
    double                residual; ///< largest residual
  };

  /// Solves a design at full order, at μ or at the parameter values of a system file, as a step of the run.
  FullOrder at_full_order(const Parameters &design, double mu, Run &run);

  Table full_order_table(const std::vector<FullOrder> &rows);

  /// True if the goal of a search depends on uncertain parameters.
  bool is_robust(const SearchParameters &parameters);

  /// Minimises the probability of squeal, or a quantile of the largest divergence rate of the samples. Evaluates points of the Sobol
  /// sequence in the ranges, then starts a derivative-free method from the two best points. All samples of all designs are solved with
  /// one reduced model, which is extended if necessary, or at full order without a definite part. Designs share the same random numbers.
  void run_robust_search(Scene &scene, Run &run);
  void run_robust_search_of_system(Run &run);
} // namespace Squeal
