// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/mode_pairing.h>
#include <squeal/modes/complex_modes.h>

#include <optional>
#include <vector>

namespace Squeal
{
  /// What a second, coarser mesh says of a mode.
  struct DiscretisationError
  {
    bool   has_counterpart = false;
    bool   in_cluster      = false; ///< the mesh decides which of several modes is the counterpart
    double overlap         = 0.;    ///< of both shapes [-]
    double frequency       = 0.;    ///< estimated error, relative [-]
    double divergence      = 0.;    ///< estimated error of the divergence rate [-]

    /// Whether the mode grows, as far as mesh and solver tell.
    Verdict verdict = Verdict::undecided;

    /// Whether both errors are known and within limits.
    bool is_within(double frequency_limit, double divergence_limit) const;
  };

  /**
   * Estimated errors of modes λ = R + iω by those of a coarser mesh, from differences between counterparts (estimates/mode_pairing.h):
   *
   *   |ω − ω*| ≈ s |ω − ω_c|,   |ξ − ξ*| ≈ s |ξ − ξ_c|,   ξ = R / ω.
   *
   * With s = 1 / (c − 1) that holds where the coarser mesh is off by c times as much, and is too large where it is by more.
   *
   * Two modes whose distance Δω changes by itself or more from mesh to mesh, |Δω − Δω_c| ≥ |Δω|, may meet on finer meshes. They may
   * exchange their shapes on the way: of their errors of ξ the largest counts for both, as for a growing mode and its decaying partner.
   * Two modes that neither grow nor decay, as without damping, may begin to where they meet; since their coupling does not make them
   * flutter at a distance of Δω, they then grow by |Δω| / 2 at most, which counts as an error of ξ, too.
   *
   * A mode is unstable if verdict_of() with the error of the solver says so and R is beyond the estimated error; it is stable if R
   * decays beyond it, or is neutral and the estimated error of ξ is below weak_divergence. All else is undecided, and so is a mode
   * without counterpart.
   *
   * @param coarse        modes on the coarser mesh, in a band that reaches further
   * @param fine          modes on the finer mesh, at the same points
   * @param share         s [-]
   * @param solver_errors estimated |δλ| / |λ| of the fine modes by the solver; empty: rounding errors [-]
   */
  std::vector<DiscretisationError> discretisation_errors(const ModesAtPoints       &coarse,
                                                         const ModesAtPoints       &fine,
                                                         double                     share,
                                                         const std::vector<double> &solver_errors);

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
