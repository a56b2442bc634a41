#pragma once

#include <optional>
#include <vector>

namespace Squeal
{
  /// Orders of convergence that are plausible [-].
  struct OrderRange
  {
    double smallest = 0.5, largest = 6.;
  };

  /// What a sequence of values on finer and finer meshes tends to.
  struct Extrapolation
  {
    double                             limit;           ///< v of the mesh width 0
    double                             order;           ///< p, observed or assumed
    std::vector<std::optional<double>> observed_orders; ///< of three consecutive values each; nothing where there is no plausible one
    bool                               is_trustworthy;  ///< p was observed, and its range and the three finest values are plausible
    double                             uncertainty;     ///< of the limit, estimated
    std::vector<double>                errors;          ///< |v_k − limit| of each value
  };

  /**
   * Richardson's extrapolation of values on meshes of decreasing widths, v_k = v + c h_k^p. Three or more values give the order:
   *
   *   (v_1 − v_2) / (v_2 − v_3) = (h_1^p − h_2^p) / (h_2^p − h_3^p)
   *
   * of the three finest, for any ratios of h (L. F. Richardson 1911; P. J. Roache 1998). Where that has no solution in @p
   * plausible, as where the values are not monotone, the result is not trustworthy and the assumed order is taken.
   *
   * The limit is uncertain by its difference from the limit with the assumed order; where it is not trustworthy, moreover by the
   * difference of the two finest values. Differences that are rounding errors of the values count as none: the finest value is the limit.
   *
   * @param widths        h_k > 0, strictly decreasing, two or more [any unit]
   * @param values        v_k
   * @param assumed_order p where it cannot be observed
   */
  Extrapolation extrapolate(const std::vector<double> &widths,
                            const std::vector<double> &values,
                            double                     assumed_order,
                            const OrderRange          &plausible = {});
} // namespace Squeal
