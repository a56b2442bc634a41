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
  /// A design of a search by parts of the ranges of its variables, in the unit cube.
  using SearchPoint = std::vector<double>;

  /// The variables of Designs/Variables. Throws ParameterError unless all of them have ranges.
  std::vector<DesignVariable> search_variables(const DesignParameters &designs);

  /// Divergence rate that stands for a design without a result, larger than any other [-].
  inline constexpr double penalty_rate = 1.;

  /// Numbers of the points from which a search goes on, those with the smallest values first.
  std::vector<std::size_t> starts_of_search(const std::vector<double> &values);

  /// Minimises by a method of NLopt from a start. Returns why it ended: empty if @p value ended it by returning nothing.
  std::string minimise(const SearchParameters                                          &parameters,
                       const SearchPoint                                               &start,
                       const std::function<std::optional<double>(const SearchPoint &)> &value);

  /// Modes of a design at full order, at one friction coefficient.
  struct FullOrder
  {
    std::optional<double> friction_coefficient; ///< nothing if a system file has none
    std::size_t           n_modes, n_unstable;
    ModalQuantities       leading; ///< the mode that grows most, or is damped least
    std::string           label;
    double                residual; ///< largest
  };

  /// The design of a mesh at μ, or a system file at the values of the parameters, as a step of the run.
  FullOrder at_full_order(const Parameters &design, double mu, Run &run);

  Table full_order_table(const std::vector<FullOrder> &rows);

  /// Whether the goal of a search depends on uncertain parameters.
  bool is_robust(const SearchParameters &parameters);

  /// Searches for the design with the smallest probability of squeal, or quantile of the largest divergence rate of a sample: Sobol's points
  /// of the ranges, then a method without derivatives from the best two of them. One reduced model solves all samples of all designs and
  /// grows where they need it. Every design has the same random numbers.
  void run_robust_search(Scene &scene, Run &run);
  void run_robust_search_of_system(Run &run);
} // namespace Squeal
