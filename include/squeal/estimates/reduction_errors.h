// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/eigen/symmetric_modes.h>
#include <squeal/estimates/eigenvalue_estimates.h>

#include <complex>
#include <functional>
#include <string>
#include <vector>

namespace Squeal
{
  /// Errors of a reduced mode, or the largest errors of a group, relative to reference modes; section 3.2 of the paper.
  struct ErrorMeasures
  {
    double residual             = 0.; ///< ε_res, eq. (16) [-]
    double shape                = 0.; ///< ε_mac, eq. (19) [-]
    double frequency            = 0.; ///< ε_frq, eq. (20) [-]
    double divergence           = 0.; ///< ε_div, eq. (21) [-]
    double closest_shape        = 0.; ///< ε_mac with the reduced mode selected by eq. (17), which need not be one-to-one [-]
    double closest_frequency    = 0.; ///< ε_frq of that mode [-]
    double closest_divergence   = 0.; ///< ε_div of that mode [-]
    double eigenvalue           = 0.; ///< |λ̂ − λ| / |λ| [-]
    double subspace             = 0.; ///< sin² of the largest angle between a cluster and its reduced modes; ε_mac for a single mode [-]
    double corrected_error      = 0.; ///< |λ̂ + δλ − λ| / |λ| [-]
    double estimated_divergence = 0.; ///< |ξ(λ̂ + δλ) − ξ(λ̂)| [-]
    double corrected_divergence = 0.; ///< |ξ(λ̂ + δλ) − ξ(λ)| [-]
  };

  /// Errors of a reduced mode and their estimates.
  struct ModeError : ErrorMeasures
  {
    std::complex<double> reference, reduced, corrected; ///< λ, λ̂ and λ̂ + δλ [rad/s]
    int                  match;                         ///< index of the reduced mode
    int                  closest;                       ///< index of the reduced mode selected by eq. (17)
    int                  cluster_size;                  ///< number of reference modes with nearly the same λ, including this one
    double               estimated_error;               ///< |δλ| / |λ̂| [-]
    double               estimate_ratio;                ///< |δλ| / |λ̂ − λ| [-]; infinite if λ̂ is exact
    double               condition;                     ///< κ of λ̂ [-]
    bool                 claimed;                       ///< true if the estimate is meaningful
    Verdict              verdict;
  };

  /// Converts real modes to complex modes with λ = iω, without rigid-body modes.
  ComplexModes undamped_modes(const SymmetricModes &modes);

  /**
   * Errors of reduced modes, one entry for each of the @p reference modes. Counterparts are found by the mass-weighted criterion
   *
   *   MAC-M = |φᴴ M φ̂|² / (φᴴ M φ  φ̂ᴴ M φ̂)      eq. (18).
   *
   * Each reduced mode is used at most once, and the sum of MAC-M is maximised. (Eq. (17) of the paper selects the reduced mode with the
   * largest MAC-M for each reference mode individually and may select a reduced mode several times or never; the `closest_` errors use this
   * selection.) Reference modes with |λ_i − λ_j| ≤ @p cluster_tolerance |λ_i| form clusters, in which individual MAC-M are not
   * meaningful. Reduced modes are then ranked by their share in the span of the cluster, and angles between the subspaces are given in
   * addition to ε_mac, all in the complex M-inner product. A reduced mode whose λ̂ differs from λ by more than 30 % becomes a
   * counterpart only if there is no other candidate.
   *
   * @param mass      M
   * @param modes     computed with BandEnd::open; otherwise modes near the end of the band may lack counterparts
   * @param reference undamped_modes() for the frictionless problem
   * @param estimate  estimated errors of reduced modes from their residuals
   *
   * Throws SolverError if there are fewer reduced than reference modes.
   */
  std::vector<ModeError> reduction_errors(const SparseMatrix                                             &mass,
                                          const ReducedModel                                             &model,
                                          const ReducedModes                                             &modes,
                                          const ComplexModes                                             &reference,
                                          const std::function<EigenvalueEstimates(const ReducedModes &)> &estimate,
                                          double                                                          cluster_tolerance = 1e-3);

  /// Errors of reduced modes for a @p system with a definite part; for the frictionless problem, pass undamped(). Uses the factor of K_c
  /// or of the shifted stiffness.
  std::vector<ModeError> reduction_errors(const CoupledSystem  &system,
                                          const UpdatedInverse &inverse,
                                          const ReducedModel   &model,
                                          const ReducedModes   &modes,
                                          const ComplexModes   &reference,
                                          double                cluster_tolerance = 1e-3);

  struct GroupError : ErrorMeasures
  {
    std::string group;
    int         n_modes = 0;
    int         n_other = 0; ///< number of modes for which eq. (17) selects another counterpart
  };

  /**
   * Largest errors of each group, in the order of first appearance, then of @p joined groups ("disc and F1") if all their members have
   * modes.
   *
   * @param groups group of each mode
   */
  std::vector<GroupError> largest_errors(const std::vector<ModeError>                &errors,
                                         const std::vector<std::string>              &groups,
                                         const std::vector<std::vector<std::string>> &joined = {});
} // namespace Squeal
