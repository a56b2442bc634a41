// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/eigen/symmetric_modes.h>
#include <squeal/estimates/eigenvalue_estimates.h>

#include <complex>
#include <string>
#include <vector>

namespace Squeal
{
  /// Errors of one reduced mode, or the largest of a group, against reference modes, section 3.2 of the paper.
  struct ErrorMeasures
  {
    double residual             = 0.; ///< ε_res, eq. (16) [-]
    double shape                = 0.; ///< ε_mac, eq. (19) [-]
    double frequency            = 0.; ///< ε_frq, eq. (20) [-]
    double divergence           = 0.; ///< ε_div, eq. (21) [-]
    double closest_shape        = 0.; ///< ε_mac with the reduced mode that eq. (17) picks, one-to-one or not [-]
    double closest_frequency    = 0.; ///< ε_frq of that mode [-]
    double closest_divergence   = 0.; ///< ε_div of that mode [-]
    double eigenvalue           = 0.; ///< |λ̂ − λ| / |λ| [-]
    double subspace             = 0.; ///< sin² of the largest angle between a cluster and its reduced modes; ε_mac for a single mode [-]
    double corrected_error      = 0.; ///< |λ̂ + δλ − λ| / |λ| [-]
    double estimated_divergence = 0.; ///< |ξ(λ̂ + δλ) − ξ(λ̂)| [-]
    double corrected_divergence = 0.; ///< |ξ(λ̂ + δλ) − ξ(λ)| [-]
  };

  /// Errors of one reduced mode with their estimates.
  struct ModeError : ErrorMeasures
  {
    std::complex<double> reference, reduced, corrected; ///< λ, λ̂ and λ̂ + δλ [rad/s]
    int                  match;                         ///< number of the reduced mode
    int                  closest;                       ///< number of the reduced mode that eq. (17) picks
    int                  cluster_size;                  ///< reference modes with nearly the same λ, itself included
    double               estimated_error;               ///< |δλ| / |λ̂| [-]
    double               estimate_ratio;                ///< |δλ| / |λ̂ − λ| [-]; infinite where λ̂ is exact
    double               condition;                     ///< κ of λ̂ [-]
    bool                 claimed;                       ///< whether the estimate means something
    Verdict              verdict;
  };

  /// Real modes as complex ones, λ = iω, without those of rigid-body motions.
  ComplexModes undamped_modes(const SymmetricModes &modes);

  /**
   * Errors of reduced modes, one entry for each of the @p reference modes. Their
   * counterparts are found by the mass-weighted criterion
   *
   *   MAC-M = |φᴴ M φ̂|² / (φᴴ M φ  φ̂ᴴ M φ̂)      eq. (18),
   *
   * each reduced mode serving once, so that the sum of MAC-M is largest. (Eq. (17) of the paper takes the mode of the largest
   * MAC-M for each reference mode by itself, so that one may serve twice and another never; errors that follow from this
   * choice are the `closest_` ones.) Where
   * λ of several reference modes lie within |λ_i − λ_j| ≤ @p cluster_tolerance |λ_i|, in
   * chains, MAC-M of single modes says little. There a reduced mode counts by its
   * share in the span of the cluster first, and the angles between the
   * subspaces are given beside ε_mac, all in the complex M-inner product. A mode
   * of which a poor basis has no image gets the best match within 30 % of its λ.
   *
   * @param system    the frictionless problem: undamped()
   * @param inverse   factor of K_c (or of the shifted stiffness, which then stands for it)
   * @param modes     with BandEnd::open, or modes near the end of the band may lack counterparts
   * @param reference undamped_modes() for the frictionless problem
   *
   * Throws SolverError if there are fewer reduced than reference modes.
   */
  std::vector<ModeError> reduction_errors(const CoupledSystem  &system,
                                          const UpdatedInverse &inverse,
                                          const ReducedModel   &model,
                                          const ReducedModes   &modes,
                                          const ComplexModes   &reference,
                                          double                cluster_tolerance = 1e-3);

  /// Largest errors of a group of modes.
  struct GroupError : ErrorMeasures
  {
    std::string group;
    int         n_modes = 0;
    int         n_other = 0; ///< modes for which eq. (17) picks another counterpart
  };

  /**
   * Maxima of each group, in the order in which the groups first appear, then those of groups @p joined, "disc and F1", where
   * there are modes of all of them.
   *
   * @param groups of each mode
   */
  std::vector<GroupError> largest_errors(const std::vector<ModeError>                &errors,
                                         const std::vector<std::string>              &groups,
                                         const std::vector<std::vector<std::string>> &joined = {});
} // namespace Squeal
