// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/bases/rigid_body.h>
#include <squeal/contact/contact_operators.h>
#include <squeal/sliding/contact_problem.h>

#include <optional>

namespace Squeal
{
  /**
   * Of the @p free motions of each body, M-orthonormal, those that the reactions can balance,
   * n × k; nothing if there are none. The sliding motion itself
   * does not count, whose force or moment the drive takes, nor do those that leave the gaps as they are.
   *
   * @param pressing forces on the bodies, n × 1 [N]; null: none, and only the disc may be free
   *
   * Throws SolverError if friction or @p pressing acts on one of the latter, another body than the disc is free and not pressed, or the sliding
   * velocity of a disc that moves freely is no rigid-body motion.
   */
  std::optional<MultiVector> balanced_motions(const Model                                   &model,
                                              const ContactOperators                        &contact,
                                              const SecondOrderSystem                       &system,
                                              const std::vector<std::optional<MultiVector>> &free,
                                              const OperationParameters                     &operation,
                                              const MultiVector                             *pressing);

  /**
   * A disc that floats between two loaded backplates is in balance wherever it
   * is along its axis, if the loads are: B y = 0 for a motion y of all. Then
   * one free motion, numbered from @p n_plates, is held instead of balanced, and so on while one remains. Decided by the singular values of B with columns of unit norm, so that
   * the units of the motions play no part.
   *
   * Throws SolverError if the loads on such a disc are not in balance.
   */
  void hold_undetermined_motion(ContactProblem &problem, int n_plates);
} // namespace Squeal
