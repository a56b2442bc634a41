// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/bases/rigid_body.h>
#include <squeal/contact/contact_operators.h>
#include <squeal/sliding/contact_problem.h>

#include <optional>

namespace Squeal
{
  /**
   * M-orthonormal motions, n × k, selected from the @p free motions of each body, for which reactions can provide equilibrium; empty if
   * there are none. Excluded are the sliding motion, whose force or moment the drive balances, and motions that do not change any gap.
   *
   * @param pressing forces on the bodies, n × 1 [N]; null: no such forces, and only the disc may have free motions
   *
   * Throws SolverError if friction or @p pressing does work on an excluded motion that does not change the gaps; if a body other than the
   * disc is free and not pressed; or if the sliding velocity of a free disc is not a rigid-body motion.
   */
  std::optional<MultiVector> balanced_motions(const Model                                   &model,
                                              const ContactOperators                        &contact,
                                              const SecondOrderSystem                       &system,
                                              const std::vector<std::optional<MultiVector>> &free,
                                              const OperationParameters                     &operation,
                                              const MultiVector                             *pressing);

  /**
   * Removes undetermined motions. If the loads of two backplates are in equilibrium, a disc that floats between them is in equilibrium at
   * any axial position: there is a combination y of motions with B y = 0. One free motion, with an index of at least @p n_plates, is then
   * held, and its equation of equilibrium is omitted. This is repeated while there is such a y. The singular values of B with
   * columns of unit norm, which do not depend on the units of the motions, show whether y exists.
   *
   * Throws SolverError if the loads on a floating disc are not in equilibrium.
   */
  void hold_undetermined_motion(ContactProblem &problem, int n_plates);
} // namespace Squeal
