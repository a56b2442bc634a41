// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/mode_pairing.h>
#include <squeal/modes/complex_modes.h>

#include <optional>
#include <vector>

namespace Squeal
{
  /// Discretisation error of a mode, estimated from a coarser mesh.
  struct DiscretisationError
  {
    bool   has_counterpart = false;
    bool   in_cluster      = false; ///< one of several modes that mix differently on each mesh: no individual counterpart
    double overlap         = 0.;    ///< MAC of both shapes [-]
    double frequency       = 0.;    ///< estimated relative error [-]
    double divergence      = 0.;    ///< estimated error of the divergence rate [-]

    /// Verdict on growth, within the estimated errors of mesh and solver.
    Verdict verdict = Verdict::undecided;

    /// True if both errors have been estimated and are within the limits.
    bool is_within(double frequency_limit, double divergence_limit) const;
  };

  /**
   * Estimates errors of modes λ = R + iω from a coarser mesh, by differences between counterparts (estimates/mode_pairing.h):
   *
   *   |ω − ω*| ≈ s |ω − ω_c|,   |ξ − ξ*| ≈ s |ξ − ξ_c|,   ξ = R / ω.
   *
   * With s = 1 / (c − 1), this holds if the errors of the coarser mesh are c times as large as those of the finer mesh, and is conservative
   * if the factor exceeds c.
   *
   * Two modes whose distance Δω changes by 100 % or more from mesh to mesh, |Δω − Δω_c| ≥ |Δω|, may coalesce on finer meshes. Since they
   * may exchange their shapes, the larger of their errors of ξ applies to both, for example to a growing mode and its decaying partner. Two
   * neutral modes, which occur without damping, may become a growing and a decaying mode if they coalesce. Their growth rate is then at
   * most |Δω| / 2, because their coupling does not cause flutter at a distance of Δω. This limit also counts as an error of ξ.
   *
   * A mode is unstable if verdict_of() with the error of the solver is `unstable` and ξ exceeds its estimated error. It is stable if
   * verdict_of() is `stable` and −ξ is at least the estimated error, or if it is neutral with an estimated error of ξ of at most
   * weak_divergence. All other modes, and modes without a counterpart, are undecided.
   *
   * @param coarse        modes on the coarser mesh, in a wider band
   * @param fine          modes on the finer mesh, at the same points
   * @param share         s [-]
   * @param solver_errors estimated |δλ| / |λ| of the fine modes by the solver [-]; empty: rounding errors
   */
  std::vector<DiscretisationError> discretisation_errors(const ModesAtPoints       &coarse,
                                                         const ModesAtPoints       &fine,
                                                         double                     share,
                                                         const std::vector<double> &solver_errors);

  /// Plausible orders of convergence [-].
  struct OrderRange
  {
    double smallest = 0.5, largest = 6.;
  };

  /// Limit of a sequence of values on successively finer meshes.
  struct Extrapolation
  {
    double                             limit;           ///< value v for the mesh width 0
    double                             order;           ///< order p, observed or assumed
    std::vector<std::optional<double>> observed_orders; ///< order from every three consecutive values; empty if it is not plausible
    bool                               is_trustworthy;  ///< true if the three finest values give a plausible p or the finest two are equal
    double                             uncertainty;     ///< estimated error of the limit
    std::vector<double>                errors;          ///< |v_k − limit| of each value
  };

  /**
   * Richardson extrapolation of values on meshes of decreasing widths, v_k = v + c h_k^p. If there are three or more values, the order
   * follows from
   *
   *   (v_1 − v_2) / (v_2 − v_3) = (h_1^p − h_2^p) / (h_2^p − h_3^p)
   *
   * for the three finest, with any ratios of h (L. F. Richardson 1911; P. J. Roache 1998). If there is no solution in @p plausible, for
   * example because the values are not monotone, the result is not trustworthy and the assumed order is used.
   *
   * Uncertainty of the limit: the difference from the limit with the assumed order; if not trustworthy, plus the difference of the two
   * finest values. If the two finest values differ only by rounding errors, the finest value is the limit.
   *
   * @param widths        h_k > 0, strictly decreasing, two or more [any unit]
   * @param values        v_k
   * @param assumed_order p if it cannot be observed
   */
  Extrapolation extrapolate(const std::vector<double> &widths,
                            const std::vector<double> &values,
                            double                     assumed_order,
                            const OrderRange          &plausible = {});
} // namespace Squeal
