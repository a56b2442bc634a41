// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/bases/rigid_body.h>
#include <squeal/contact/contact_operators.h>
#include <squeal/sliding/contact_problem.h>

#include <optional>

namespace Squeal
{
  /**
   * The @p free motions of each body, M-orthonormal, that reactions can balance, n × k; nothing if there are none. The sliding motion,
   * whose force or moment the drive balances, and motions that leave all gaps unchanged are excluded.
   *
   * @param pressing forces on the bodies, n × 1 [N]; null: none, and only the disc may have free motions
   *
   * Throws SolverError if friction or @p pressing acts on an excluded motion that leaves the gaps unchanged, if a body other than the disc
   * is free and not pressed, or if the sliding velocity of a free disc is not a rigid-body motion.
   */
  std::optional<MultiVector> balanced_motions(const Model                                   &model,
                                              const ContactOperators                        &contact,
                                              const SecondOrderSystem                       &system,
                                              const std::vector<std::optional<MultiVector>> &free,
                                              const OperationParameters                     &operation,
                                              const MultiVector                             *pressing);

  /**
   * A disc that floats between two loaded backplates is in equilibrium at any axial position if the loads are: B y = 0 for a motion y of
   * all. One free motion, numbered from @p n_plates, is then held instead of balanced, and so on while such a y exists. Decided by the
   * singular values of B with columns of unit norm, independent of the units of the motions.
   *
   * Throws SolverError if the loads on such a disc are not in equilibrium.
   */
  void hold_undetermined_motion(ContactProblem &problem, int n_plates);
} // namespace Squeal
