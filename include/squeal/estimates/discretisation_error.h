#pragma once

#include <squeal/estimates/mode_pairing.h>
#include <squeal/modes/verdict.h>

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
} // namespace Squeal
