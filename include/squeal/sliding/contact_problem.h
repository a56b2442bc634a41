// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense.h>

#include <string>
#include <vector>

namespace Squeal
{
  /**
   * Unilateral contact with Coulomb friction, condensed to the contact nodes (eq. (2) of the paper in static equilibrium, with sliding at
   * all nodes). The unknowns are reactions r and motions z with
   *
   *   g = g_0 + G r + B z,   r ≤ 0,  g ≤ 0,  r_c g_c = 0,   L r = f
   *
   * G = F_nn + μ F_nt is the flexibility of disc and pins, nonsymmetric with friction; the columns of B are gaps due to unit motions
   * (backplates, free motions of the disc), and L r = f are the equations of equilibrium for these motions.
   */
  struct ContactProblem
  {
    DenseMatrix         normal_flexibility;     ///< F_nn, n_c × n_c [m/N]
    DenseMatrix         tangential_flexibility; ///< F_nt, n_c × n_c [m/N]
    double              friction_coefficient;   ///< μ [-]
    std::vector<double> initial_gap;            ///< g_0, n_c [m]; negative if open
    DenseMatrix         motions;                ///< B, n_c × n_z
    DenseMatrix         balance;                ///< L, n_z × n_c
    std::vector<double> forces;                 ///< f, n_z [N]
    std::vector<int>    held;                   ///< indices of motions fixed at zero, whose columns of B and rows of L vanish

    /// G at the friction coefficient @p mu.
    DenseMatrix flexibility(const double mu) const
    {
      return normal_flexibility + mu * tangential_flexibility;
    }
  };

  struct ContactSolution
  {
    std::vector<double> reactions; ///< r [N] ≤ 0
    std::vector<double> gaps;      ///< g [m] ≤ 0; exactly zero at closed nodes
    std::vector<double> motions;   ///< z [m]
    std::vector<bool>   closed;
    int                 n_steps; ///< number of changes of the active set
  };

  /**
   * Solves a contact problem by block principal pivoting (Júdice and Pires 1994), a semismooth Newton method on the active set with a
   * safeguard: if toggling all violated nodes no longer reduces their number, single nodes are toggled until the number decreases. The
   * first start has all nodes closed; if it fails, the next starts are solutions at smaller μ, then random sets.
   *
   * Throws a SolverError with the violation of the best iterate if all starts fail.
   */
  ContactSolution solve_contact(const ContactProblem &problem);

  /**
   * Derivatives of the reactions, n_c × k, with respect to k parameters that change g_0 and f while the @p closed nodes remain closed:
   *
   *   g_0' + G r' + B z' = 0 at closed nodes,   r' = 0 at open nodes,   L r' = f'
   *
   * @param gap_rates   g_0', n_c × k [m per unit]
   * @param force_rates f', n_z × k [N per unit]; unused for held motions
   *
   * Throws SolverError if the closed nodes do not determine the reactions.
   */
  DenseMatrix reaction_rates(const ContactProblem    &problem,
                             const std::vector<bool> &closed,
                             const DenseMatrix       &gap_rates,
                             const DenseMatrix       &force_rates);

  /// Uniqueness of the solution of a contact problem.
  struct ContactUniqueness
  {
    double          unique_below;    ///< the solution is unique for every smaller friction coefficient; 0: unknown
    bool            meets_condition; ///< true if μ < unique_below, which is sufficient for uniqueness
    unsigned int    n_searches;      ///< number of other starting sets, if μ does not meet the condition
    bool            found_other;     ///< true if one of these sets led to another solution
    ContactSolution other;           ///< this other solution
  };

  /**
   * Checks the uniqueness of a solution. It is unique if Gᵀ + G is positive definite and L = −Bᵀ: two solutions would give (r − r')ᵀ G (r −
   * r') ≤ 0. G satisfies this condition for all μ < 1/λ_max, where λ_max is the largest eigenvalue of −½ (F_nt + F_ntᵀ) x = λ F_nn x. If
   * μ does not meet this condition, the problem is solved again from up to @p n_searches random sets.
   */
  ContactUniqueness contact_uniqueness(const ContactProblem &problem, const ContactSolution &solution, unsigned int n_searches = 8);
} // namespace Squeal
